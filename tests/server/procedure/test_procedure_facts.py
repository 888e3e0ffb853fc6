"""Facts of the procedure that the alarms use."""

from dataclasses import replace

import pytest

from server.alarms import ProcedureFacts
from server.procedure.facts import facts_of
from server.procedure.state import Finding, StepName, StepState, derive_state, no_case
from server.texts import reason

DONE = {step: Finding(state=StepState.DONE, reason=reason("NAVIGATION_ALLOWED")) for step in StepName}
CHECKED = replace(DONE[StepName.CHECK], numbers={"age_min": 10.0})


def facts(**states: StepState) -> ProcedureFacts:
    findings = {
        **DONE,
        StepName.CHECK: CHECKED,
        **{
            StepName(step): Finding(state=state, reason=reason("NOT_PLANNED"))
            for step, state in states.items()
        },
    }
    return facts_of(derive_state("case", findings), now_s=5000.0)


def test_a_valid_procedure_is_current_and_has_the_time_of_its_check() -> None:
    assert facts() == ProcedureFacts(checked_at_s=4400.0)


@pytest.mark.parametrize("step", ["camera", "tool"])
def test_a_calibration_that_is_out_of_date_is_reported(step: str) -> None:
    reported = facts(**{step: StepState.OUT_OF_DATE})
    assert (reported.calibration_current, reported.registration_current) == (False, True)


def test_a_registration_that_is_out_of_date_is_reported_and_one_that_was_never_made_is_not() -> None:
    assert not facts(register=StepState.OUT_OF_DATE).registration_current
    assert facts(register=StepState.MISSING).registration_current


def test_a_check_that_failed_is_none() -> None:
    assert facts(check=StepState.FAILED).checked_at_s is None


def test_without_a_case_nothing_is_said() -> None:
    assert facts_of(no_case(), now_s=5000.0) == ProcedureFacts()
