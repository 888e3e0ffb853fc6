"""Documents: versions are added, read and withdrawn, and never changed.

A new version of a plan makes the registrations that depend on it out of date automatically, and the history
remains for the report. If the newest version is withdrawn there is none, because an older version must not
become valid again.
"""

import itertools
import json
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import Any, TypeAlias, cast

from sqlalchemy import ColumnClause, ColumnElement, Row, literal_column, select
from sqlalchemy.orm import Session

from server.store.cases import new_id
from server.store.checksums import document_checksum
from server.store.errors import NotFound, StoreConflict, StoreError
from server.store.records import (
    Document,
    DocumentKind,
    DocumentVersion,
    Heading,
    ImportRecord,
    Withdrawal,
)
from server.store.tables import (
    COMPLETE,
    BasisRow,
    CaseRow,
    DocumentFileRow,
    DocumentRow,
    FileRow,
    NewestVersionRow,
)
from server.store.validation import content_to_json, validate_name
from tracker.errors import InvalidInput

# Order of insertion; time stamps are not monotonic, because clocks can be set back.
IN_ORDER: ColumnClause[int] = literal_column("documents.rowid")
AnyRow: TypeAlias = Row[*tuple[Any, ...]]
# So that the contents of a case are not in memory all at once.
IN_PARTS = {"yield_per": 20}


@dataclass(frozen=True, slots=True, kw_only=True)
class NewDocument:
    """A validated document that is to be stored."""

    kind: DocumentKind
    name: str
    text: str
    made_by: str
    depends_on: tuple[str, ...]
    files: tuple[str, ...]
    expected_version: int | None

    @classmethod
    def validated(
        cls,
        kind: DocumentKind,
        name: str,
        content: Mapping[str, object],
        *,
        made_by: str,
        depends_on: Sequence[str],
        files: Sequence[str] = (),
        expected_version: int | None = None,
    ) -> "NewDocument":
        """Validate a document before the database is accessed.

        Raises:
            InvalidInput: NAME_INVALID, CONTENT_NOT_JSON, CONTENT_TOO_LARGE.
        """
        return cls(
            kind=DocumentKind(kind),
            name=validate_name(name, of="name of the document"),
            text=content_to_json(content),
            made_by=validate_name(made_by, of="name of who made it"),
            depends_on=tuple(dict.fromkeys(depends_on)),
            files=tuple(dict.fromkeys(files)),
            expected_version=expected_version,
        )


def add_document(session: Session, case_id: str, new: NewDocument, *, now: str) -> Document:
    """Store the next version."""
    version = _next_version(session, case_id, new)
    _reject_strange(session, case_id, new)
    row = DocumentRow(
        case_id=case_id,
        id=new_id(),
        kind=new.kind.value,
        name=new.name,
        version=version,
        content=new.text,
        made_at=now,
        made_by=new.made_by,
    )
    insert_document(session, row, new.depends_on, new.files)
    return Document.of(_heading_of(row, new.depends_on, new.files), content_of(row.content))


def insert_document(
    session: Session, row: DocumentRow, depends_on: Sequence[str], files: Sequence[str]
) -> None:
    """Insert the row of a document, with its checksum, dependencies and files."""
    row.checksum = document_checksum(row, depends_on, files)
    session.add(row)
    session.flush()
    for place, basis in enumerate(depends_on):
        session.add(BasisRow(case_id=row.case_id, document_id=row.id, place=place, basis_id=basis))
    for place, file in enumerate(files):
        session.add(DocumentFileRow(case_id=row.case_id, document_id=row.id, place=place, file_id=file))
    session.merge(NewestVersionRow(case_id=row.case_id, kind=row.kind, name=row.name, version=row.version))
    session.flush()


