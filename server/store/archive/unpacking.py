"""A case taken in from an archive."""

from collections.abc import Iterable
from pathlib import Path

from sqlalchemy.orm import Session

from server.store.archive.form import (
    CASE,
    DOCUMENTS,
    FILES,
    CaseForm,
    DocumentForm,
    WithdrawalForm,
    rejected,
)
from server.store.archive.reading import Parts, opened, shaped
from server.store.cases import add_case, case_of
from server.store.checks import checked_name, text_of
from server.store.errors import told
from server.store.files import READ_ONLY, UNFINISHED, make_folder
from server.store.home import sync_file, sync_folder
from server.store.ledger import Ledger
from server.store.records import Case, DocumentKind, Imported, says_archive
from server.store.sweep import remove_case
from server.store.tables import (
    ARRIVING,
    HERE,
    WHOLE,
    BasisRow,
    CaseRow,
    DocumentFileRow,
    DocumentRow,
    FileRow,
)
from tracker.errors import InvalidInput

# Who withdraws what does not count here.
TAKING_IN = "Coaxial"


def unpack(ledger: Ledger, archive: Path, *, by: str) -> Case:
    """Take a case in; it is there whole when this returns, and otherwise nothing of it is.

    Each of its documents says from then on that it came in, by whom and when: the names in an archive were
    written by whoever wrote the archive.

    Raises:
        InvalidInput: ARCHIVE_INVALID, ARCHIVE_NEWER.
        DiskFull: STORE_FULL.
    """
    with told(ledger.home.folder), opened(archive) as parts:
        case, documents = _judged(parts)
        ledger.home.reject_without_room(parts.total_bytes)
        with ledger.writing() as session:
            arriving = add_case(session, name=case.name, now=ledger.now, state=ARRIVING, copied_from=case.id)
        try:
            _write_files(ledger.home.cases / arriving.id, case, parts)
            with ledger.writing() as session:
                imported = Imported(by=by, at=ledger.now)
                kept = [_doubted(document, imported.at) for document in documents]
                return _arrive(session, arriving.id, case, kept, parts, imported)
        except BaseException:
            remove_case(ledger, arriving.id)
            raise


def _judged(parts: Parts) -> tuple[CaseForm, list[DocumentForm]]:
    """The case and its documents, if they fit together."""
    case = shaped(CaseForm, parts.text(CASE), where=CASE)
    files = [file.id for file in case.files]
    expected = {f"{FILES}{file}" for file in files} | {CASE, DOCUMENTS}
    if len(set(files)) != len(files) or {part.path for part in parts.manifest.parts} != expected:
        raise rejected(f"its files are not those that {CASE} names")
    lines = parts.text(DOCUMENTS).split(b"\n")
    if lines.pop() != b"":
        raise rejected(f"{DOCUMENTS} ends in the middle of a line")
    documents = [
        shaped(DocumentForm, line, where=f"{DOCUMENTS}, line {number}")
        for number, line in enumerate(lines, 1)
    ]
    try:
        checked_name(case.name, of="name of the case")
        _reject_misfits(documents, set(files))
    except InvalidInput as error:
        if error.code == "ARCHIVE_INVALID":
            raise
        raise rejected(error.message) from error
    return case, documents


def _reject_misfits(documents: Iterable[DocumentForm], files: set[str]) -> None:
    """Each document stands on those before it, has its own version, and files that are there."""
    earlier: dict[str, DocumentKind] = {}
    newest: dict[tuple[DocumentKind, str], int] = {}
    for document in documents:
        text_of(document.content)
        for name in (document.name, document.made_by):
            if checked_name(name, of="name of a document") != name:
                raise rejected(f"the name of the document {document.id} is not in its plain form")
        if document.id in earlier:
            raise rejected(f"it has two documents {document.id}")
        if newest.get((document.kind, document.name), 0) + 1 != document.version:
            before = document.version - 1
            raise rejected(f"the document {document.id} has version {before + 1}, but not version {before}")
        for basis in document.stands_on:
            if earlier.get(basis, DocumentKind.PATIENT) is DocumentKind.PATIENT:
                raise rejected(f"the document {document.id} stands on {basis}, which is not before it")
        repeated = any(len(set(ids)) != len(ids) for ids in (document.stands_on, document.files))
        if repeated or not files.issuperset(document.files):
            raise rejected(
                f"the document {document.id} has files or bases that are not there, or there twice"
            )
        earlier[document.id] = document.kind
        newest[document.kind, document.name] = document.version


def _doubted(document: DocumentForm, now: str) -> DocumentForm:
    """A signature no longer counts, and nobody withdrew anything here: who wrote it is not known."""
    withdrawn = document.withdrawn
    if withdrawn is not None:
        told_so = withdrawn.model_copy(update={"by": says_archive(withdrawn.by)})
        return document.model_copy(update={"withdrawn": told_so})
    if document.kind is not DocumentKind.SIGNATURE:
        return document
    reason = "it came in with an archive, and has to be signed again here"
    withdrawn = WithdrawalForm(at=now, by=TAKING_IN, reason=reason)
    return document.model_copy(update={"withdrawn": withdrawn})


def _write_files(folder: Path, case: CaseForm, parts: Parts) -> None:
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
    sync_folder(folder)


def _arrive(
    session: Session,
    case_id: str,
    case: CaseForm,
    documents: Iterable[DocumentForm],
    parts: Parts,
    imported: Imported,
) -> Case:
    row = session.get_one(CaseRow, case_id)
    row.state, row.created_at, row.changed_at = HERE, case.created_at, case.changed_at
    for file in case.files:
        part = parts.part(f"{FILES}{file.id}")
        session.add(
            FileRow(
                case_id=case_id,
                id=file.id,
                state=WHOLE,
                size_bytes=part.size_bytes,
                sha256=part.sha256,
                made_at=file.made_at,
            )
        )
    session.flush()
    for document in documents:
        session.add(_document_row(case_id, document, imported))
        session.flush()
        for place, basis in enumerate(document.stands_on):
            session.add(BasisRow(case_id=case_id, document_id=document.id, place=place, basis_id=basis))
        for place, used in enumerate(document.files):
            session.add(DocumentFileRow(case_id=case_id, document_id=document.id, place=place, file_id=used))
    session.flush()
    return case_of(row)


def _document_row(case_id: str, document: DocumentForm, imported: Imported) -> DocumentRow:
    withdrawn = document.withdrawn
    return DocumentRow(
        case_id=case_id,
        id=document.id,
        kind=document.kind.value,
        name=document.name,
        version=document.version,
        content=text_of(document.content),
        made_at=document.made_at,
        made_by=document.made_by,
        withdrawn_at=None if withdrawn is None else withdrawn.at,
        withdrawn_by=None if withdrawn is None else withdrawn.by,
        withdrawn_reason=None if withdrawn is None else withdrawn.reason,
        imported_by=imported.by,
        imported_at=imported.at,
    )
