"""Writing of large files: check of the disk space, and renaming when they are complete."""

import errno
import fcntl
import os
import shutil
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from pathlib import Path

from tracker.errors import NavigationError

FULL = "STORE_FULL"
FREE_SPACE_REMEDY = "Free disk space and try again; everything confirmed before is stored."
# Large writes leave this much free.
RESERVED_BYTES = 64 * 2**20
# On macOS fsync leaves data in the drive's cache.
FULL_SYNC: int | None = getattr(fcntl, "F_FULLFSYNC", None)


class DiskFull(NavigationError):
    """Not enough free disk space."""


def reject_without_space(folder: Path, needed_bytes: int) -> None:
    """Reject a large write that would fill the disk.

    Raises:
        DiskFull: STORE_FULL.
        OSError: the free space is unknown.
    """
    free_bytes = shutil.disk_usage(folder).free
    if needed_bytes + RESERVED_BYTES > free_bytes:
        raise DiskFull(
            FULL,
            f"{needed_bytes / 2**20:.1f} MB are needed and {RESERVED_BYTES / 2**20:g} MB must stay free, "
            f"but only {free_bytes / 2**20:.1f} MB are free on the disk of the cases",
            FREE_SPACE_REMEDY,
            {"needed_bytes": needed_bytes, "free_bytes": free_bytes},
        )


def sync_path(path: Path) -> None:
    """Make a file durable, or the created, renamed and removed entries of a folder (fsync)."""
    descriptor = os.open(path, os.O_RDONLY)
    try:
        sync_file(descriptor)
    finally:
        os.close(descriptor)


def sync_file(descriptor: int) -> None:
    """Make written data durable (fsync)."""
    os.fsync(descriptor)
    if FULL_SYNC is not None:
        with suppress(OSError):
            fcntl.fcntl(descriptor, FULL_SYNC)


def reserve_space(path: Path) -> None:
    """Allocate the disk space of a file (posix_fallocate).

    A memory-mapped file is sparse at first; writing to it on a full disk kills the process with SIGBUS.

    Raises:
        DiskFull: STORE_FULL.
        OSError: the file cannot be written.
    """
    size_bytes = path.stat().st_size
    # Not available on macOS.
    if not hasattr(os, "posix_fallocate"):
        return
    descriptor = os.open(path, os.O_RDWR)
    try:
        os.posix_fallocate(descriptor, 0, size_bytes)
    except OSError as error:
        if is_full(error):
            raise disk_full_error(path.parent, size_bytes) from error
        raise
    finally:
        os.close(descriptor)


@contextmanager
def named_when_complete(target: Path) -> Iterator[Path]:
    """Yield a temporary path for a file; it is renamed after the block, or removed if the block raises.

    Raises:
        OSError: The file cannot be renamed.
    """
    unfinished = target.with_name(f"{target.name}.part")
    try:
        yield unfinished
        unfinished.replace(target)
    finally:
        with suppress(OSError):
            unfinished.unlink()


def is_full(error: OSError) -> bool:
    """Return whether an error means that the disk or the quota of the user is full."""
    return error.errno in (errno.ENOSPC, errno.EDQUOT)


def disk_full_error(folder: Path, needed_bytes: int | None = None) -> DiskFull:
    """Return the error for a disk that became full during a write."""
    free_bytes = shutil.disk_usage(folder).free
    needed = "" if needed_bytes is None else f"{needed_bytes / 2**20:.1f} MB are needed, and "
    context: dict[str, object] = {"free_bytes": free_bytes}
    if needed_bytes is not None:
        context["needed_bytes"] = needed_bytes
    return DiskFull(
        FULL,
        f"{needed}the disk of the cases is full: {free_bytes / 2**20:.1f} MB are free",
        FREE_SPACE_REMEDY,
        context,
    )
