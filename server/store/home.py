"""The data folder, used by one server at a time."""

import errno
import secrets
import shutil
from contextlib import suppress
from pathlib import Path
from types import TracebackType

import filelock

from server.disk import reject_without_space, sync_path
from server.store.errors import StoreError, translate_errors

# Patient data are accessible only to the user who runs the server.
PRIVATE = 0o700
# Subfolder of a case for recordings; see `server.recording`.
RECORDINGS = "recordings"
RESERVE_BYTES = 2**20
# Errors of file systems without locks, such as some network disks and container volumes.
WITHOUT_LOCKS = frozenset({errno.ENOLCK, errno.ENOSYS, errno.ENOTSUP, errno.EOPNOTSUPP})


class Home:
    """The data folder, locked by this process until it is closed or the process ends.

    Attributes:
        folder: the data folder.
        database: file of the database with cases and documents.
        backups: copies of the database, made before each migration.
        cases: one folder per case, with its files.
        temporary: temporary files; emptied at each start.
        reserve: file that reserves disk space, released to delete a case on a full disk.

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
        with translate_errors(folder):
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
                self.allocate_reserve()
                sync_path(folder)
            except OSError:
                self._lock.release()
                raise

    def new_temporary(self, suffix: str = "") -> Path:
        """Return a new path for temporary data, which is deleted at the next start."""
        return self.temporary / f"{secrets.token_hex(8)}{suffix}"

    def allocate_reserve(self) -> None:
        """Reserve disk space, if there is any."""
        with suppress(OSError):
            if not self.reserve.exists() or self.reserve.stat().st_size < RESERVE_BYTES:
                # Random bytes, because some file systems store no blocks for zeros.
                self.reserve.write_bytes(secrets.token_bytes(RESERVE_BYTES))

    def release_reserve(self) -> None:
        """Release the reserved disk space."""
        self.reserve.unlink(missing_ok=True)

    def reject_without_space(self, needed_bytes: int) -> None:
        """Raise before a large write that would fill the disk.

        Raises:
            DiskFull: STORE_FULL.
        """
        with translate_errors(self.folder):
            reject_without_space(self.folder, needed_bytes)

    def free_bytes(self) -> int:
        """Return the free space on the disk."""
        with translate_errors(self.folder):
            return shutil.disk_usage(self.folder).free

    def close(self) -> None:
        """Unlock the folder."""
        self._lock.release()

    def __enter__(self) -> "Home":
        return self

    def __exit__(
        self, kind: type[BaseException] | None, error: BaseException | None, trace: TracebackType | None
    ) -> None:
        self.close()


def _without_locks(folder: Path) -> StoreError:
    return StoreError(
        "HOME_NOT_LOCKABLE",
        f"the disk of the folder {folder} does not support file locks (as some network disks), so that "
        "another Coaxial could write into it at the same time",
        "Set COAXIAL_HOME to a folder on a disk of this computer.",
        {"folder": str(folder)},
    )


def _in_use(folder: Path) -> StoreError:
    return StoreError(
        "HOME_IN_USE",
        f"another Coaxial is running with the folder {folder}, which only one may use at a time",
        "Stop the other one, or set COAXIAL_HOME to another folder.",
        {"folder": str(folder)},
    )
