"""Reader of recordings; an incomplete file is read up to its last complete chunk."""

import json
import re
import struct
from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path
from typing import IO

import zstandard
from mcap.exceptions import McapError
from mcap.records import Channel, Footer, Header, Message, Schema
from mcap.stream_reader import CRCValidationError, StreamReader

from server.errors import RecordingError
from server.recording_file.codec import Json
from server.recording_file.packing import Image, PackedImage, Packing, unpacked
from server.recording_file.topics import PROFILE, ZSTD_JSON, Topic

NANOSECONDS = 1e9
# An escaped half of a character, which JSON permits and no text of Unicode has.
SURROGATE = re.compile(rb"\\u[dD][89a-fA-F]")
MAX_RECORD_BYTES = 256 * 2**20
MAX_VALUE_BYTES = 512 * 2**20
# Exceptions raised for a damaged length.
TOO_LONG = (MemoryError, OverflowError)
# Exceptions raised for content that this version does not write.
OTHER_CONTENT = (ValueError, TypeError, LookupError, AttributeError, ArithmeticError, RecursionError)
TOPICS = {one.value: one for one in Topic}


@dataclass(frozen=True, slots=True, kw_only=True)
class RecordedMessage:
    """One message.

    Attributes:
        topic: Its topic.
        channel_id: Id of its channel, see `RecordingReader.channels`.
        log_ns: Unix time in ns.
        sequence: Number of the image if it refers to one.
        content: Its bytes.
        packed: The image; None for other messages.
        is_compressed: Whether the content is compressed JSON.
    """

    topic: Topic
    channel_id: int
    log_ns: int
    sequence: int
    content: bytes
    packed: PackedImage | None = None
    is_compressed: bool = False

    @property
    def unix_s(self) -> float:
        """Unix time of the message."""
        return self.log_ns / NANOSECONDS

    @property
    def image(self) -> Image | None:
        """Return the decoded image; None if it cannot be decoded."""
        return None if self.packed is None else unpacked(self.packed)

    def json(self) -> Json:
        """Return the content of the message.

        Raises:
            ValueError: The content is not JSON.
        """
        return decompressed_json(self.content) if self.is_compressed else parsed_json(self.content)


def parsed_json(content: bytes) -> Json:
    """Return the value of a JSON message.

    Raises:
        ValueError: The content is not JSON, or has a text that cannot be encoded.
        RecursionError: It is nested too deeply.
    """
    value = json.loads(content)
    if SURROGATE.search(content):
        json.dumps(value, ensure_ascii=False).encode()
    return value


def decompressed_json(content: bytes) -> Json:
    """Return the value of a compressed JSON message.

    Raises:
        ValueError: The content is damaged.
    """
    try:
        with zstandard.ZstdDecompressor().stream_reader(content) as stream:
            return parsed_json(stream.read(MAX_VALUE_BYTES))
    except zstandard.ZstdError as error:
        raise ValueError(str(error)) from error


@contextmanager
def rejecting_other_content(path: Path) -> Iterator[None]:
    """Context manager for reading what is in messages: their checksums agree, but anybody can write them.

    Raises:
        RecordingError: RECORDING_NOT_READABLE.
    """
    try:
        yield
    except OTHER_CONTENT as error:
        why = f"a message has other content than this version writes ({type(error).__name__})"
        raise _not_readable(path, why) from error


class RecordingReader:
    """The messages of a recording, in the order in which they were written.

    Attributes:
        is_whole: Whether the file is complete; known after `messages`.
        is_damaged: Whether a part of the file is damaged.
        incomplete_reason: Why it was not read to its end; empty if it was.
        library: The program that wrote it, with its version.
        channels, schemas: Channels and schemas of the messages read so far, by id.

    Raises:
        RecordingError: RECORDING_NOT_READABLE: The file does not exist or is not a recording of Coaxial.
    """

    def __init__(self, path: Path) -> None:
        self.is_whole, self.is_damaged, self.incomplete_reason = False, False, ""
        self.channels: dict[int, Channel] = {}
        self.schemas: dict[int, Schema] = {}
        self._path = path
        try:
            self._file: IO[bytes] = path.open("rb")
        except OSError as error:
            raise _not_readable(path, (error.strerror or str(error)).lower()) from error
        self._records = StreamReader(
            self._file, validate_crcs=True, record_size_limit=MAX_RECORD_BYTES
        ).records
        try:
            header = next(self._records, None)
        except (McapError, ValueError, EOFError, struct.error, *TOO_LONG) as error:
            self._file.close()
            raise _not_readable(path, "it is not an MCAP file") from error
        if not isinstance(header, Header) or header.profile != PROFILE:
            self._file.close()
            raise _not_readable(path, "it is not a recording of Coaxial")
        self.library = header.library

    def messages(self) -> Iterator[RecordedMessage]:
        """Yield the messages up to the end of the file, or to the point where it is truncated or damaged.

        Raises:
            RecordingError: RECORDING_NOT_READABLE: Another version encoded its images.
        """
        try:
            for record in self._records:
                if isinstance(record, Channel):
                    self.channels[record.id] = record
                elif isinstance(record, Schema):
                    self.schemas[record.id] = record
                elif isinstance(record, Message):
                    message = self._message(record)
                    if message is not None:
                        yield message
                elif isinstance(record, Footer):
                    self.is_whole = True
        except CRCValidationError:
            self.is_damaged, self.incomplete_reason = True, "a checksum is wrong"
        except (McapError, ValueError, EOFError, struct.error, LookupError, *TOO_LONG):
            self.incomplete_reason = "it ends inside a chunk"
        else:
            self.incomplete_reason = "" if self.is_whole else "its end record is missing"
        finally:
            self._file.close()

    def close(self) -> None:
        """Close the file."""
        self._file.close()

    def _message(self, record: Message) -> RecordedMessage | None:
        channel = self.channels[record.channel_id]
        topic = TOPICS.get(channel.topic)
        if topic is None:
            return None
        packed = None
        if topic is Topic.IMAGE:
            size = int(channel.metadata["width_px"]), int(channel.metadata["height_px"])
            packing = known_packing(self._path, channel.message_encoding)
            packed = PackedImage(packing=packing, size_wh_px=size, content=record.data)
        return RecordedMessage(
            topic=topic,
            channel_id=record.channel_id,
            log_ns=record.log_time,
            sequence=record.sequence,
            content=record.data,
            packed=packed,
            is_compressed=channel.message_encoding == ZSTD_JSON,
        )


def known_packing(path: Path, encoding: str) -> Packing:
    """Return the packing of a channel's images.

    Raises:
        RecordingError: RECORDING_NOT_READABLE: Another version encoded them.
    """
    try:
        return Packing(encoding)
    except ValueError as error:
        raise _not_readable(path, f"this version cannot read its images ({encoding[:40]})") from error


def _not_readable(path: Path, why: str) -> RecordingError:
    return RecordingError(
        "RECORDING_NOT_READABLE",
        f"{path} cannot be read as a recording: {why}",
        "Give a recording of Coaxial (.mcap).",
        {"file": str(path), "read_problem": why, "system_error": why},
    )
