"""Import of a case from an archive."""

from collections.abc import Iterable, Sequence
from pathlib import Path

from sqlalchemy.orm import Session

from server.disk import sync_file, sync_path
from server.store.archive.reader import Parts, open_archive, parse_part
from server.store.archive.schema import (
    CASE,
    DOCUMENTS,
    FILES,
    MANIFEST,
    CaseSchema,
    DocumentSchema,
    MissingDocumentSchema,
    WithdrawalSchema,
    archive_error,
)
from server.store.case_database import CaseDatabase
from server.store.cases import add_case, case_of
from server.store.cleanup import remove_case
from server.store.documents import insert_document, record_newest
from server.store.errors import translate_errors
from server.store.files import READ_ONLY, UNFINISHED, make_folder
from server.store.records import Case, DocumentKind, DocumentVersion, ImportRecord, says_archive
from server.store.tables import (
    COMPLETE,
    IMPORTING,
    PRESENT,
    CaseRow,
    DocumentRow,
    FileRow,
    NewestVersionRow,
)
from server.store.validation import content_to_json, validate_name
from tracker.errors import InvalidInput

# Kind of a missing document of which only the id is known.
UNKNOWN = "unknown"
# Author of the withdrawal of imported signatures.
WITHDRAWN_BY = "Coaxial"


def unpack(database: CaseDatabase, archive: Path, *, by: str) -> tuple[Case, int]:
    """Import a case atomically; return it, and the number of its documents and files that are missing.

    What the archive states as missing, because it was damaged, counts as damaged here, too: `find_damage`
    names it, and what depends on it is out of date.

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
                made = _insert_case(session, arriving.id, case, stored, parts, imported)
                return made, parts.manifest.missing.count
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
    missing = parts.manifest.missing
    files += [file.id for file in missing.files]
    if len(set(files)) != len(files):
        raise archive_error(f"a file that {MANIFEST} states as missing is there, or is stated twice")
    lines = parts.text(DOCUMENTS).split(b"\n")
    if lines.pop() != b"":
        raise archive_error(f"{DOCUMENTS} ends inside a line")
    documents = [
        parse_part(DocumentSchema, line, where=f"{DOCUMENTS}, line {number}")
        for number, line in enumerate(lines, 1)
    ]
    try:
        validate_name(case.name, of="name of the case")
        _reject_misfits(documents, set(files), missing.documents)
    except InvalidInput as error:
        if error.code == "ARCHIVE_INVALID":
            raise
        raise archive_error(error.message) from error
    return case, documents


def _reject_misfits(
    documents: Iterable[DocumentSchema], files: set[str], missing: Sequence[MissingDocumentSchema]
) -> None:
    """Reject documents with unknown dependencies, wrong versions or missing files."""
    earlier: dict[str, DocumentKind | None] = {one.id: one.kind for one in missing}
    versions = {(one.kind, one.name, one.version) for one in missing if one.kind is not None}
    if len(earlier) != len(missing) or len(versions) != sum(one.kind is not None for one in missing):
        raise archive_error(f"{MANIFEST} states a document as missing twice")
    newest: dict[tuple[DocumentKind, str], int] = {}
    for one in missing:
        if one.kind is not None:
            validate_name(one.name, of="name of a document")
    for document in documents:
        content_to_json(document.content)
        for name in (document.name, document.made_by):
            if validate_name(name, of="name of a document") != name:
                raise archive_error(f"the name of the document {document.id} is not normalised")
        if document.id in earlier:
            raise archive_error(f"it has two documents {document.id}")
        expected = newest.get((document.kind, document.name), 0) + 1
        while (document.kind, document.name, expected) in versions:
            expected += 1
        if document.version != expected:
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
    for file in parts.manifest.missing.files:
        session.add(
            FileRow(
                case_id=case_id,
                id=file.id,
                state=COMPLETE,
                size_bytes=file.size_bytes,
                sha256=file.sha256,
                made_at=parts.manifest.made_at,
            )
        )
    for missing in parts.manifest.missing.documents:
        _insert_missing(session, case_id, missing, imported)
    session.flush()
    for document in documents:
        row_of_document = _document_row(case_id, document, imported)
        insert_document(session, row_of_document, document.stands_on, document.files)
    for missing in parts.manifest.missing.documents:
        _record_newest(session, case_id, missing)
    return case_of(row)


def _insert_missing(
    session: Session, case_id: str, missing: MissingDocumentSchema, imported: ImportRecord
) -> None:
    """Insert a row for a missing document, on which others may depend; it matches no checksum."""
    # A version below 1 is a damaged number.
    kind = missing.kind.value if missing.kind is not None and missing.version > 0 else UNKNOWN
    session.add(
        DocumentRow(
            case_id=case_id,
            id=missing.id,
            kind=kind,
            name=missing.id if kind == UNKNOWN else missing.name,
            version=max(1, missing.version),
            content="",
            made_at=imported.at,
            made_by=imported.by,
            imported_by=imported.by,
            imported_at=imported.at,
            checksum="",
        )
    )


def _record_newest(session: Session, case_id: str, missing: MissingDocumentSchema) -> None:
    """Record a missing document as the newest version, if no newer one is there."""
    if missing.kind is None:
        return
    row = session.get(NewestVersionRow, (case_id, missing.kind.value, missing.name))
    if row is None or row.version < missing.version:
        record_newest(session, DocumentVersion(case_id, missing.kind, missing.name, missing.version))


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
