"""Writer of recordings.

Messages are collected in chunks of at most `CHUNK_S`, each with its CRC. A thread syncs the disk at the same
interval, so that a killed process loses less than a second, and a power failure little more. The writer stops
before disk or budget are used up, so that the file can still be closed properly.
"""

import errno
import json
import os
import shutil
import threading
from collections.abc import Callable, Mapping
from contextlib import suppress
from dataclasses import dataclass
from io import RawIOBase
from pathlib import Path
from typing import IO, Any, cast

import zstandard
from mcap.writer import CompressionType, IndexType, Writer

from server.disk import is_full
from server.errors import RecordingError
from server.recording_file.codec import Json
from server.recording_file.packing import PackedImage
from server.recording_file.topics import JSON, PROFILE, SCHEMA_ENCODING, ZSTD_JSON, Topic

LEVEL = 1
CHUNK_S = 0.4
CHUNK_BYTES = 8 * 2**20
NANOSECONDS = 1e9


@dataclass(frozen=True, slots=True, kw_only=True)
class WriterLimits:
    """Limits at which a recording is stopped.

    Attributes:
        max_bytes: Size of this file.
        min_free_bytes: Free space on its disk.
    """

    max_bytes: float
    min_free_bytes: float


def mcap_writer(file: IO[bytes], *, chunk_bytes: int) -> Writer:
    """Return a writer of uncompressed chunks, because the index reads messages at their position."""
    return Writer(file, chunk_size=chunk_bytes, compression=CompressionType.NONE, index_types=IndexType.CHUNK)


def register_json_schema(writer: Writer, schema: Mapping[str, Any], *, title: str) -> int:
    """Register the JSON schema of a topic's messages, and return its id; `title` if it has none."""
    content = json.dumps(schema, ensure_ascii=False).encode()
    schema_id: int = writer.register_schema(
        name=str(schema.get("title", title)), encoding=SCHEMA_ENCODING, data=content
    )
    return schema_id


def compressed_json(content: Json) -> bytes:
    """Return an encoded value as compressed JSON."""
    return zstandard.ZstdCompressor(level=LEVEL).compress(json.dumps(content).encode())


class RecordingWriter:
    """One recording. Not thread-safe.

    Args:
        path: A new file.
        limits: Limits at which it is stopped.
        unix_offset_s: Unix time minus monotonic time; the file contains Unix times.
        free_bytes: Returns the free space on the disk of a folder.
        open_file: Opens the file, unbuffered.

    Raises:
        RecordingError: RECORDING_NOT_WRITTEN.
    """

    def __init__(
        self,
        path: Path,
        *,
        limits: WriterLimits,
        unix_offset_s: float,
        library: str,
        free_bytes: Callable[[Path], int] = lambda folder: shutil.disk_usage(folder).free,
        open_file: Callable[[Path], RawIOBase] = lambda path: path.open("xb", buffering=0),
    ) -> None:
        self._path = path
        self._limits = limits
        self._offset_s = unix_offset_s
        self._free_bytes = free_bytes
        self._channels: dict[tuple[str, ...], int] = {}
        self._chunk_began_s: float | None = None
        self._pending = 0
        try:
            self._file = _CountingFile(open_file(path))
        except OSError as error:
            raise _not_written(path, error) from error
        self._sync = _SyncThread(self._file.fileno())
        self._writer = mcap_writer(cast(IO[bytes], self._file), chunk_bytes=2 * CHUNK_BYTES)
        self._guarded(lambda: self._writer.start(profile=PROFILE, library=library))

    @property
    def written_bytes(self) -> int:
        """Size of the file, including data that are not flushed yet."""
        return self._file.written + self._pending

    def register(
        self, topic: Topic, schema: Mapping[str, Any] | None = None, *, encoding: str = JSON
    ) -> None:
        """Register a topic before its first message, with the JSON schema of its messages."""
        key = (topic.value, encoding)
        if key in self._channels:
            return
        schema_id = 0 if schema is None else register_json_schema(self._writer, schema, title=topic.value)
        self._channels[key] = self._writer.register_channel(
            topic=topic.value, message_encoding=encoding, schema_id=schema_id
        )

    def add_json(self, topic: Topic, at_s: float, text: str | bytes, *, sequence: int = 0) -> None:
        """Add a JSON message of a registered topic."""
        data = text.encode() if isinstance(text, str) else text
        self._add(self._channels[(topic.value, JSON)], at_s, data, sequence)

    def add_compressed(self, topic: Topic, at_s: float, data: bytes, *, sequence: int = 0) -> None:
        """Add the result of `compressed_json`."""
        self.register(topic, encoding=ZSTD_JSON)
        self._add(self._channels[(topic.value, ZSTD_JSON)], at_s, data, sequence)

    def add_image(self, image: PackedImage, *, number: int, at_s: float) -> None:
        """Add an image; each packing and size has a channel."""
        width, height = image.size_wh_px
        key = (Topic.IMAGE.value, image.packing.value, str(width), str(height))
        if key not in self._channels:
            self._channels[key] = self._writer.register_channel(
                topic=Topic.IMAGE.value,
                message_encoding=image.packing.value,
                schema_id=0,
                metadata={"width_px": str(width), "height_px": str(height)},
            )
        self._add(self._channels[key], at_s, image.content, number)

    def tick(self, now_s: float) -> None:
        """Write the chunk if it is due, and check the limits.

        Raises:
            RecordingError: RECORDING_NOT_WRITTEN, RECORDING_DISK_FULL or RECORDING_BUDGET_EXCEEDED.
        """
        if self._chunk_began_s is None:
            self._chunk_began_s = now_s
        if now_s - self._chunk_began_s < CHUNK_S and self._pending < CHUNK_BYTES:
            return
        self._chunk_began_s, self._pending = now_s, 0
        self._guarded(self._writer.flush)
        self._sync.request()
        self._reject_above_limits()

    def close(self) -> None:
        """Write the remaining messages and the index, and close the file.

        Raises:
            RecordingError: RECORDING_NOT_WRITTEN; the part written before is readable.
        """
        self._pending = 0
        try:
            self._guarded(self._writer.finish)
        finally:
            self._sync.stop()
            self._file.close()

    def _add(self, channel_id: int, at_s: float, data: bytes, sequence: int) -> None:
        at_ns = max(0, round((at_s + self._offset_s) * NANOSECONDS))
        self._pending += len(data)
        self._guarded(
            lambda: self._writer.add_message(
                channel_id, log_time=at_ns, data=data, publish_time=at_ns, sequence=sequence % 2**32
            )
        )

    def _guarded(self, write: Callable[[], None]) -> None:
        try:
            write()
        except OSError as error:
            raise _not_written(self._path, error) from error

    def _reject_above_limits(self) -> None:
        if self._sync.error is not None:
            raise _not_written(self._path, self._sync.error)
        if self._file.written > self._limits.max_bytes:
            raise RecordingError(
                "RECORDING_BUDGET_EXCEEDED",
                f"all recordings together would exceed recording.max_total_gb with this one, which has "
                f"{self._file.written / 1e9:.2f} GB",
                "Delete recordings that are not needed, or raise recording.max_total_gb; then start again.",
                {"written_bytes": self._file.written, "written_gb": self._file.written / 1e9},
            )
        free_bytes = self._free_bytes(self._path.parent)
        if free_bytes < self._limits.min_free_bytes:
            raise RecordingError(
                "RECORDING_DISK_FULL",
                f"{free_bytes / 1e9:.2f} GB are free on the disk of the cases, and "
                f"{self._limits.min_free_bytes / 1e9:.2f} GB must stay free (recording.min_free_gb)",
                "Free disk space, then start the recording again. Navigation continues.",
                {
                    "free_bytes": free_bytes,
                    "free_gb": free_bytes / 1e9,
                    "min_free_gb": self._limits.min_free_bytes / 1e9,
                },
            )


