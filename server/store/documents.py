"""Documents: versions are added, read and withdrawn, and never changed.

A new version of a plan makes the registrations that depend on it out of date automatically, and the history
remains for the report. If the newest version is withdrawn there is none, because an older version must not
become valid again.
"""

import json
from collections import defaultdict
from collections.abc import Iterable, Iterator, Mapping, Sequence
from dataclasses import dataclass
from typing import cast

from sqlalchemy import ColumnClause, func, literal_column, select
from sqlalchemy.orm import Session

from server.store.cases import new_id
from server.store.errors import NotFound, StoreConflict, StoreError
from server.store.records import Document, DocumentKind, ImportRecord, Withdrawal
from server.store.tables import COMPLETE, BasisRow, DocumentFileRow, DocumentRow, FileRow
from server.store.validation import content_to_json, validate_name
from tracker.errors import InvalidInput

# Order of insertion; time stamps are not monotonic, because clocks can be set back.
IN_ORDER: ColumnClause[int] = literal_column("documents.rowid")


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
    session.add(row)
    session.flush()
    for place, basis in enumerate(new.depends_on):
        session.add(BasisRow(case_id=case_id, document_id=row.id, place=place, basis_id=basis))
    for place, file in enumerate(new.files):
        session.add(DocumentFileRow(case_id=case_id, document_id=row.id, place=place, file_id=file))
    session.flush()
    return document_of(row, new.depends_on, new.files)


def find_document(session: Session, case_id: str, document_id: str) -> Document:
    """Return a document.

    Raises:
        NotFound: DOCUMENT_UNKNOWN.
    """
    return _read(session, [document_row(session, case_id, document_id)])[0]


def document_row(session: Session, case_id: str, document_id: str) -> DocumentRow:
    """Return the row of a document.

    Raises:
        NotFound: DOCUMENT_UNKNOWN.
    """
    row = session.get(DocumentRow, (case_id, document_id))
    if row is None:
        raise document_unknown(case_id, document_id)
    return row


def versions(session: Session, case_id: str, kind: DocumentKind, name: str) -> tuple[Document, ...]:
    """Return all versions in ascending order."""
    chosen = (
        select(DocumentRow)
        .where(DocumentRow.case_id == case_id, DocumentRow.kind == kind.value, DocumentRow.name == name)
        .order_by(DocumentRow.version)
    )
    return _read(session, session.scalars(chosen).all())


def every_document(session: Session, case_id: str) -> Iterator[Document]:
    """Yield all documents of a case, each after those that it depends on."""
    bases, files = links_of(session, case_id)
    for row in session.scalars(
        select(DocumentRow)
        .where(DocumentRow.case_id == case_id)
        .order_by(IN_ORDER)
        .execution_options(yield_per=20)
    ):
        yield document_of(row, bases[row.id], files[row.id])


def contents_of(session: Session, case_id: str, ids: Sequence[str]) -> dict[str, Mapping[str, object]]:
    """Return the contents of documents by their ids."""
    chosen = select(DocumentRow.id, DocumentRow.content).where(
        DocumentRow.case_id == case_id, DocumentRow.id.in_(ids)
    )
    return {row.id: _content_of(case_id, row.id, row.content) for row in session.execute(chosen)}


def _content_of(case_id: str, document_id: str, stored: str) -> Mapping[str, object]:
    """Return the content of a row; a byte that was changed on the disk may have left no JSON."""
    try:
        content = json.loads(stored)
    except (ValueError, TypeError, RecursionError) as error:
        raise StoreError(
            "DOCUMENT_DAMAGED",
            f"the document {document_id} of the case {case_id} is damaged on the disk",
            "Check the disk, and restore the server's folder from a copy; other cases can be used.",
            {"case_id": case_id, "document_id": document_id},
        ) from error
    return cast("Mapping[str, object]", content)


def document_of(row: DocumentRow, depends_on: Iterable[str], files: Iterable[str]) -> Document:
    """Return the record of a row."""
    return Document(
        case_id=row.case_id,
        id=row.id,
        kind=DocumentKind(row.kind),
        name=row.name,
        version=row.version,
        content=_content_of(row.case_id, row.id, row.content),
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


def _read(session: Session, rows: Sequence[DocumentRow]) -> tuple[Document, ...]:
    if not rows:
        return ()
    case_id, ids = rows[0].case_id, [row.id for row in rows]
    bases, files = links_of(session, case_id, ids)
    return tuple(document_of(row, bases[row.id], files[row.id]) for row in rows)


def links_of(
    session: Session, case_id: str, ids: Sequence[str] | None = None
) -> tuple[Mapping[str, list[str]], Mapping[str, list[str]]]:
    """Return dependencies and files by document id; of all documents if no ids are given."""
    bases: Mapping[str, list[str]] = defaultdict(list)
    files: Mapping[str, list[str]] = defaultdict(list)
    of_bases = select(BasisRow).where(BasisRow.case_id == case_id).order_by(BasisRow.place)
    of_files = (
        select(DocumentFileRow).where(DocumentFileRow.case_id == case_id).order_by(DocumentFileRow.place)
    )
    # A query accepts a limited number of ids; above it, most documents of the case are needed anyway.
    if ids is not None and len(ids) <= 500:
        of_bases = of_bases.where(BasisRow.document_id.in_(ids))
        of_files = of_files.where(DocumentFileRow.document_id.in_(ids))
    for basis in session.scalars(of_bases):
        bases[basis.document_id].append(basis.basis_id)
    for file in session.scalars(of_files):
        files[file.document_id].append(file.file_id)
    return bases, files


def _next_version(session: Session, case_id: str, new: NewDocument) -> int:
    same = (DocumentRow.case_id == case_id, DocumentRow.kind == new.kind.value, DocumentRow.name == new.name)
    found = session.scalar(select(func.max(DocumentRow.version)).where(*same)) or 0
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
    return found + 1


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
