"""State of the procedure for the alarms: out-of-date documents, and the time of the last check."""

from server.alarms import ProcedureFacts
from server.procedure.state import ProcedureState, StepName, StepState

CALIBRATIONS = (StepName.CAMERA, StepName.TOOL)


def facts_of(state: ProcedureState, *, now_s: float) -> ProcedureFacts:
    """Return the facts of this state.

    Args:
        state: State of the procedure, with or without an open case.
        now_s: Present time on the image clock.
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
