"""Import of a case from an archive."""

from collections.abc import Iterable
from pathlib import Path

from sqlalchemy.orm import Session

from server.disk import sync_file, sync_path
from server.store.archive.reader import Parts, open_archive, parse_part
from server.store.archive.schema import (
    CASE,
    DOCUMENTS,
    FILES,
    CaseSchema,
    DocumentSchema,
    WithdrawalSchema,
    archive_error,
)
from server.store.case_database import CaseDatabase
from server.store.cases import add_case, case_of
from server.store.cleanup import remove_case
from server.store.documents import insert_document
from server.store.errors import translate_errors
from server.store.files import READ_ONLY, UNFINISHED, make_folder
from server.store.records import Case, DocumentKind, ImportRecord, says_archive
from server.store.tables import (
    COMPLETE,
    IMPORTING,
    PRESENT,
    CaseRow,
    DocumentRow,
    FileRow,
)
from server.store.validation import content_to_json, validate_name
from tracker.errors import InvalidInput

# Author of the withdrawal of imported signatures.
WITHDRAWN_BY = "Coaxial"


def unpack(database: CaseDatabase, archive: Path, *, by: str) -> Case:
    """Import a case atomically.

    Each of its documents is marked as imported, with person and time, because the names in an archive are not
    authenticated.

    Raises:
        InvalidInput: ARCHIVE_INVALID, ARCHIVE_NEWER.
        DiskFull: STORE_FULL.
    """
    with translate_errors(database.home.folder), open_archive(archive) as parts:
        case, documents = _validated(parts)
        database.home.reject_without_space(parts.total_bytes)
        with database.write_session() as session:
            arriving = add_case(
                session, name=case.name, now=database.now, state=IMPORTING, copied_from=case.id
            )
        try:
            _write_files(database.home.cases / arriving.id, case, parts)
            with database.write_session() as session:
                imported = ImportRecord(by=by, at=database.now)
                stored = [_as_imported(document, imported.at) for document in documents]
                return _insert_case(session, arriving.id, case, stored, parts, imported)
        except BaseException:
            remove_case(database, arriving.id)
            raise


def _validated(parts: Parts) -> tuple[CaseSchema, list[DocumentSchema]]:
    """Parse and validate the case and its documents."""
    case = parse_part(CaseSchema, parts.text(CASE), where=CASE)
    files = [file.id for file in case.files]
    expected = {f"{FILES}{file}" for file in files} | {CASE, DOCUMENTS}
    if len(set(files)) != len(files) or {part.path for part in parts.manifest.parts} != expected:
        raise archive_error(f"its files are not those listed in {CASE}")
    lines = parts.text(DOCUMENTS).split(b"\n")
    if lines.pop() != b"":
        raise archive_error(f"{DOCUMENTS} ends inside a line")
    documents = [
        parse_part(DocumentSchema, line, where=f"{DOCUMENTS}, line {number}")
        for number, line in enumerate(lines, 1)
    ]
    try:
        validate_name(case.name, of="name of the case")
        _reject_misfits(documents, set(files))
    except InvalidInput as error:
        if error.code == "ARCHIVE_INVALID":
            raise
        raise archive_error(error.message) from error
    return case, documents


def _reject_misfits(documents: Iterable[DocumentSchema], files: set[str]) -> None:
    """Reject documents with unknown dependencies, wrong versions or missing files."""
    earlier: dict[str, DocumentKind] = {}
    newest: dict[tuple[DocumentKind, str], int] = {}
    for document in documents:
        content_to_json(document.content)
        for name in (document.name, document.made_by):
            if validate_name(name, of="name of a document") != name:
                raise archive_error(f"the name of the document {document.id} is not normalised")
        if document.id in earlier:
            raise archive_error(f"it has two documents {document.id}")
        if newest.get((document.kind, document.name), 0) + 1 != document.version:
            before = document.version - 1
            raise archive_error(
                f"the document {document.id} has version {before + 1}, but not version {before}"
            )
        for basis in document.stands_on:
            if earlier.get(basis, DocumentKind.PATIENT) is DocumentKind.PATIENT:
                raise archive_error(
                    f"the document {document.id} depends on {basis}, which does not precede it"
                )
        repeated = any(len(set(ids)) != len(ids) for ids in (document.stands_on, document.files))
        if repeated or not files.issuperset(document.files):
            raise archive_error(f"the document {document.id} has missing or duplicate files or dependencies")
        earlier[document.id] = document.kind
        newest[document.kind, document.name] = document.version


def _as_imported(document: DocumentSchema, now: str) -> DocumentSchema:
    """Withdraw imported signatures, and mark names as stated by the archive: they are not authenticated."""
    withdrawn = document.withdrawn
    if withdrawn is not None:
        attributed = withdrawn.model_copy(update={"by": says_archive(withdrawn.by)})
        return document.model_copy(update={"withdrawn": attributed})
    if document.kind is not DocumentKind.SIGNATURE:
        return document
    reason = "it was imported with an archive, and has to be signed again here"
    withdrawn = WithdrawalSchema(at=now, by=WITHDRAWN_BY, reason=reason)
    return document.model_copy(update={"withdrawn": withdrawn})


def _write_files(folder: Path, case: CaseSchema, parts: Parts) -> None:
    make_folder(folder)
    for file in case.files:
        part = folder / f"{UNFINISHED}{file.id}"
        with part.open("xb") as stream:
            for piece in parts.pieces(f"{FILES}{file.id}"):
                stream.write(piece)
            stream.flush()
            sync_file(stream.fileno())
        part.chmod(READ_ONLY)
        part.replace(folder / file.id)
    sync_path(folder)


def _insert_case(
    session: Session,
    case_id: str,
    case: CaseSchema,
    documents: Iterable[DocumentSchema],
    parts: Parts,
    imported: ImportRecord,
) -> Case:
    row = session.get_one(CaseRow, case_id)
    row.state, row.created_at, row.changed_at = PRESENT, case.created_at, case.changed_at
    for file in case.files:
        part = parts.part(f"{FILES}{file.id}")
        session.add(
            FileRow(
                case_id=case_id,
                id=file.id,
                state=COMPLETE,
                size_bytes=part.size_bytes,
                sha256=part.sha256,
                made_at=file.made_at,
            )
        )
    session.flush()
    for document in documents:
        row_of_document = _document_row(case_id, document, imported)
        insert_document(session, row_of_document, document.stands_on, document.files)
    return case_of(row)


def _document_row(case_id: str, document: DocumentSchema, imported: ImportRecord) -> DocumentRow:
    withdrawn = document.withdrawn
    return DocumentRow(
        case_id=case_id,
        id=document.id,
        kind=document.kind.value,
        name=document.name,
        version=document.version,
        content=content_to_json(document.content),
        made_at=document.made_at,
        made_by=document.made_by,
        withdrawn_at=None if withdrawn is None else withdrawn.at,
        withdrawn_by=None if withdrawn is None else withdrawn.by,
        withdrawn_reason=None if withdrawn is None else withdrawn.reason,
        imported_by=imported.by,
        imported_at=imported.at,
    )
