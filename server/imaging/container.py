"""Containers of image files: a folder, a zip or a single file as a list of entries.

Nothing is unpacked to the disk, and member names are neither used as paths nor reported, because folders on
hospital discs are often named after the patient. Messages therefore state numbers of files but no names.
"""

import lzma
import os
import stat
import zipfile
import zlib
from collections import Counter
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from pathlib import Path, PurePosixPath
from typing import BinaryIO, cast

from server.imaging.ct import ExcludedFiles
from tracker.errors import InvalidInput

MAX_FILES = 50_000
MAX_BYTES = 8 * 2**30
# Exceptions from a damaged archive, or an unsupported compression.
BAD_ARCHIVE = (
    zipfile.BadZipFile,
    NotImplementedError,
    RuntimeError,
    EOFError,
    OSError,
    zlib.error,
    lzma.LZMAError,
)
GIVE = "Give a folder or zip of DICOM slices, a multi-frame DICOM file, or a NIfTI file."
HEAD_BYTES = 4096


@dataclass(frozen=True, slots=True, kw_only=True)
class Entry:
    """One file of a container.

    Attributes:
        size: size in bytes.
        open: opens the file for reading.
        name: its name without folders; only compared with known names, never reported.
    """

    size: int
    open: Callable[[], BinaryIO]
    name: str = ""

    def head(self) -> bytes:
        """Return its first bytes, for the detection of its format."""
        with self.open() as file:
            return file.read(HEAD_BYTES)


@dataclass(slots=True, kw_only=True)
class Container:
    """The files of an upload, with the reasons for those excluded so far."""

    entries: list[Entry]
    reasons: Counter[str] = field(default_factory=Counter)

    @property
    def left_out(self) -> tuple[ExcludedFiles, ...]:
        """Excluded files by reason, the most frequent first."""
        return tuple(
            ExcludedFiles(count=count, reason=reason) for reason, count in self.reasons.most_common()
        )

    @property
    def excluded_text(self) -> str:
        """Excluded files with their reasons, as a part of a message."""
        return "; ".join(f"{one.count} {one.reason}" for one in self.left_out)


@contextmanager
def open_container(path: Path) -> Iterator[Container]:
    """Context manager for the files in a folder or zip, or a single file.

    Raises:
        InvalidInput: CT_NOT_THERE, CT_UNREADABLE, CT_EMPTY, CT_TOO_MANY_FILES, or what `zip_entries` raises.
    """
    if not path.exists():
        raise InvalidInput("CT_NOT_THERE", "the file or folder does not exist", GIVE)
    if path.is_dir():
        yield _checked(_folder(path))
        return
    try:
        with path.open("rb") as file:
            is_zip = file.read(4) in {b"PK\x03\x04", b"PK\x05\x06"}
    except OSError as error:
        raise _unreadable(error) from None
    if not is_zip:
        yield _checked(Container(entries=[_file(path, path.stat().st_size)]))
        return
    try:
        archive = zipfile.ZipFile(path)
    except (zipfile.BadZipFile, OSError, ValueError, NotImplementedError):
        raise InvalidInput(
            "CT_ARCHIVE_BROKEN",
            f"the zip of {path.stat().st_size} bytes cannot be read: its directory is damaged or truncated",
            "Copy or upload the archive again.",
            {"bytes": path.stat().st_size},
        ) from None
    with archive:
        yield _checked(_zip(archive))


def _checked(container: Container) -> Container:
    if not container.entries:
        only = f", only {container.excluded_text}" if container.reasons else ""
        raise InvalidInput(
            "CT_EMPTY",
            f"there are no files to read{only}",
            GIVE,
            {"files": sum(container.reasons.values()), "excluded_hint": only},
        )
    return container


def _file(path: Path, size: int) -> Entry:
    return Entry(size=size, open=lambda: path.open("rb"), name=path.name)


def _folder(path: Path) -> Container:
    container = Container(entries=[])
    try:
        for folder, folders, names in os.walk(path):
            folders[:] = sorted(name for name in folders if not _is_hidden(name))
            for name in sorted(names):
                _keep_file(container, Path(folder) / name)
    except OSError as error:
        raise _unreadable(error) from None
    return container


