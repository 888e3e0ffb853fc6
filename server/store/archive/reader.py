"""Reading of an untrusted archive part by part, with verification of sizes and checksums."""

import errno
import hashlib
import json
import stat
import struct
import zipfile
import zlib
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import TypeVar

from pydantic import ValidationError

from server.store.archive.schema import (
    CASE,
    DOCUMENTS,
    FORMAT,
    MANIFEST,
    MAX_DOCUMENTS_BYTES,
    MAX_MANIFEST_BYTES,
    MAX_PARTS,
    MAX_UNPACKED_BYTES,
    PART,
    VERSION,
    ArchiveModel,
    ManifestSchema,
    PartSchema,
    archive_error,
)
from server.store.files import CHUNK_BYTES
from tracker.errors import InvalidInput

Shape = TypeVar("Shape", bound=ArchiveModel)
SYMLINK = stat.S_IFLNK


class Parts:
    """The parts of an archive whose manifest matches its table of contents."""

    def __init__(self, archive: zipfile.ZipFile) -> None:
        entries = _entries(archive)
        self._archive = archive
        self.manifest = _manifest(archive, entries)
        self._parts = {part.path: part for part in self.manifest.parts}
        _reject_disagreement(entries, self._parts)

    @property
    def total_bytes(self) -> int:
        """Uncompressed size of all parts."""
        return sum(part.size_bytes for part in self._parts.values())

    def part(self, path: str) -> PartSchema:
        """Return the manifest entry of a part."""
        if path not in self._parts:
            raise archive_error(f"its part {path} is missing", part=path)
        return self._parts[path]

    def pieces(self, path: str) -> Iterator[bytes]:
        """Yield the bytes of a part; raise at its end if they do not match the manifest."""
        part = self.part(path)
        digest, left = hashlib.sha256(), part.size_bytes
        with self._archive.open(path) as stream:
            while piece := stream.read(min(CHUNK_BYTES, left + 1)):
                left -= len(piece)
                if left < 0:
                    raise archive_error(
                        f"its part {path} is longer than its {part.size_bytes} bytes", part=path
                    )
                digest.update(piece)
                yield piece
        if left or digest.hexdigest() != part.sha256:
            raise archive_error(f"its part {path} is damaged (its SHA-256 differs)", part=path)

    def text(self, path: str) -> bytes:
        """Return a small part completely."""
        if self.part(path).size_bytes > MAX_DOCUMENTS_BYTES:
            raise archive_error(
                f"its part {path} is larger than {MAX_DOCUMENTS_BYTES // 2**20} MB", part=path
            )
        return b"".join(self.pieces(path))


@contextmanager
def open_archive(path: Path) -> Iterator[Parts]:
    """Open an archive and validate its structure.

    Raises:
        InvalidInput: ARCHIVE_INVALID, ARCHIVE_NEWER.
    """
    try:
        with zipfile.ZipFile(path) as archive:
            yield Parts(archive)
    except (
        zipfile.BadZipFile,
        zlib.error,
        struct.error,
        NotImplementedError,
        OverflowError,
        EOFError,
    ) as error:
        raise archive_error(
            f"it is not a valid zip file ({str(error)[:120] or type(error).__name__})"
        ) from error
    except OSError as error:
        # Its table of contents points outside of the file.
        if error.errno != errno.EINVAL:
            raise
        raise archive_error("it is not a valid zip file (a part is outside of it)") from error
    except ValueError as error:
        raise archive_error(f"it cannot be read ({str(error)[:120]})") from error


def parse_part(form: type[Shape], text: bytes, *, where: str) -> Shape:
    """Parse a JSON text by its schema."""
    try:
        return form.model_validate_json(text)
    except ValidationError as error:
        first = error.errors(include_input=False, include_url=False)[0]
        key = ".".join(str(step) for step in first["loc"])
        raise archive_error(
            f"{where}: {key or 'JSON'} is invalid ({first['msg']})", where=where, key=key
        ) from error


def _entries(archive: zipfile.ZipFile) -> dict[str, zipfile.ZipInfo]:
    infos = archive.infolist()
    if len(infos) > MAX_PARTS + 1:
        raise archive_error(f"it has {len(infos)} parts, the maximum is {MAX_PARTS}", parts=len(infos))
    for info in infos:
        known = info.filename == MANIFEST or PART.fullmatch(info.filename)
        if not known or info.flag_bits & 1 or stat.S_IFMT(info.external_attr >> 16) == SYMLINK:
            raise archive_error(f"its part '{info.filename[:80]}' does not belong to a case")
    entries = {info.filename: info for info in infos}
    if len(entries) != len(infos):
        raise archive_error("it has two parts of the same name")
    total = sum(info.file_size for info in infos)
    if total > MAX_UNPACKED_BYTES:
        raise archive_error(
            f"it unpacks to {total / 2**30:.1f} GB, the maximum is {MAX_UNPACKED_BYTES // 2**30} GB",
            unpacked_bytes=total,
        )
    return entries


def _manifest(archive: zipfile.ZipFile, entries: dict[str, zipfile.ZipInfo]) -> ManifestSchema:
    if MANIFEST not in entries:
        raise archive_error(f"its part {MANIFEST} is missing, so it is not a case", part=MANIFEST)
    with archive.open(MANIFEST) as stream:
        text = stream.read(MAX_MANIFEST_BYTES + 1)
    if len(text) > MAX_MANIFEST_BYTES:
        raise archive_error(f"its part {MANIFEST} is larger than {MAX_MANIFEST_BYTES // 2**20} MB")
    _reject_newer(text)
    return parse_part(ManifestSchema, text, where=MANIFEST)


def _reject_newer(text: bytes) -> None:
    """Report a newer format version as such, before its unknown keys are reported as damage."""
    try:
        reported = json.loads(text)
    except (ValueError, RecursionError) as error:
        raise archive_error(f"its part {MANIFEST} is not valid JSON") from error
    version = reported.get("version") if isinstance(reported, dict) else None
    if (
        isinstance(reported, dict)
        and reported.get("format") == FORMAT
        and type(version) is int
        and version > VERSION
    ):
        raise InvalidInput(
            "ARCHIVE_NEWER",
            f"the archive has format version {version}, but this Coaxial reads version {VERSION}",
            "Import it with the Coaxial that exported it, or a newer one; nothing of it was stored.",
            {"found": version, "known": VERSION},
        )


def _reject_disagreement(entries: dict[str, zipfile.ZipInfo], parts: dict[str, PartSchema]) -> None:
    for needed in (CASE, DOCUMENTS):
        if needed not in parts:
            raise archive_error(f"its part {needed} is missing", part=needed)
    extra = sorted(entries.keys() - parts.keys() - {MANIFEST})
    if extra:
        raise archive_error(f"its part {extra[0]} is not in its manifest", part=extra[0])
    for path, part in parts.items():
        if path not in entries:
            raise archive_error(f"its part {path[:80]} is missing", part=path[:80])
        if entries[path].file_size != part.size_bytes:
            raise archive_error(
                f"its part {path} has {entries[path].file_size} bytes, its manifest states {part.size_bytes}",
                part=path,
            )
