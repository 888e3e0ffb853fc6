"""Files of cases, written atomically.

A row in state "coming" is stored before the first byte. The file is written under a temporary name, synced
and renamed, its folder is synced, and only then the row changes to "whole". After a power failure at any
point, the next start finds the row and removes the incomplete file, and nothing else.
"""

import hashlib
import os
from collections.abc import Iterable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from sqlalchemy import select
from sqlalchemy.orm import Session

from server.disk import sync_file, sync_path
from server.store.case_database import CaseDatabase
from server.store.cases import case_row, new_id
from server.store.checksums import file_checksum
from server.store.documents import file_unknown
from server.store.errors import StoreError, translate_errors
from server.store.home import PRIVATE
from server.store.records import Damage, StoredFile
from server.store.tables import COMPLETE, WRITING, FileRow
from server.store.validation import validate_suffix
from server.store.validity import lineage_of
from server.texts import Reason, reason

UNFINISHED = "part-"
CHUNK_BYTES = 2**20
READ_ONLY = 0o400


class NewFile:
    """A new file that is being written.

    Attributes:
        path: path to write to; another process may write it.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._stored: StoredFile | None = None

    @property
    def stored(self) -> StoredFile:
        """The stored file; available after the end of the context manager."""
        if self._stored is None:
            raise RuntimeError("the file is stored at the end of its block, not inside")
        return self._stored


@contextmanager
def new_file(database: CaseDatabase, case_id: str, suffix: str) -> Iterator[NewFile]:
    """Context manager for a new file: stored if the block ends without an error, otherwise removed."""
    file_id = new_id() + validate_suffix(suffix)
    folder = database.home.cases / case_id
    with database.in_use(case_id):
        with database.write_session() as session:
            case_row(session, case_id)
            row = FileRow(
                case_id=case_id, id=file_id, state=WRITING, size_bytes=0, sha256="", made_at=database.now
            )
            session.add(row)
        new = NewFile(folder / f"{UNFINISHED}{file_id}")
        try:
            with translate_errors(database.home.folder):
                make_folder(folder)
            with translate_errors(database.home.folder, known_only=True):
                yield new
            with translate_errors(database.home.folder):
                size_bytes, sha256 = commit_file(new.path, folder / file_id)
            new._stored = _record(database, case_id, file_id, size_bytes, sha256)  # noqa: SLF001  same module
        except BaseException:
            # This can fail on a full disk; the next start then removes it.
            with suppress(StoreError):
                discard(database, case_id, file_id)
            raise


def make_folder(folder: Path) -> None:
    """Create the folder of a case durably."""
    if not folder.is_dir():
        folder.mkdir(mode=PRIVATE, exist_ok=True)
        sync_path(folder.parent)


def commit_file(part: Path, whole: Path) -> tuple[int, str]:
    """Sync a written file and rename it to its final name; return its size and SHA-256."""
    with part.open("rb") as stream:
        sync_file(stream.fileno())
        size_bytes, sha256 = size_and_sha256(stream.fileno())
    part.chmod(READ_ONLY)
    part.replace(whole)
    sync_path(whole.parent)
    return size_bytes, sha256


def size_and_sha256(descriptor: int) -> tuple[int, str]:
    """Return size and SHA-256 of an open file, from its current position to the end."""
    digest, size_bytes = hashlib.sha256(), 0
    while chunk := os.read(descriptor, CHUNK_BYTES):
        digest.update(chunk)
        size_bytes += len(chunk)
    return size_bytes, digest.hexdigest()


def _record(database: CaseDatabase, case_id: str, file_id: str, size_bytes: int, sha256: str) -> StoredFile:
    with database.write_session() as session:
        row = session.get_one(FileRow, (case_id, file_id))
        row.state, row.size_bytes, row.sha256, row.made_at = COMPLETE, size_bytes, sha256, database.now
        case_row(session, case_id).changed_at = row.made_at
        return file_of(database, row)


def discard(database: CaseDatabase, case_id: str, file_id: str) -> None:
    """Remove an incomplete file and its row."""
    folder = database.home.cases / case_id
    with translate_errors(database.home.folder):
        for path in (folder / f"{UNFINISHED}{file_id}", folder / file_id):
            path.unlink(missing_ok=True)
        if folder.is_dir():
            sync_path(folder)
    with database.write_session() as session:
        row = session.get(FileRow, (case_id, file_id))
        if row is not None:
            session.delete(row)


def file_of(database: CaseDatabase, row: FileRow) -> StoredFile:
    """Return the record of a row."""
    return StoredFile(
        case_id=row.case_id,
        id=row.id,
        path=database.home.cases / row.case_id / row.id,
        size_bytes=row.size_bytes,
        sha256=row.sha256,
        made_at=row.made_at,
    )


def is_intact(row: FileRow) -> bool:
    """Return whether a row matches its checksum."""
    return row.checksum == file_checksum(row)


def find_file(database: CaseDatabase, session: Session, case_id: str, file_id: str) -> StoredFile:
    """Return a file.

    Raises:
        NotFound: CASE_UNKNOWN, FILE_UNKNOWN.
        StoreError: FILE_DAMAGED, it is missing on the disk, or its row does not match its checksum.
    """
    case_row(session, case_id)
    row = session.get(FileRow, (case_id, file_id))
    if row is not None and not is_intact(row):
        raise file_damaged(file_of(database, row), "its entry in the database was changed")
    if row is None or row.state != COMPLETE:
        raise file_unknown(case_id, file_id)
    file = file_of(database, row)
    if not file.path.exists():
        raise file_damaged(file, "it is missing")
    return file


def file_damaged(file: StoredFile, why: str) -> StoreError:
    """Return the error for a file that differs from what was stored."""
    return StoreError(
        "FILE_DAMAGED",
        f"the file {file.id} of the case {file.case_id} is damaged: {why}",
        "Restore the file from a copy; steps that need it are not possible until then.",
        {"case_id": file.case_id, "file_id": file.id, "damage": why},
    )


def all_files(database: CaseDatabase, session: Session, case_id: str) -> tuple[StoredFile, ...]:
    """Return all complete files of a case, oldest first.

    Raises:
        StoreError: FILE_DAMAGED, a row does not match its checksum.
    """
    intact, damaged = _file_rows(session, case_id)
    for row in damaged:
        raise file_damaged(file_of(database, row), "its entry in the database was changed")
    return _complete(database, intact)


def known_files(database: CaseDatabase, session: Session, case_id: str) -> tuple[StoredFile, ...]:
    """Return the complete files of a case whose entries are intact, oldest first."""
    return _complete(database, _file_rows(session, case_id)[0])


def _complete(database: CaseDatabase, rows: Iterable[FileRow]) -> tuple[StoredFile, ...]:
    files = [file_of(database, row) for row in rows if row.state == COMPLETE]
    return tuple(sorted(files, key=lambda file: (file.made_at, file.id)))


def _file_rows(session: Session, case_id: str) -> tuple[list[FileRow], list[FileRow]]:
    """Return the intact and the damaged rows of the files of a case."""
    rows = session.scalars(select(FileRow).where(FileRow.case_id == case_id))
    found = [row for row in rows if row is not None]
    return [row for row in found if is_intact(row)], [row for row in found if not is_intact(row)]


def find_damage(database: CaseDatabase, case_id: str) -> tuple[Damage, ...]:
    """Read every file and document of a case, and return those that are missing or damaged."""
    with database.in_use(case_id):
        with database.read_session() as session:
            case_row(session, case_id)
            intact, damaged = _file_rows(session, case_id)
            files = [file_of(database, row) for row in intact if row.state == COMPLETE]
            entries = [f"{row.id}" for row in damaged]
            lineage = lineage_of(session, case_id)
            headings = lineage.headings.values()
        known = {file.id for file in files}
        missing = {file for heading in headings for file in heading.files} - known
        problems = [
            ("content", reason("FILE_ENTRY_DAMAGED", {"file": file}), file)
            for file in sorted(missing.union(entries))
        ]
        problems += [(*problem, file.id) for file in files if (problem := _problem(file)) is not None]
        return (
            *(
                Damage(
                    file_id=file,
                    problem=problem,
                    why=why,
                    documents=tuple(heading.title_text for heading in headings if file in heading.files),
                )
                for problem, why, file in problems
            ),
            *(
                Damage(
                    file_id=heading.id,
                    problem="document",
                    why=reason("DOCUMENT_ENTRY_DAMAGED"),
                    documents=(heading.title_text,),
                )
                for heading in headings
                if heading.is_damaged
            ),
            *(
                Damage(
                    file_id=unknown,
                    problem="document",
                    why=reason("BASE_MISSING"),
                    documents=tuple(one.title_text for one in headings if unknown in one.depends_on),
                )
                for unknown in lineage.unknown_bases
            ),
        )


def reject_damaged(file: StoredFile) -> None:
    """Read a file, and raise StoreError FILE_DAMAGED if its content differs from what was stored."""
    problem = _problem(file)
    if problem is not None:
        raise file_damaged(file, "it is missing" if problem[0] == "missing" else "its SHA-256 differs")


def _problem(file: StoredFile) -> tuple[str, Reason] | None:
    try:
        with file.path.open("rb") as stream:
            size_bytes, sha256 = size_and_sha256(stream.fileno())
    except OSError as error:
        said = (error.strerror or str(error)).lower()
        return "missing", reason("FILE_NOT_READ", {"file": file.id, "system_error": said})
    if size_bytes != file.size_bytes:
        sizes = {"size_bytes": size_bytes, "stored_bytes": file.size_bytes}
        return "size", reason("FILE_SIZE_DIFFERS", {"file": file.id, **sizes})
    if sha256 != file.sha256:
        return "content", reason("FILE_CONTENT_DIFFERS", {"file": file.id})
    return None