def _keep_file(container: Container, path: Path) -> None:
    if _is_hidden(path.name) or path.name.upper() == "DICOMDIR":
        return
    try:
        status = path.stat()
    except OSError:
        container.reasons["files that cannot be opened"] += 1
        return
    if not stat.S_ISREG(status.st_mode):
        container.reasons["not regular files"] += 1
    elif status.st_size == 0:
        container.reasons["empty files"] += 1
    else:
        container.entries.append(_file(path, status.st_size))
        _check_count(len(container.entries))


def _is_hidden(name: str) -> bool:
    return name.startswith(".") or name == "__MACOSX"


def _check_count(count: int) -> None:
    if count > MAX_FILES:
        raise InvalidInput(
            "CT_TOO_MANY_FILES",
            f"there are {count} files or more, the maximum is {MAX_FILES}",
            "Give a folder that contains only this series.",
            {"files": count, "max_files": MAX_FILES},
        )


def _zip(archive: zipfile.ZipFile) -> Container:
    """Return the members of an archive, which are read one by one.

    Raises:
        InvalidInput: CT_ARCHIVE_UNSAFE, CT_ARCHIVE_ENCRYPTED, CT_ARCHIVE_TOO_LARGE.
    """
    members = [member for member in archive.infolist() if not member.is_dir()]
    _check_count(len(members))
    _check_archive(members)
    container = Container(entries=[])
    for member in sorted(members, key=lambda one: one.filename):
        parts = PurePosixPath(member.filename).parts
        if any(_is_hidden(part) for part in parts) or parts[-1].upper() == "DICOMDIR":
            continue
        if member.file_size == 0:
            container.reasons["empty files"] += 1
        elif parts[-1].lower().endswith((".zip", ".7z", ".rar", ".tar", ".tgz", ".iso")):
            container.reasons["archives inside the archive"] += 1
        else:
            container.entries.append(_member(archive, member))
    return container


def _member(archive: zipfile.ZipFile, member: zipfile.ZipInfo) -> Entry:
    return Entry(
        size=member.file_size,
        open=lambda: cast("BinaryIO", archive.open(member)),
        name=PurePosixPath(member.filename).name,
    )


def _check_archive(members: list[zipfile.ZipInfo]) -> None:
    unsafe = sum(_leaves(member.filename) for member in members)
    if unsafe:
        raise InvalidInput(
            "CT_ARCHIVE_UNSAFE",
            f"{unsafe} of {len(members)} files in the zip have names that point outside of it",
            "Create the archive again from the folder of slices; do not use one from an unknown source.",
            {"files": unsafe, "of": len(members)},
        )
    encrypted = sum(bool(member.flag_bits & 1) for member in members)
    if encrypted:
        raise InvalidInput(
            "CT_ARCHIVE_ENCRYPTED",
            f"{encrypted} of {len(members)} files in the zip are encrypted",
            "Unpack it with its password, and give the folder or a zip without one.",
            {"files": encrypted, "of": len(members)},
        )
    size = sum(member.file_size for member in members)
    if size > MAX_BYTES:
        raise InvalidInput(
            "CT_ARCHIVE_TOO_LARGE",
            f"the zip would unpack to {size / 2**30:.1f} GiB, the maximum is {MAX_BYTES / 2**30:.0f} GiB",
            "Give a zip that contains only this series.",
            {"bytes": size, "max_bytes": MAX_BYTES, "size_gib": size / 2**30, "max_gib": MAX_BYTES / 2**30},
        )


def _leaves(name: str) -> bool:
    """Return whether a member's path leads outside of the archive."""
    parts = PurePosixPath(name.replace("\\", "/")).parts
    return ".." in parts or name.startswith(("/", "\\")) or (len(name) > 1 and name[1] == ":")


def _unreadable(error: OSError) -> InvalidInput:
    return InvalidInput(
        "CT_UNREADABLE",
        f"the file or folder cannot be read: {error.strerror}",
        "Check its read permission.",
        {"system_error": error.strerror},
    )
