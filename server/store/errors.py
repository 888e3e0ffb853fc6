"""Errors of the store.

NavigationError
├── StoreError       the folder or the database cannot be used            HTTP 503, 507
├── NotFound         there is no such case, document or file              HTTP 404
├── StoreConflict    the state of the store does not allow the action     HTTP 409
├── OutOfDateError   a dependency of a step has changed or is missing     HTTP 409
└── InvalidInput     a name, content or archive is invalid                HTTP 422
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
    FULL: "the disk of {folder} is full: {free_mb:.1f} MB are free",
    READ_ONLY: "the folder {folder} is not writable",
    BUSY: "another program has locked the database in {folder}",
    DAMAGED: "the database in {folder} is damaged",
    FAILED: "the folder {folder} cannot be used ({why})",
}
REMEDY = {
    FULL: FREE_SPACE_REMEDY,
    READ_ONLY: "Give this user write permission, or set COAXIAL_HOME to another folder.",
    BUSY: "Close the program that has the database open, then try again.",
    DAMAGED: "Stop the server and copy the folder; its subfolder 'backups' contains the database before the "
    "last change of version.",
    FAILED: "Check that the disk is connected and healthy, then try again; acknowledged data are stored.",
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
    """The state of the store does not allow the action: a concurrent change, or something is in use."""


class OutOfDateError(NavigationError):
    """A dependency of a step is missing, was withdrawn, or was replaced."""


@contextmanager
def translate_errors(folder: Path, *, known_only: bool = False) -> Iterator[None]:
    """Context manager that translates errors of disk and database into a StoreError with a remedy.

    With `known_only`, an OSError that is not known to come from the disk is passed on; used around code of
    other packages.

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
    # The low byte is the primary result code of SQLite, the rest its detail.
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
