"""What is said of the check on anatomy: whether, when, and in which run of the server it was made."""

from datetime import UTC, datetime

from server.procedure.registered import KeptCheck, KeptRegistration, kept_check
from server.procedure.state.records import Finding, Number, StepState
from server.store import Document
from tracker.errors import NavigationError
from tracker.registration import AnchoredTo

CHECK = "Hold the tip on a landmark that was not used."


def check_finding(
    *,
    registration: KeptRegistration,
    title: str,
    check: Document | None,
    run: str,
    again_after_min: float,
    now: datetime,
) -> Finding:
    """How the check of a registration stands.

    A registration that is fixed to the camera is to be checked again after each start of the server: nobody
    saw whether the camera was moved meanwhile.

    Args:
        registration: that holds now.
        title: of its document.
        check: the newest that holds, and so stands on this registration; None where there is none.
        run: names this run of the server.
        again_after_min: from which age on a check is due.
        now: the time, in UTC.
    """
    is_loose = registration.anchored_to is AnchoredTo.CAMERA
    if check is None:
        if is_loose and registration.run != run:
            return _after_start(registration.vertebra, "")
        return Finding(
            state=StepState.MISSING, said=f"{title} has not been checked on a landmark", remedy=CHECK
        )
    try:
        kept = kept_check(check)
    except NavigationError as error:
        return Finding(state=StepState.MISSING, said=error.message, remedy=error.remedy)
    if kept.passed and is_loose and kept.run != run:
        return _after_start(registration.vertebra, check.id)
    return _of(kept, check, again_after_min=again_after_min, minutes=minutes_since(check.made_at, now))


def _of(kept: KeptCheck, check: Document, *, again_after_min: float, minutes: float) -> Finding:
    """Whether it passed, and is still young enough."""
    numbers: dict[str, Number] = {
        "distance_mm": kept.distance_mm,
        "max_mm": kept.max_mm,
        "landmark": kept.landmark,
        "age_min": minutes,
    }
    told = f"the tip on {kept.landmark} was {kept.distance_mm:.2f} mm from where the plan has it, allowed "
    told += f"{kept.max_mm:.2f} mm"
    if not kept.passed:
        state, remedy = StepState.FAILED, "Check again, nudge the registration, or register again."
    # A clock that was set back says nothing of the age.
    elif not 0.0 <= minutes < again_after_min:
        state, remedy = StepState.DUE, CHECK
        told = (
            f"the check on {kept.landmark} is {minutes:.0f} min old, asked for every {again_after_min:g} min"
        )
    else:
        state, remedy = StepState.DONE, ""
    return Finding(state=state, said=told, remedy=remedy, numbers=numbers, document_id=check.id)


def _after_start(vertebra: str, document_id: str) -> Finding:
    return Finding(
        state=StepState.OUT_OF_DATE,
        said=f"the server was started again after {vertebra} was registered before the camera, and nobody "
        "saw whether the camera was moved",
        remedy=CHECK,
        document_id=document_id,
    )


def minutes_since(made_at: str, now: datetime) -> float:
    """The age of a document in minutes; below 0 where the clock was set back."""
    made = datetime.fromisoformat(made_at.replace("Z", "+00:00"))
    return (now.astimezone(UTC) - made).total_seconds() / 60.0
