"""Confirmation of a registration by a person after a restart.

A move of camera, marker or patient while the server is down is not detected, and opening a case identifies
the case, not the patient on the table. A registration from an earlier run therefore has to be confirmed once
per run. Registrations and checks made in this run need no confirmation. Each run has a name, which
registrations and checks store, because clocks can be set back.

A registration that is anchored to the camera also needs a confirmation after a restart of the tracking
process, which detects moves only from its own first image. With a reference marker on the patient a move of
the camera does not matter, and navigation resumes without a confirmation.
"""

from dataclasses import dataclass

from server.config import Section
from server.procedure.documents import parse_document
from server.procedure.registration_record import CheckRecord, RegistrationRecord
from server.setup import ConfirmationReason, confirmation_reason
from server.store import Document
from server.texts import CONFIRM, Reason, reason


class ConfirmationRecord(Section):
    """A confirmation as stored in a case. Its document depends on the confirmed registration."""

    vertebra: str
    because: ConfirmationReason
    run: str
    """Server run in which it was given; it is valid in that run only."""
    from_s: float
    """Time of the confirmation, on the image clock of that run."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ConfirmationPrompt:
    """A confirmation that a person must give before navigation resumes.

    Attributes:
        because: why it is needed.
        reason: the same in words, and what to verify.
        vertebra: the registered vertebra.
        registration: document of the registration.
        reference: the reference marker that it is anchored to; empty if it is anchored to the camera.
    """

    because: ConfirmationReason
    reason: Reason
    vertebra: str
    registration: Document
    reference: str


def confirmation_name(vertebra: str) -> str:
    """Return the document name of a vertebra's confirmation."""
    return f"going on with {vertebra}"


def confirmation_from_document(document: Document) -> ConfirmationRecord:
    """Parse the confirmation in a case document.

    Raises:
        InvalidInput: CONFIRMATION_DOCUMENT_INVALID.
    """
    return parse_document(
        ConfirmationRecord, document, code="CONFIRMATION_DOCUMENT_INVALID", remedy="Confirm again."
    )


def confirmed_from_s(
    registration: RegistrationRecord,
    check: CheckRecord | None,
    confirmation: ConfirmationRecord | None,
    *,
    run: str,
) -> float | None:
    """Return the last time in this run at which it was captured, checked or confirmed.

    On the image clock; None if that was never in this run.
    """
    times_s = []
    if registration.run == run:
        # A registration without a tip has no capture time; it counts as older than any image.
        times_s.append(float("-inf") if registration.from_s is None else registration.from_s)
    if check is not None and check.passed and check.run == run:
        times_s.append(check.from_s)
    if confirmation is not None and confirmation.run == run:
        times_s.append(confirmation.from_s)
    return max(times_s, default=None)


def confirmation_prompt(
    registration: RegistrationRecord, document: Document, *, believed_s: float | None, tracked_from_s: float
) -> ConfirmationPrompt | None:
    """Return the confirmation that is needed, or None.

    Args:
        registration: the current registration.
        document: its document.
        believed_s: result of `confirmed_from_s`.
        tracked_from_s: start of the current tracking process, on the image clock.
    """
    because = confirmation_reason(registration.registration, believed_s, tracked_from_s=tracked_from_s)
    if because is None:
        return None
    return ConfirmationPrompt(
        because=because,
        reason=reason(because.name, remedy=CONFIRM[registration.anchored_to.value]),
        vertebra=registration.vertebra,
        registration=document,
        reference=registration.reference,
    )
