"""Room on the disk: asked for before much is written, and told in numbers where there is too little."""

import errno
import os
import shutil
from pathlib import Path

from tracker.errors import NavigationError

FULL = "STORE_FULL"
MAKE_ROOM = "Make room, then do it again; what was confirmed before is kept."
# What is left free by everything that takes much room.
SPARE_BYTES = 64 * 2**20


class DiskFull(NavigationError):
    """There is too little room left on the disk."""


def reject_without_room(folder: Path, needed_bytes: int) -> None:
    """To be asked before much is written, so that the disk is not filled for everybody first.

    Raises:
        DiskFull: STORE_FULL.
        OSError: the disk cannot be asked.
    """
    free_bytes = shutil.disk_usage(folder).free
    if needed_bytes + SPARE_BYTES > free_bytes:
        raise DiskFull(
            FULL,
            f"{needed_bytes / 2**20:.1f} MB are needed and {SPARE_BYTES / 2**20:g} MB are to stay free, "
            f"but only {free_bytes / 2**20:.1f} MB are free on the disk of the cases",
            MAKE_ROOM,
            {"needed_bytes": needed_bytes, "free_bytes": free_bytes},
        )


def take_room(path: Path) -> None:
    """Give a file all the room that its length says, at once.

    A file that is mapped is one hole at first, and writing into a hole on a full disk ends the process
    without a word.

    Raises:
        DiskFull: STORE_FULL.
        OSError: the file cannot be written.
    """
    size_bytes = path.stat().st_size
    # Not on macOS, where room was asked for and nothing more can be done.
    if not hasattr(os, "posix_fallocate"):
        return
    descriptor = os.open(path, os.O_RDWR)
    try:
        os.posix_fallocate(descriptor, 0, size_bytes)
    except OSError as error:
        if is_full(error):
            raise became_full(path.parent, size_bytes) from error
        raise
    finally:
        os.close(descriptor)


def is_full(error: OSError) -> bool:
    """Whether an error says that the disk, or what this user may have of it, is full."""
    return error.errno in (errno.ENOSPC, errno.EDQUOT)


def became_full(folder: Path, needed_bytes: int | None = None) -> DiskFull:
    """The error for a disk that became full in the middle of writing."""
    free_bytes = shutil.disk_usage(folder).free
    needed = "" if needed_bytes is None else f"{needed_bytes / 2**20:.1f} MB are needed, and "
    context: dict[str, object] = {"free_bytes": free_bytes}
    if needed_bytes is not None:
        context["needed_bytes"] = needed_bytes
    return DiskFull(
        FULL,
        f"{needed}the disk of the cases is full: {free_bytes / 2**20:.1f} MB are free",
        MAKE_ROOM,
        context,
    )
