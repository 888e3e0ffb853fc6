"""The folder in which everything is kept, used by one server at a time."""

import errno
import fcntl
import os
import secrets
import shutil
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path
from types import TracebackType

import filelock
import platformdirs

from server.disk import reject_without_room
from server.store.errors import StoreError, told

FOLDER_VARIABLE = "COAXIAL_HOME"
# Patients' pictures are for the one who runs the server.
PRIVATE = 0o700
RESERVE_BYTES = 2**20
# What disks say that know no locks, as some network disks and those of some containers.
WITHOUT_LOCKS = frozenset({errno.ENOLCK, errno.ENOSYS, errno.ENOTSUP, errno.EOPNOTSUPP})
# On macOS a plain sync leaves things in the disk's own memory.
FULL_SYNC: int | None = getattr(fcntl, "F_FULLFSYNC", None)


def home_folder(environment: Mapping[str, str] = os.environ) -> Path:
    """Where cases are kept: `COAXIAL_HOME`, else where this system keeps what a user's programs make."""
    named = environment.get(FOLDER_VARIABLE, "").strip()
    return Path(named).expanduser().absolute() if named else platformdirs.user_data_path("coaxial")


class Home:
    """A folder that belongs to this process until it is closed, or the process ends in whatever way.

    Attributes:
        folder: the whole of it.
        database: the file with cases and documents.
        backups: copies of the database, made before its form was changed.
        cases: a folder for each case, with its files.
        temporary: work that is not done; emptied at each start.
        reserve: room on the disk that is given up when a case is to be deleted because the disk is full.

    Raises:
        StoreError: HOME_IN_USE, HOME_NOT_LOCKABLE, STORE_READ_ONLY, STORE_FULL or STORE_FAILED.
    """

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.database = folder / "coaxial.sqlite3"
        self.backups = folder / "backups"
        self.cases = folder / "cases"
        self.temporary = folder / "temporary"
        self.reserve = folder / "reserve"
        self._lock = filelock.FileLock(folder / "coaxial.lock", thread_local=False)
        with told(folder):
            folder.mkdir(mode=PRIVATE, parents=True, exist_ok=True)
            try:
                self._lock.acquire(timeout=0)
            except filelock.Timeout:
                raise _in_use(folder) from None
            except (OSError, NotImplementedError) as error:
                if isinstance(error, OSError) and error.errno not in WITHOUT_LOCKS:
                    raise
                raise _without_locks(folder) from error
            try:
                shutil.rmtree(self.temporary, ignore_errors=True)
                for room in (self.backups, self.cases, self.temporary):
                    room.mkdir(mode=PRIVATE, exist_ok=True)
                self.keep_reserve()
                sync_folder(folder)
            except OSError:
                self._lock.release()
                raise

    def new_temporary(self, suffix: str = "") -> Path:
        """A name for work that is not done; what is written there is gone at the next start."""
        return self.temporary / f"{secrets.token_hex(8)}{suffix}"

    def keep_reserve(self) -> None:
        """Hold some room on the disk, as far as there is any."""
        with suppress(OSError):
            if not self.reserve.exists() or self.reserve.stat().st_size < RESERVE_BYTES:
                # Noise, because some disks need no room for zeros.
                self.reserve.write_bytes(secrets.token_bytes(RESERVE_BYTES))

    def spend_reserve(self) -> None:
        """Give the room up."""
        self.reserve.unlink(missing_ok=True)

    def reject_without_room(self, needed_bytes: int) -> None:
        """To be asked before much is written, so that the disk is not filled for everybody first.

        Raises:
            DiskFull: STORE_FULL.
        """
        with told(self.folder):
            reject_without_room(self.folder, needed_bytes)

    def close(self) -> None:
        """Let another server have the folder."""
        self._lock.release()

    def __enter__(self) -> "Home":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


def sync_folder(folder: Path) -> None:
    """Have names that were made, changed or taken away in a folder outlast a power cut."""
    descriptor = os.open(folder, os.O_RDONLY)
    try:
        sync_file(descriptor)
    finally:
        os.close(descriptor)


def sync_file(descriptor: int) -> None:
    """Have what was written into a file outlast a power cut."""
    os.fsync(descriptor)
    if FULL_SYNC is not None:
        with suppress(OSError):
            fcntl.fcntl(descriptor, FULL_SYNC)


def _without_locks(folder: Path) -> StoreError:
    return StoreError(
        "HOME_NOT_LOCKABLE",
        f"the disk of the folder {folder} gives no locks (some network disks do not), so that another "
        "Coaxial could write into it at the same time",
        "Name a folder on a disk of this computer with COAXIAL_HOME.",
        {"folder": str(folder)},
    )


def _in_use(folder: Path) -> StoreError:
    return StoreError(
        "HOME_IN_USE",
        f"another Coaxial is running with the folder {folder}, and a folder serves one at a time",
        "Stop the other one, or name another folder with COAXIAL_HOME.",
        {"folder": str(folder)},
    )