def withdraw_document(session: Session, document: Heading, withdrawal: Withdrawal) -> None:
    """Add the withdrawal to the row of an intact document."""
    row = session.get_one(DocumentRow, (document.case_id, document.id))
    row.withdrawn_at, row.withdrawn_by, row.withdrawn_reason = withdrawal.at, withdrawal.by, withdrawal.reason
    row.checksum = document_checksum(row, document.depends_on, document.files)
    session.flush()


def find_document(session: Session, case_id: str, document_id: str) -> Document:
    """Return a document.

    Raises:
        NotFound: DOCUMENT_UNKNOWN.
        StoreError: DOCUMENT_DAMAGED.
    """
    (found,) = read_documents(session, case_id, [document_id])
    return found


def read_documents(session: Session, case_id: str, ids: Sequence[str]) -> tuple[Document, ...]:
    """Return documents in this order.

    Raises:
        NotFound: DOCUMENT_UNKNOWN.
        StoreError: DOCUMENT_DAMAGED.
    """
    stored = stored_documents(session, case_id, DocumentRow.id.in_(ids))
    found = {one.id: _document_of(case_id, one) for one in stored}
    for unknown in set(ids) - found.keys():
        raise document_unknown(case_id, unknown)
    return tuple(found[one] for one in ids)


def every_document(session: Session, case_id: str, *, without_damaged: bool = False) -> Iterator[Document]:
    """Yield all documents of a case, each after those that it depends on.

    Raises:
        StoreError: DOCUMENT_DAMAGED, unless they are left out.
    """
    for stored in stored_documents(session, case_id):
        if stored.heading is not None or not without_damaged:
            yield _document_of(case_id, stored)


@dataclass(frozen=True, slots=True, kw_only=True)
class StoredDocument:
    """A row of a document, as it was read.

    Attributes:
        row: number of the row.
        id: id of the document; like kind, name and version any value if the row is damaged.
        kind: its kind.
        name: its name.
        version: its version.
        content: its content as JSON.
        heading: its heading; None if the row does not match its checksum.
    """

    row: int
    id: str
    kind: str
    name: str
    version: int
    content: str
    heading: Heading | None


def stored_documents(
    session: Session, case_id: str, *chosen: ColumnElement[bool]
) -> Iterator[StoredDocument]:
    """Yield documents in the order in which they were stored, each compared with its checksum."""
    condition = (DocumentRow.case_id == case_id, *chosen)
    bases, files = _links_of(
        session, case_id, session.scalars(select(DocumentRow.id).where(*condition)).all()
    )
    # Not as objects: a row without a key, which a damaged one can be, would be skipped.
    columns = (IN_ORDER.label("row"), *DocumentRow.__table__.columns)
    rows = session.execute(select(*columns).where(*condition).order_by(IN_ORDER), execution_options=IN_PARTS)
    for row in rows:
        depends_on, belonging = bases.get(row.id, []), files.get(row.id, [])
        # A row that is found by a damaged index is of another case, and intact.
        intact = row.case_id == case_id and row.checksum == document_checksum(row, depends_on, belonging)
        yield StoredDocument(
            row=row.row,
            id=row.id,
            kind=row.kind,
            name=row.name,
            version=row.version,
            content=row.content,
            heading=_heading_of(row, depends_on, belonging) if intact else None,
        )


def _document_of(case_id: str, stored: StoredDocument) -> Document:
    """Return the document of a row; StoreError DOCUMENT_DAMAGED."""
    if stored.heading is None:
        raise document_damaged(case_id, stored.id)
    return Document.of(stored.heading, content_of(stored.content))


def content_of(stored: str) -> Mapping[str, object]:
    """Return the content of an intact row."""
    return cast("Mapping[str, object]", json.loads(stored))


def document_damaged(case_id: str, document_id: object) -> StoreError:
    """Return the error for a document that does not match its checksum."""
    return StoreError(
        "DOCUMENT_DAMAGED",
        f"the document {document_id} of the case {case_id} is damaged on the disk",
        "Do its step again, or open the list of documents and go on with the version before it. Then check "
        "the disk.",
        {"case_id": case_id, "document_id": f"{document_id}"},
    )


