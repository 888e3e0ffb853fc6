"""Files of cases: written whole or not at all.

A row that says "coming" is stored before the first byte; the file is written under another name, forced to
the disk, given its name, the folder is forced to the disk, and only then the row says "whole". Whenever the
power goes, the next start finds the row and takes away what was not finished, and nothing else.
"""

import hashlib
import os
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from sqlalchemy import select
from sqlalchemy.orm import Session

from server.store.cases import case_row, new_id
from server.store.checks import checked_suffix
from server.store.documents import file_unknown
from server.store.errors import StoreError, told
from server.store.home import PRIVATE, sync_folder
from server.store.ledger import Ledger
from server.store.records import Damage, StoredFile
from server.store.standing import lineage_of
from server.store.tables import COMING, WHOLE, FileRow

UNFINISHED = "part-"
CHUNK_BYTES = 2**20
READ_ONLY = 0o400


class NewFile:
    """A file on its way into a case.

    Attributes:
        path: where to write it, by any means; another process may do it.
    """

    def __init__(self, path: Path) -> None:
        self.path = path
        self._stored: StoredFile | None = None

    @property
    def stored(self) -> StoredFile:
        """The whole file, once the block in which it was made has ended."""
        if self._stored is None:
            raise RuntimeError("the file is stored at the end of its block, not inside")
        return self._stored


@contextmanager
def new_file(ledger: Ledger, case_id: str, suffix: str) -> Iterator[NewFile]:
    """A file that is in the case when the block ends without an error, and nowhere otherwise."""
    file_id = new_id() + checked_suffix(suffix)
    folder = ledger.home.cases / case_id
    with ledger.holding(case_id):
        with ledger.writing() as session:
            case_row(session, case_id)
            row = FileRow(
                case_id=case_id, id=file_id, state=COMING, size_bytes=0, sha256="", made_at=ledger.now
            )
            session.add(row)
        new = NewFile(folder / f"{UNFINISHED}{file_id}")
        try:
            with told(ledger.home.folder):
                make_folder(folder)
            with told(ledger.home.folder, known_only=True):
                yield new
            with told(ledger.home.folder):
                size_bytes, sha256 = settle(new.path, folder / file_id)
            new._stored = _record(ledger, case_id, file_id, size_bytes, sha256)  # noqa: SLF001  same room
        except BaseException:
            # On a full disk not even this may work; then the next start does it.
            with suppress(StoreError):
                discard(ledger, case_id, file_id)
            raise


def make_folder(folder: Path) -> None:
    """Make a case's folder, so that it outlasts a power cut."""
    if not folder.is_dir():
        folder.mkdir(mode=PRIVATE, exist_ok=True)
        sync_folder(folder.parent)


def settle(part: Path, whole: Path) -> tuple[int, str]:
    """Give a file that is written its name, once all of it is on the disk; gives its size and SHA-256."""
    with part.open("rb") as stream:
        os.fsync(stream.fileno())
        size_bytes, sha256 = measured(stream.fileno())
    part.chmod(READ_ONLY)
    part.replace(whole)
    sync_folder(whole.parent)
    return size_bytes, sha256


def measured(descriptor: int) -> tuple[int, str]:
    """Size and SHA-256 of an open file, from where it stands to its end."""
    digest, size_bytes = hashlib.sha256(), 0
    while chunk := os.read(descriptor, CHUNK_BYTES):
        digest.update(chunk)
        size_bytes += len(chunk)
    return size_bytes, digest.hexdigest()


def _record(ledger: Ledger, case_id: str, file_id: str, size_bytes: int, sha256: str) -> StoredFile:
    with ledger.writing() as session:
        row = session.get_one(FileRow, (case_id, file_id))
        row.state, row.size_bytes, row.sha256, row.made_at = WHOLE, size_bytes, sha256, ledger.now
        case_row(session, case_id).changed_at = row.made_at
        return file_of(ledger, row)


def discard(ledger: Ledger, case_id: str, file_id: str) -> None:
    """Take away a file that was not finished, and its row."""
    folder = ledger.home.cases / case_id
    with told(ledger.home.folder):
        for path in (folder / f"{UNFINISHED}{file_id}", folder / file_id):
            path.unlink(missing_ok=True)
    with ledger.writing() as session:
        row = session.get(FileRow, (case_id, file_id))
        if row is not None:
            session.delete(row)


def file_of(ledger: Ledger, row: FileRow) -> StoredFile:
    """The record of a row."""
    return StoredFile(
        case_id=row.case_id,
        id=row.id,
        path=ledger.home.cases / row.case_id / row.id,
        size_bytes=row.size_bytes,
        sha256=row.sha256,
        made_at=row.made_at,
    )


def find_file(ledger: Ledger, session: Session, case_id: str, file_id: str) -> StoredFile:
    """One file.

    Raises:
        NotStored: CASE_UNKNOWN, FILE_UNKNOWN.
        StoreError: FILE_DAMAGED, it is missing on the disk.
    """
    case_row(session, case_id)
    row = session.get(FileRow, (case_id, file_id))
    if row is None or row.state != WHOLE:
        raise file_unknown(case_id, file_id)
    file = file_of(ledger, row)
    if not file.path.exists():
        raise file_damaged(file, "it is missing")
    return file


def file_damaged(file: StoredFile, why: str) -> StoreError:
    """The error for a file that is not as it was stored."""
    return StoreError(
        "FILE_DAMAGED",
        f"the file {file.id} of the case {file.case_id} is not as it was stored: {why}",
        "Put the file back from a copy; until then nothing that needs it can be done.",
        {"case_id": file.case_id, "file_id": file.id},
    )


def all_files(ledger: Ledger, session: Session, case_id: str) -> tuple[StoredFile, ...]:
    """All whole files of a case, the oldest first."""
    chosen = select(FileRow).where(FileRow.case_id == case_id, FileRow.state == WHOLE)
    return tuple(
        file_of(ledger, row) for row in session.scalars(chosen.order_by(FileRow.made_at, FileRow.id))
    )


def damages(ledger: Ledger, case_id: str) -> tuple[Damage, ...]:
    """Every file of a case read from end to end, and those told that are not as they were stored."""
    with ledger.holding(case_id):
        with ledger.reading() as session:
            case_row(session, case_id)
            files = all_files(ledger, session, case_id)
            headings = lineage_of(session, case_id).headings.values()
        found = ((file, _problem(file)) for file in files)
        return tuple(
            Damage(
                file_id=file.id,
                problem=problem[0],
                told=problem[1],
                documents=tuple(heading.title for heading in headings if file.id in heading.files),
            )
            for file, problem in found
            if problem is not None
        )


def _problem(file: StoredFile) -> tuple[str, str] | None:
    try:
        with file.path.open("rb") as stream:
            size_bytes, sha256 = measured(stream.fileno())
    except OSError as error:
        return "missing", f"the file {file.id} cannot be read: {(error.strerror or str(error)).lower()}"
    if size_bytes != file.size_bytes:
        return "size", f"the file {file.id} has {size_bytes} bytes, it was stored with {file.size_bytes}"
    if sha256 != file.sha256:
        return "content", f"the file {file.id} has other bytes than those that were stored (SHA-256 differs)"
    return None
