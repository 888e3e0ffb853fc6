"""State of the check on anatomy: its result, its age, and the run of the server in which it was made."""

from datetime import UTC, datetime

from server.procedure.registration_record import CheckRecord, RegistrationRecord, check_from_document
from server.procedure.state.records import Finding, Number, StepState
from server.store import Document
from server.texts import Text, reason, reason_of_error
from tracker.errors import NavigationError
from tracker.registration import AnchoredTo


def check_finding(
    *,
    registration: RegistrationRecord,
    title: Text,
    check: Document | None,
    run: str,
    again_after_min: float,
    now: datetime,
    now_s: float,
) -> Finding:
    """Return the state of the check of a registration.

    A registration that is anchored to the camera must be checked again after each start of the server,
    because a move of the camera meanwhile was not detected.

    Args:
        registration: the current registration.
        title: title of its document.
        check: the newest valid check, which depends on this registration; None if there is none.
        run: name of this run of the server.
        again_after_min: age from which a check is due.
        now: the time, in UTC.
        now_s: the time on the image clock of this run, plus the computer's sleep.
    """
    is_loose = registration.anchored_to is AnchoredTo.CAMERA
    if check is None:
        if is_loose and registration.run != run:
            return _after_start(registration.vertebra, "")
        return Finding(state=StepState.MISSING, reason=reason("NOT_CHECKED", {"title": title}))
    try:
        record = check_from_document(check)
    except NavigationError as error:
        return Finding(state=StepState.MISSING, reason=reason_of_error(error))
    if record.passed and is_loose and record.run != run:
        return _after_start(registration.vertebra, check.id)
    from_s = record.from_s if record.run == run else None
    minutes = age_min(check, from_s=from_s, now=now, now_s=now_s)
    return _of(record, check, again_after_min=again_after_min, minutes=minutes)


def _of(record: CheckRecord, check: Document, *, again_after_min: float, minutes: float) -> Finding:
    """Return whether it passed, and whether it is due again."""
    numbers: dict[str, Number] = {
        "distance_mm": record.distance_mm,
        "max_mm": record.max_mm,
        "landmark": record.landmark,
        "age_min": minutes,
    }
    if not record.passed:
        state, code = StepState.FAILED, "CHECK_FAILED"
    # A negative age means that the clock was set back; the age is then unknown.
    elif not 0.0 <= minutes < again_after_min:
        state, code = StepState.DUE, "CHECK_DUE"
    else:
        state, code = StepState.DONE, "CHECK_PASSED"
    why = reason(code, {**numbers, "again_after_min": again_after_min})
    return Finding(state=state, reason=why, numbers=numbers, document_id=check.id)


def _after_start(vertebra: str, document_id: str) -> Finding:
    return Finding(
        state=StepState.OUT_OF_DATE,
        reason=reason("UNCHECKED_SINCE_RESTART", {"vertebra": vertebra}),
        document_id=document_id,
    )


def age_min(document: Document, *, from_s: float | None, now: datetime, now_s: float) -> float:
    """Return the age of a document in minutes.

    In this run not by the wall clock, which can be set: set back, it would make a due check young again. The
    age of a document of an earlier run is negative if the clock was set back.

    Args:
        document: the document.
        from_s: the time of its images on the image clock; None if it was made in another run or without
            images.
        now: the time, in UTC.
        now_s: the time on the image clock of this run, plus the computer's sleep.
    """
    if from_s is not None:
        return (now_s - from_s) / 60.0
    made = datetime.fromisoformat(document.made_at.replace("Z", "+00:00"))
    return (now.astimezone(UTC) - made).total_seconds() / 60.0
