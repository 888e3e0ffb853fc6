"""Comments of people on instants of recordings. Each is a document of the case, with its author and time.

A comment stays in the case when its recording is deleted, and is withdrawn like every document.
"""

import secrets
from collections.abc import Sequence
from dataclasses import dataclass
from typing import Annotated

from pydantic import Field

from server.config import Section
from server.procedure.documents import parse_document
from server.procedure.open_case import require_open_case
from server.recording.service import RecordingService
from server.store import CaseStore, Document, DocumentKind

MAX_TEXT_LENGTH = 500


class CommentRecord(Section):
    """A comment as stored in a case; its document has the author and the time."""

    recording: str
    at_s: Annotated[float, Field(ge=0.0)]
    """Time since the first image."""
    text: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Comment:
    """A comment.

    Attributes:
        document_id: Id of its document.
        at_s: Commented instant, since the first image of the recording.
        text: One line.
        made_at: UTC, ISO 8601.
        made_by: Author.
    """

    document_id: str
    at_s: float
    text: str
    made_at: str
    made_by: str


class RecordingComments:
    """Comments on the recordings of the open case. Thread-safe.

    Args:
        store: the cases.
        recordings: the recordings.
    """

    def __init__(self, store: CaseStore, recordings: RecordingService) -> None:
        self._store = store
        self._recordings = recordings

    def all(self, name: str) -> Sequence[Comment]:
        """Return the comments on a recording, in the order of their instants.

        Raises:
            SetupOrderError: NO_CASE_OPEN.
            InvalidInput: COMMENT_DOCUMENT_INVALID.
        """
        case = require_open_case(self._store)
        found = (_comment(document) for document in self._store.all(case.id, DocumentKind.COMMENT))
        return sorted(
            (comment for recording, comment in found if recording == name),
            key=lambda one: (one.at_s, one.made_at),
        )

    def add(self, name: str, *, at_s: float, text: str, made_by: str) -> Comment:
        """Store a comment on a recording.

        Raises:
            NotFound: RECORDING_UNKNOWN.
            SetupOrderError: NO_CASE_OPEN.
            StoreError: The comment cannot be stored.
        """
        self._recordings.path(name)
        case = require_open_case(self._store)
        record = CommentRecord(recording=name, at_s=at_s, text=text)
        document = self._store.put(
            case.id,
            DocumentKind.COMMENT,
            f"{name.partition('.')[0]} {secrets.token_hex(4)}",
            record.model_dump(mode="json"),
            made_by=made_by,
        )
        return _comment(document)[1]


def _comment(document: Document) -> tuple[str, Comment]:
    """Return the recording of a comment, and the comment."""
    record = parse_document(
        CommentRecord, document, code="COMMENT_DOCUMENT_INVALID", remedy="Withdraw this document."
    )
    return record.recording, Comment(
        document_id=document.id,
        at_s=record.at_s,
        text=record.text,
        made_at=document.made_at,
        made_by=document.made_by,
    )