def _heading_of(row: DocumentRow | AnyRow, depends_on: Iterable[str], files: Iterable[str]) -> Heading:
    return Heading(
        case_id=row.case_id,
        id=row.id,
        kind=DocumentKind(row.kind),
        name=row.name,
        version=row.version,
        made_at=row.made_at,
        made_by=row.made_by,
        depends_on=tuple(depends_on),
        files=tuple(files),
        withdrawn=withdrawal_of(row.withdrawn_at, row.withdrawn_by, row.withdrawn_reason),
        imported=imported_of(row.imported_at, row.imported_by),
    )


def imported_of(at: str | None, by: str | None) -> ImportRecord | None:
    """Return the record of an import; None if the document was made here."""
    return None if at is None else ImportRecord(by=by or "", at=at)


def withdrawal_of(at: str | None, by: str | None, reason: str | None) -> Withdrawal | None:
    """Return the record of a withdrawal; None if there was none."""
    return None if at is None else Withdrawal(at=at, by=by or "", reason=reason or "")


def _links_of(
    session: Session, case_id: str, ids: Sequence[str]
) -> tuple[Mapping[str, list[str]], Mapping[str, list[str]]]:
    """Return dependencies and files by document id."""
    bases: Mapping[str, list[str]] = defaultdict(list)
    files: Mapping[str, list[str]] = defaultdict(list)
    of_bases = select(BasisRow.document_id, BasisRow.basis_id).where(BasisRow.case_id == case_id)
    of_files = select(DocumentFileRow.document_id, DocumentFileRow.file_id).where(
        DocumentFileRow.case_id == case_id
    )
    # A query accepts a limited number of ids; above it, most documents of the case are needed anyway.
    if len(ids) <= 500:
        of_bases = of_bases.where(BasisRow.document_id.in_(ids))
        of_files = of_files.where(DocumentFileRow.document_id.in_(ids))
    for document_id, basis_id in session.execute(of_bases.order_by(BasisRow.place)):
        bases[document_id].append(basis_id)
    for document_id, file_id in session.execute(of_files.order_by(DocumentFileRow.place)):
        files[document_id].append(file_id)
    return bases, files


def newest_version(max_intact: int, recorded: object) -> int:
    """Return the number of the newest version, which can be lost.

    Args:
        max_intact: highest version of which the row is intact; 0 if there is none.
        recorded: number of the newest version according to `NewestVersionRow`; None if that row is lost.
    """
    if isinstance(recorded, int):
        return max(max_intact, recorded)
    return max_intact + 1 if max_intact else 0


def recorded_versions(session: Session, case_id: str) -> dict[tuple[str, str], object]:
    """Return the recorded number of the newest version by kind and name."""
    columns = (NewestVersionRow.kind, NewestVersionRow.name, NewestVersionRow.version)
    rows = session.execute(select(*columns).where(NewestVersionRow.case_id == case_id))
    return {(row.kind, row.name): row.version for row in rows}


def lost_versions(session: Session, confirmed: Iterable[DocumentVersion]) -> list[DocumentVersion]:
    """Return the newest confirmed version of each name, if it is newer than the recorded one of its case."""
    recorded = {
        (row.case_id, row.kind, row.name): row.version
        for row in session.scalars(select(NewestVersionRow))
        if row is not None
    }
    cases = set(session.scalars(select(CaseRow.id)))
    newest = {(one.case_id, one.kind.value, one.name): one for one in sorted(confirmed)}
    return [
        one
        for key, one in newest.items()
        if one.case_id in cases and _is_newer(session, one, recorded.get(key))
    ]


def _is_newer(session: Session, confirmed: DocumentVersion, recorded: object) -> bool:
    if isinstance(recorded, int):
        return confirmed.version > recorded
    # Without its record a document counts as lost already, if there is a row of it.
    same = (DocumentRow.kind == confirmed.kind.value, DocumentRow.name == confirmed.name)
    rows = select(DocumentRow.id).where(DocumentRow.case_id == confirmed.case_id, *same).limit(1)
    return session.execute(rows).first() is None


