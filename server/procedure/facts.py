"""What the alarms need of the procedure: what is out of date, and the time of the last check."""

from server.alarms import ProcedureFacts
from server.procedure.state import ProcedureState, StepName, StepState

CALIBRATIONS = (StepName.CAMERA, StepName.TOOL)


def facts_of(state: ProcedureState, *, now_s: float) -> ProcedureFacts:
    """The facts of a procedure that stands like this.

    Args:
        state: of the open case, or of none.
        now_s: the clock that images are stamped with.
    """
    if not state.case_id:
        return ProcedureFacts()
    found = {step: state.status(step).finding for step in StepName}
    check = found[StepName.CHECK]
    age_min = check.numbers.get("age_min")
    is_checked = check.state in {StepState.DONE, StepState.DUE} and isinstance(age_min, float | int)
    return ProcedureFacts(
        registration_current=found[StepName.REGISTER].state is not StepState.OUT_OF_DATE,
        calibration_current=all(found[step].state is not StepState.OUT_OF_DATE for step in CALIBRATIONS),
        checked_at_s=now_s - 60.0 * float(age_min) if is_checked and age_min is not None else None,
    )
