"""That a person stands for a registration after a start: touched, checked or confirmed, in this run.

Nobody saw whether camera, marker or patient were moved while the server was down, and opening a case says
which case, not that its patient lies there. So each registration of an earlier run asks once in each run;
what is touched or checked in this run asks nothing. Each run has a name that registrations and checks
store, because clocks may go back.

A new tracking process asks likewise where the registration is fixed to the camera: it watches only from its
own first image. Beside a marker on the patient a moved camera changes nothing, and numbers come back by
themselves.
"""

from dataclasses import dataclass

from server.config import Section
from server.procedure.read import read_document
from server.procedure.registered import KeptCheck, KeptRegistration
from server.setup import Unconfirmed, unconfirmed
from server.store import Document
from tracker.registration import AnchoredTo

SAID = {
    Unconfirmed.SERVER_STARTED: "the server was started again, and nobody has said yet that patient, marker "
    "and camera stand as they did",
    Unconfirmed.TRACKING_STARTED: "tracking was started again, and nobody saw whether the camera was moved "
    "meanwhile",
}
REMEDY = {
    AnchoredTo.REFERENCE: "Look whether this is the patient and the marker on the bone is untouched; then "
    "confirm, or check on a landmark.",
    AnchoredTo.CAMERA: "Look whether the planned channel still lies on the bone in the picture; then "
    "confirm, or check on a landmark.",
}


class KeptConfirmation(Section):
    """What a case keeps of a person's word: it stands on the registration that was confirmed."""

    vertebra: str
    because: Unconfirmed
    run: str
    """Which run of the server it was said in: past its end it says nothing."""
    from_s: float
    """When, by the clock of that run's images."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ConfirmationNeeded:
    """What a person is asked before navigation goes on.

    Attributes:
        because: of what.
        said: the same in a sentence without its full stop.
        remedy: what to look at, one or two full sentences.
        vertebra: that is registered.
        registration: its document.
        reference: the marker on the patient that it is fixed to; empty where it is fixed to the camera.
    """

    because: Unconfirmed
    said: str
    remedy: str
    vertebra: str
    registration: Document
    reference: str


def confirmation_name(vertebra: str) -> str:
    """What the document of a confirmation is called."""
    return f"going on with {vertebra}"


def kept_confirmation(document: Document) -> KeptConfirmation:
    """The confirmation in a document of the case.

    Raises:
        InvalidInput: CONFIRMATION_DOCUMENT_INVALID.
    """
    return read_document(
        KeptConfirmation, document, code="CONFIRMATION_DOCUMENT_INVALID", remedy="Confirm again."
    )


def believed_from_s(
    registration: KeptRegistration,
    check: KeptCheck | None,
    confirmation: KeptConfirmation | None,
    *,
    run: str,
) -> float | None:
    """When a person last touched, checked or confirmed it, by the images' clock; None before this run."""
    times_s = []
    if registration.run == run:
        # When it was touched is not kept where no tip touched: it then counts as long ago.
        times_s.append(float("-inf") if registration.from_s is None else registration.from_s)
    if check is not None and check.passed and check.run == run:
        times_s.append(check.from_s)
    if confirmation is not None and confirmation.run == run:
        times_s.append(confirmation.from_s)
    return max(times_s, default=None)


def confirmation_needed(
    registration: KeptRegistration, document: Document, *, believed_s: float | None, tracked_from_s: float
) -> ConfirmationNeeded | None:
    """What is to be asked, if anything.

    Args:
        registration: that holds.
        document: its document.
        believed_s: as `believed_from_s` gives it.
        tracked_from_s: since when the tracking process runs that looks at the camera now.
    """
    because = unconfirmed(registration.registration, believed_s, tracked_from_s=tracked_from_s)
    if because is None:
        return None
    return ConfirmationNeeded(
        because=because,
        said=SAID[because],
        remedy=REMEDY[registration.anchored_to],
        vertebra=registration.vertebra,
        registration=document,
        reference=registration.reference,
    )