def not_withdrawn(session: Session, confirmed: Iterable[DocumentVersion]) -> dict[DocumentVersion, str]:
    """Return the ids of the intact ones of these versions that are not withdrawn."""
    found = {}
    for one in confirmed:
        same = (DocumentRow.kind == one.kind.value, DocumentRow.name == one.name)
        of_version = (*same, DocumentRow.version == one.version, DocumentRow.withdrawn_at.is_(None))
        rows = select(DocumentRow.id).where(DocumentRow.case_id == one.case_id, *of_version)
        if session.execute(rows).first() is not None:
            for stored in stored_documents(session, one.case_id, *of_version):
                if stored.heading is not None:
                    found[one] = stored.id
    return found


def record_newest(session: Session, newest: DocumentVersion) -> None:
    """Record that there is this version, which counts as lost while its row is missing."""
    session.merge(
        NewestVersionRow(
            case_id=newest.case_id, kind=newest.kind.value, name=newest.name, version=newest.version
        )
    )


def _next_version(session: Session, case_id: str, new: NewDocument) -> int:
    same = (DocumentRow.kind == new.kind.value, DocumentRow.name == new.name)
    stored = list(stored_documents(session, case_id, *same))
    record = session.get(NewestVersionRow, (case_id, new.kind.value, new.name))
    intact = max((one.version for one in stored if one.heading is not None), default=0)
    found = newest_version(intact, None if record is None else record.version)
    if new.expected_version is not None and new.expected_version != found:
        raise StoreConflict(
            "VERSION_CONFLICT",
            f"{new.kind.value} '{new.name}' is at version {found}, but the change was made on version "
            f"{new.expected_version}",
            "Load the newest version, and apply the change to it again.",
            {
                "found_version": found,
                "expected_version": new.expected_version,
                "kind": new.kind.value,
                "name": new.name,
            },
        )
    # A damaged row can have any version.
    taken = {one.version for one in stored}
    return next(version for version in itertools.count(found + 1) if version not in taken)


def _reject_strange(session: Session, case_id: str, new: NewDocument) -> None:
    """Reject unknown dependencies and files, and any link to the patient's identity."""
    for basis in new.depends_on:
        found = session.get(DocumentRow, (case_id, basis))
        if found is None:
            raise document_unknown(case_id, basis)
        if found.kind == DocumentKind.PATIENT:
            raise InvalidInput(
                "DEPENDS_ON_IDENTITY",
                "a document must not depend on the patient's identity, because that is not exported",
                "Remove it from the dependencies of the document.",
                {"document_id": basis},
            )
    if new.files and new.kind is DocumentKind.PATIENT:
        raise InvalidInput(
            "IDENTITY_WITH_FILES",
            "the document of the patient's identity must not have files, because files are exported",
            "Attach the file to another document.",
        )
    for file in new.files:
        row = session.get(FileRow, (case_id, file))
        if row is None or row.state != COMPLETE:
            raise file_unknown(case_id, file)


def file_unknown(case_id: str, file_id: str) -> NotFound:
    """Return the error for an unknown file."""
    return NotFound(
        "FILE_UNKNOWN",
        f"there is no file {file_id[:60]} in the case {case_id[:40]}",
        f"GET /api/cases/{case_id[:40]}/files lists the files of the case.",
        {"case_id": case_id[:40], "file_id": file_id[:60]},
    )


def document_unknown(case_id: str, document_id: str) -> NotFound:
    """Return the error for an unknown document."""
    return NotFound(
        "DOCUMENT_UNKNOWN",
        f"there is no document {document_id[:40]} in the case {case_id[:40]}",
        f"GET /api/cases/{case_id[:40]}/documents lists the documents of the case.",
        {"case_id": case_id[:40], "document_id": document_id[:40]},
    )
