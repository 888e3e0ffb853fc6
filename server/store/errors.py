"""Errors of the store.

NavigationError
├── StoreError        the folder or the database cannot be used            HTTP 503, 507
├── NotFound         there is no such case, document or file              HTTP 404
├── StoreConflict     it cannot be done as things stand                    HTTP 409
├── OutOfDateError    what is needed was changed under it, or is missing   HTTP 409
└── InvalidInput      a name, a content or an archive cannot be used       HTTP 422
"""

import errno
import math
import shutil
import sqlite3
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from sqlalchemy.exc import DBAPIError

from server.disk import FREE_SPACE_REMEDY, FULL
from tracker.errors import NavigationError

READ_ONLY, BUSY, DAMAGED, FAILED = (
    "STORE_READ_ONLY",
    "STORE_BUSY",
    "STORE_DAMAGED",
    "STORE_FAILED",
)
WHAT = {
    FULL: "there is no room left on the disk under {folder}: {free_mb:.1f} MB are free",
    READ_ONLY: "the folder {folder} cannot be written",
    BUSY: "another program keeps the database in {folder} locked",
    DAMAGED: "the database in {folder} is damaged",
    FAILED: "the folder {folder} cannot be used ({why})",
}
REMEDY = {
    FULL: FREE_SPACE_REMEDY,
    READ_ONLY: "Give this user the right to write there, or name another folder with COAXIAL_HOME.",
    BUSY: "Close the program that has the database open, then do it again.",
    DAMAGED: "Stop the server and keep a copy of the folder; its folder 'backups' holds the database "
    "as it was before the last change of version.",
    FAILED: "Check that the disk is connected and healthy, then try again; acknowledged data is stored.",
}
BY_SQLITE = {
    sqlite3.SQLITE_FULL: FULL,
    sqlite3.SQLITE_READONLY: READ_ONLY,
    sqlite3.SQLITE_PERM: READ_ONLY,
    sqlite3.SQLITE_BUSY: BUSY,
    sqlite3.SQLITE_LOCKED: BUSY,
    sqlite3.SQLITE_CORRUPT: DAMAGED,
    sqlite3.SQLITE_NOTADB: DAMAGED,
}
BY_SYSTEM = {
    errno.ENOSPC: FULL,
    errno.EDQUOT: FULL,
    errno.EROFS: READ_ONLY,
    errno.EACCES: READ_ONLY,
    errno.EPERM: READ_ONLY,
}


class StoreError(NavigationError):
    """The folder or the database of the cases cannot be used."""


class NotFound(NavigationError):
    """There is no such case, document or file."""


class StoreConflict(NavigationError):
    """The state of the store does not allow it: a concurrent change, or something is in use."""


class OutOfDateError(NavigationError):
    """A dependency of a step is missing, was withdrawn, or was replaced."""


@contextmanager
def translate_errors(folder: Path, *, known_only: bool = False) -> Iterator[None]:
    """Context manager that translates errors of disk and database into a StoreError with a remedy.

    `known_only` passes on an OSError that is not known to be about the disk, for blocks with foreign code.

    Raises:
        StoreError: STORE_FULL, STORE_READ_ONLY, STORE_BUSY, STORE_DAMAGED or STORE_FAILED.
    """
    try:
        yield
    except DBAPIError as error:
        raise _store_error(folder, _code_of(error.orig), error.orig) from error
    except (sqlite3.Error, OSError) as error:
        if known_only and _code_of(error) == FAILED:
            raise
        raise _store_error(folder, _code_of(error), error) from error


def damaged_database(folder: Path, found: str) -> StoreError:
    """Return the error for a database that fails its integrity check."""
    return StoreError(
        DAMAGED, f"{WHAT[DAMAGED].format(folder=folder)}: {found[:200]}", REMEDY[DAMAGED], {"found": found}
    )


def _code_of(error: BaseException | None) -> str:
    if isinstance(error, OSError):
        return BY_SYSTEM.get(error.errno or 0, FAILED)
    # The low byte is the kind, the rest its detail.
    return BY_SQLITE.get(getattr(error, "sqlite_errorcode", 0) & 0xFF, FAILED)


def _store_error(folder: Path, code: str, error: BaseException | None) -> StoreError:
    why = getattr(error, "strerror", None) or str(error)
    context: dict[str, object] = {"folder": str(folder), "why": why}
    free_mb = math.nan
    if code == FULL:
        with suppress(OSError):
            free_mb = shutil.disk_usage(folder).free / 1e6
            context["free_mb"] = free_mb
    return StoreError(code, WHAT[code].format(folder=folder, why=why, free_mb=free_mb), REMEDY[code], context)
