"""Checksums of rows, compared wherever a row is read, so that a changed bit on the disk changes no record.

They detect damage, not forgery: whoever can write the database can write its checksums.
"""

import hashlib
import json
from collections.abc import Sequence
from typing import Protocol


class DocumentFields(Protocol):
    """What is read from the row of a document."""

    case_id: str
    id: str
    kind: str
    name: str
    version: int
    content: str
    made_at: str
    made_by: str
    withdrawn_at: str | None
    withdrawn_by: str | None
    withdrawn_reason: str | None
    imported_by: str | None
    imported_at: str | None


class CaseFields(Protocol):
    """What is read from the row of a case."""

    id: str
    name: str
    state: str
    created_at: str
    changed_at: str
    copied_from: str | None


class FileFields(Protocol):
    """What is read from the row of a file."""

    case_id: str
    id: str
    state: str
    size_bytes: int
    sha256: str
    made_at: str


def document_checksum(row: DocumentFields, depends_on: Sequence[str], files: Sequence[str]) -> str:
    """Return the checksum of a document with its withdrawal, import, dependencies and files."""
    withdrawal = [row.withdrawn_at, row.withdrawn_by, row.withdrawn_reason]
    made = [row.made_at, row.made_by, row.imported_at, row.imported_by]
    heading = [row.case_id, row.id, row.kind, row.name, row.version]
    return _checksum("document", [*heading, row.content, *made, withdrawal, list(depends_on), list(files)])


def case_checksum(row: CaseFields) -> str:
    """Return the checksum of a case, without its documents and files."""
    times = [row.created_at, row.changed_at]
    return _checksum("case", [row.id, row.name, row.state, *times, row.copied_from])


def file_checksum(row: FileFields) -> str:
    """Return the checksum of the row of a file, which has the checksum of its content."""
    return _checksum("file", [row.case_id, row.id, row.state, row.size_bytes, row.sha256, row.made_at])


def _checksum(domain: str, values: Sequence[object]) -> str:
    # A damaged row can have a value of any type of SQLite, which has another text than the right one.
    text = json.dumps([f"coaxial {domain}", *values], separators=(",", ":"), default=repr)
    return hashlib.sha256(text.encode()).hexdigest()
