"""Positions of the messages of a recording in its file, found without reading images.

The chunks of a recording are not compressed, so that a message can be read at its position. Such reads do not
verify the CRC; `RecordingReader` does.
"""

import struct
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path
from typing import IO

from mcap.opcode import Opcode

from server.recording_file.packing import Packing
from server.recording_file.reader import NANOSECONDS, TOPICS, RecordingReader, known_packing
from server.recording_file.topics import Topic

MAGIC = b"\x89MCAP0\r\n"
RECORD = struct.Struct("<BQ")
MESSAGE = struct.Struct("<HIQQ")
CHUNK = struct.Struct("<QQQI")
FOOTER_BYTES = RECORD.size + 20 + len(MAGIC)
# Counts of messages, schemas, channels, attachments, metadata and chunks; first and last time.
STATISTICS = struct.Struct("<QHIIIIQQ")


@dataclass(frozen=True, slots=True, kw_only=True)
class Location:
    """Position of a message in its file.

    Attributes:
        topic: Its topic.
        unix_s: Its Unix time.
        sequence: Number of the image if it refers to one.
        offset, length: Position of its content, in bytes.
        packing, size_wh_px: Encoding and size of an image; None for other messages.
    """

    topic: Topic
    unix_s: float
    sequence: int
    offset: int
    length: int
    packing: Packing | None = None
    size_wh_px: tuple[int, int] = (0, 0)


@dataclass(frozen=True, slots=True)
class _Channel:
    topic: Topic | None
    packing: Packing | None
    size_wh_px: tuple[int, int]


class MessageLocations:
    """Messages of a recording in the order of the file, up to the end of an incomplete file.

    Attributes:
        is_whole: Whether the file is complete; known after the last message.
        position: Number of bytes read or skipped.
        size_bytes: Size of the file.

    Raises:
        RecordingError: RECORDING_NOT_READABLE.
    """

    def __init__(self, path: Path) -> None:
        # Rejects files that are not recordings.
        RecordingReader(path).close()
        self.is_whole = False
        self.position = len(MAGIC)
        self.size_bytes = path.stat().st_size
        self._path = path
        self._channels: dict[int, _Channel] = {}

    def __iter__(self) -> Iterator[Location]:
        with self._path.open("rb") as file:
            try:
                yield from self._records(file, len(MAGIC), self.size_bytes)
            except (struct.error, UnicodeDecodeError, KeyError, ValueError):
                # Truncated or damaged here; earlier messages are readable.
                self.is_whole = False

    def _records(
        self, file: IO[bytes], begin: int, end: int, *, is_in_chunk: bool = False
    ) -> Iterator[Location]:
        at = begin
        while at + RECORD.size <= end:
            file.seek(at)
            opcode, length = RECORD.unpack(file.read(RECORD.size))
            content, at = at + RECORD.size, at + RECORD.size + length
            if at > end:
                raise ValueError("a record ends beyond its chunk")
            self.position = content
            match opcode:
                case Opcode.CHUNK if is_in_chunk:
                    raise ValueError("a chunk is inside of a chunk")
                case Opcode.CHUNK:
                    yield from self._records(file, _begin_of_records(file), at, is_in_chunk=True)
                case Opcode.CHANNEL:
                    self._add_channel(file.read(length))
                case Opcode.MESSAGE if length < MESSAGE.size:
                    raise ValueError("a message is shorter than its head")
                case Opcode.MESSAGE:
                    channel_id, sequence, log_ns, _ = MESSAGE.unpack(file.read(MESSAGE.size))
                    channel = self._channels[channel_id]
                    if channel.topic is not None:
                        yield Location(
                            topic=channel.topic,
                            unix_s=log_ns / NANOSECONDS,
                            sequence=sequence,
                            offset=content + MESSAGE.size,
                            length=length - MESSAGE.size,
                            packing=channel.packing,
                            size_wh_px=channel.size_wh_px,
                        )
                case Opcode.FOOTER:
                    self.is_whole = True
                    return
                case _:  # indexes and summaries, which a cut file does not have
                    pass

    def _add_channel(self, content: bytes) -> None:
        (number,) = struct.unpack_from("<H", content)
        name, at = _text(content, 4)
        encoding, at = _text(content, at)
        topic = TOPICS.get(name)
        if topic is not Topic.IMAGE:
            self._channels[number] = _Channel(topic, None, (0, 0))
            return
        metadata, at = {}, at + 4
        while at < len(content):
            key, at = _text(content, at)
            metadata[key], at = _text(content, at)
        size = int(metadata["width_px"]), int(metadata["height_px"])
        self._channels[number] = _Channel(topic, known_packing(self._path, encoding), size)


def read_duration_s(path: Path) -> float | None:
    """Return the time from the first to the last message of a complete recording; None if incomplete."""
    with path.open("rb") as file:
        size = file.seek(0, 2)
        if size < FOOTER_BYTES:
            return None
        file.seek(size - FOOTER_BYTES)
        footer = file.read(FOOTER_BYTES)
        if not footer.endswith(MAGIC) or footer[0] != Opcode.FOOTER:
            return None
        (at,) = struct.unpack_from("<Q", footer, RECORD.size)
        while 0 < at < size - FOOTER_BYTES:
            file.seek(at)
            opcode, length = RECORD.unpack(file.read(RECORD.size))
            if opcode == Opcode.STATISTICS:
                content = file.read(STATISTICS.size)
                if len(content) < STATISTICS.size:
                    return None
                *_, first_ns, last_ns = STATISTICS.unpack(content)
                return float((last_ns - first_ns) / NANOSECONDS)
            at += RECORD.size + length
    return None


def read_content(file: IO[bytes], offset: int, length: int) -> bytes:
    """Return the content of a message."""
    file.seek(offset)
    return file.read(length)


def _begin_of_records(file: IO[bytes]) -> int:
    file.read(CHUNK.size)
    (name_length,) = struct.unpack("<I", file.read(4))
    if name_length:
        raise ValueError("a chunk is compressed")
    file.read(8)
    return file.tell()


def _text(content: bytes, at: int) -> tuple[str, int]:
    (length,) = struct.unpack_from("<I", content, at)
    return content[at + 4 : at + 4 + length].decode(), at + 4 + length