class _CountingFile:
    """A file that writes all data or raises, and counts them.

    The buffered classes of `io` are not used, because after an error they write again when they are deleted.
    """

    def __init__(self, file: RawIOBase) -> None:
        self._file = file
        self.written = 0

    def write(self, content: bytes | bytearray | memoryview, /) -> int:
        left = memoryview(content).cast("B")
        count = len(left)
        while left:
            done = self._file.write(left)
            if not done:
                raise OSError(errno.EIO, os.strerror(errno.EIO))
            self.written += done
            left = left[done:]
        return count

    def tell(self) -> int:
        return self.written

    def flush(self) -> None:
        """Do nothing, because nothing is buffered."""

    def fileno(self) -> int:
        return self._file.fileno()

    def close(self) -> None:
        self._file.close()


class _SyncThread:
    """Syncs a file on request in a separate thread, because a slow disk must not delay the next image."""

    def __init__(self, descriptor: int) -> None:
        self._descriptor = descriptor
        self._due = threading.Event()
        self._stopped = False
        self.error: OSError | None = None
        self._thread = threading.Thread(target=self._run, name="recording sync", daemon=True)
        self._thread.start()

    def request(self) -> None:
        self._due.set()

    def stop(self) -> None:
        """Sync once more and stop."""
        self._stopped = True
        self._due.set()
        self._thread.join()

    def _run(self) -> None:
        while not self._stopped:
            self._due.wait()
            self._due.clear()
            try:
                os.fsync(self._descriptor)
            except OSError as error:
                # Pipes, for example, cannot be synced.
                if error.errno != errno.EINVAL:
                    self.error = error


def _not_written(path: Path, error: OSError) -> RecordingError:
    what = "the disk is full" if is_full(error) else (error.strerror or str(error)).lower()
    context: dict[str, object] = {"name": path.name, "write_problem": what, "system_error": what}
    with suppress(OSError):
        context["free_bytes"] = shutil.disk_usage(path.parent).free
    return RecordingError(
        "RECORDING_NOT_WRITTEN",
        f"the recording {path.name} cannot be written: {what}",
        "Check the disk of the cases, then start the recording again. Navigation continues, and the part "
        "written so far is readable.",
        context,
    )
