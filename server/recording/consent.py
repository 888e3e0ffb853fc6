"""The patient's consent to recordings, as stated by a person; without it nothing is recorded."""

from dataclasses import dataclass
from enum import StrEnum

from server.config import Section
from server.procedure.documents import parse_document
from server.store import CaseStore, DocumentKind

NAME = "recording"


class ConsentState(StrEnum):
    """State of the consent."""

    NOT_REQUIRED = "not_required"  # recording.consent
    NOT_ANSWERED = "not_answered"
    GIVEN = "given"
    NOT_GIVEN = "not_given"

    @property
    def permits_recording(self) -> bool:
        """Whether a recording may start."""
        return self in (ConsentState.NOT_REQUIRED, ConsentState.GIVEN)


class ConsentRecord(Section):
    """An answer as stored in a case; its document has the author and the time."""

    is_given: bool


@dataclass(frozen=True, slots=True, kw_only=True)
class Consent:
    """The consent of a case.

    Attributes:
        state: State of the consent.
        answered_at: UTC, ISO 8601; empty without an answer.
        answered_by: Person who answered; empty without an answer.
    """

    state: ConsentState
    answered_at: str = ""
    answered_by: str = ""


def stored_consent(store: CaseStore, case_id: str) -> Consent:
    """Return the newest answer of a case.

    Withdrawn answers are ignored, and so are answers from an archive, because nobody signed in here gave
    them.

    Raises:
        InvalidInput: CONSENT_DOCUMENT_INVALID.
    """
    document = store.latest(case_id, DocumentKind.CONSENT, NAME)
    if document is None or document.imported is not None:
        return Consent(state=ConsentState.NOT_ANSWERED)
    record = parse_document(
        ConsentRecord, document, code="CONSENT_DOCUMENT_INVALID", remedy="Answer the question again."
    )
    return Consent(
        state=ConsentState.GIVEN if record.is_given else ConsentState.NOT_GIVEN,
        answered_at=document.made_at,
        answered_by=document.made_by,
    )
