"""Encoding and decoding of OpenIGTLink messages with header versions 1 and 2 (protocol versions 1 to 3).

A message is a header of 58 bytes and a body, all numbers big-endian, with a checksum of the body. In version
2 the body starts with an extended header and ends with metadata, pairs of texts. This module uses neither
sockets nor clocks.
"""

import math
import struct
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from enum import IntEnum

import numpy as np

from tracker.geometry import Array

HEADER = struct.Struct(">H12s20sIIQQ")
EXTENDED_HEADER = struct.Struct(">HHII")
METADATA_COUNT, METADATA_ENTRY = struct.Struct(">H"), struct.Struct(">HHI")
TRANSFORM, STATUS_HEAD, STRING_HEAD = struct.Struct(">12f"), struct.Struct(">Hq20s"), struct.Struct(">HH")
POINT = struct.Struct(">64s32s4B3ff20s")
TRACKED_TOOL, START_TRACKING = struct.Struct(">20sBx12f"), struct.Struct(">i32s")
HEADER_BYTES = HEADER.size
TYPE_BYTES, DEVICE_BYTES = 12, 20
VERSIONS = (1, 2)
# IANA's numbers of the character sets.
ASCII, UTF_8 = 3, 106
MAX_STRING_BYTES = 0xFFFF
# Types of TDATA that have a position and all three angles; a 3D tool has no rotation, a 5D tool lacks one.
TYPES_6D = frozenset({1, 2})
# Yellow, as points are commonly shown.
POINT_COLOUR = (255, 255, 0, 255)

# ECMA-182, most significant bit first, starting with 0.
CRC64_POLYNOMIAL = 0x42F0E1EBA9EA3693
MASK_64 = 0xFFFF_FFFF_FFFF_FFFF


class WireError(Exception):
    """Bytes are not a message: truncated, damaged, or of an unknown version."""


class ChecksumError(WireError):
    """The body does not match its checksum."""


class OversizeError(WireError):
    """The body exceeds the maximum size."""


class StatusCode(IntEnum):
    """Codes of STATUS that are sent."""

    OK = 1
    UNKNOWN_ERROR = 2
    BUSY = 6
    TIME_OUT = 7
    OVERFLOW = 8
    CHECKSUM_ERROR = 9
    CONFIG_ERROR = 10
    NOT_READY = 13
    NOT_PRESENT = 16


@dataclass(frozen=True, slots=True, kw_only=True)
class Header:
    """The first 58 bytes of a message.

    Attributes:
        version: of the header, 1 or 2.
        type: type name, as "TRANSFORM".
        device: device name; may be empty.
        timestamp_s: Unix time; 0 if unused.
        body_bytes: length of the body.
        crc: checksum of the body.
    """

    version: int
    type: str
    device: str
    timestamp_s: float
    body_bytes: int
    crc: int


@dataclass(frozen=True, slots=True, kw_only=True)
class Message:
    """A message.

    Attributes:
        type: type name.
        device: device name, at most 20 ASCII characters.
        timestamp_s: Unix time for which its content is valid; 0 if unused.
        content: Bytes of the content, in the format of its type.
        metadata: sent with version 2 only.
    """

    type: str
    device: str
    timestamp_s: float
    content: bytes = b""
    metadata: Mapping[str, str] = field(default_factory=dict)


@dataclass(frozen=True, slots=True, kw_only=True)
class Status:
    """Content of STATUS; `name` is a code of this program, truncated to 20 characters."""

    code: int
    sub_code: int = 0
    name: str
    text: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Point:
    """One point of POINT: (3,) in mm."""

    name: str
    group: str
    position_mm: Array


def _crc64_table() -> tuple[int, ...]:
    table = []
    for byte in range(256):
        crc = byte << 56
        for _ in range(8):
            crc = (crc << 1 & MASK_64) ^ (CRC64_POLYNOMIAL if crc >> 63 else 0)
        table.append(crc)
    return tuple(table)


_CRC64 = _crc64_table()


def crc64(body: bytes) -> int:
    """Return the checksum of a body."""
    crc = 0
    for byte in body:
        crc = ((crc << 8) & MASK_64) ^ _CRC64[(crc >> 56) ^ byte]
    return crc


def is_device_name(name: str) -> bool:
    """Return whether a name fits into a header."""
    return name.isascii() and name.isprintable() and 0 < len(name) <= DEVICE_BYTES


def pack(message: Message, *, version: int) -> bytes:
    """Return the bytes of a message, with a header of this version.

    Raises:
        WireError: a name or a time does not fit.
    """
    if not is_device_name(message.device):
        raise WireError(
            f"the device name '{message.device[:40]}' is not 1 to {DEVICE_BYTES} ASCII characters"
        )
    if not 0.0 <= message.timestamp_s < 2.0**32:
        raise WireError(f"the time {message.timestamp_s} s does not fit")
    body = message.content if version == 1 else _with_metadata(message)
    fraction, seconds = math.modf(message.timestamp_s)
    return (
        HEADER.pack(
            version,
            _padded(message.type, TYPE_BYTES),
            message.device.encode("ascii"),
            int(seconds),
            int(fraction * 2.0**32),
            len(body),
            crc64(body),
        )
        + body
    )


def unpack_header(content: bytes) -> Header:
    """Parse the first 58 bytes of a message.

    Raises:
        WireError: There are too few bytes, the version is unknown, or a name is not ASCII.
    """
    if len(content) < HEADER_BYTES:
        raise WireError(f"a header has {HEADER_BYTES} bytes, not {len(content)}")
    version, kind, device, seconds, fraction, body_bytes, crc = HEADER.unpack_from(content)
    if version not in VERSIONS:
        raise WireError(f"header version {version} is unknown, supported are {VERSIONS}")
    return Header(
        version=version,
        type=_text(kind),
        device=_text(device),
        timestamp_s=seconds + fraction / 2.0**32,
        body_bytes=body_bytes,
        crc=crc,
    )


def unpack(header: Header, body: bytes) -> Message:
    """Return the message of a header and its body.

    Raises:
        ChecksumError: the body was damaged.
        WireError: Its length and its parts contradict each other.
    """
    if len(body) != header.body_bytes:
        raise WireError(f"the body has {len(body)} bytes, its header states {header.body_bytes}")
    if crc64(body) != header.crc:
        raise ChecksumError(f"the body of {header.type} does not match the checksum in its header")
    content, metadata = (body, {}) if header.version == 1 else _without_metadata(body)
    return Message(
        type=header.type,
        device=header.device,
        timestamp_s=header.timestamp_s,
        content=content,
        metadata=metadata,
    )


@dataclass(slots=True, kw_only=True)
class MessageReader:
    """Parses the bytes of one connection. After a `WireError` the position in the stream is unknown.

    Attributes:
        max_body_bytes: maximum length of a body.
    """

    max_body_bytes: int
    _waiting: bytearray = field(default_factory=bytearray)
    _header: Header | None = None

    def feed(self, content: bytes) -> Iterator[Message | ChecksumError]:
        """Yield each complete message, or the error of a message with a damaged body.

        Raises:
            WireError: The start of the next message is unknown.
            OversizeError: A header announces a body that is too long.
        """
        self._waiting += content
        while (message := self._next()) is not None:
            yield message

    def _next(self) -> Message | ChecksumError | None:
        if self._header is None:
            if len(self._waiting) < HEADER_BYTES:
                return None
            header = unpack_header(self._taken(HEADER_BYTES))
            if header.body_bytes > self.max_body_bytes:
                raise OversizeError(
                    f"the body of {header.type} has {header.body_bytes} bytes, "
                    f"the maximum is {self.max_body_bytes}"
                )
            self._header = header
        if len(self._waiting) < self._header.body_bytes:
            return None
        header, self._header = self._header, None
        try:
            return unpack(header, self._taken(header.body_bytes))
        except ChecksumError as error:
            # The length was correct, so that the start of the next message is known.
            return error

    def _taken(self, count: int) -> bytes:
        taken = bytes(self._waiting[:count])
        del self._waiting[:count]
        return taken


def transform_content(matrix: Array) -> bytes:
    """Return the content of TRANSFORM of a homogeneous (4, 4) matrix, translation in mm."""
    return TRANSFORM.pack(*np.asarray(matrix, dtype=np.float64)[:3].T.ravel())


def transform_of(content: bytes) -> Array:
    """Return the homogeneous (4, 4) matrix of TRANSFORM.

    Raises:
        WireError: another length.
    """
    _reject_length("TRANSFORM", content, TRANSFORM.size)
    return _matrix_of(TRANSFORM.unpack(content))


def _matrix_of(numbers: Sequence[float]) -> Array:
    """Return the matrix of the 12 numbers on the wire: three columns of the rotation, then the position."""
    matrix = np.eye(4)
    matrix[:3] = np.array(numbers).reshape(4, 3).T
    return matrix


def tracked_tools_of(content: bytes) -> dict[str, Array]:
    """Return the homogeneous (4, 4) matrices of TDATA by name; tools without all six degrees are omitted.

    Raises:
        WireError: Its length is not a multiple of the size of a tool, a name cannot be decoded, or comes
            twice.
    """
    if len(content) % TRACKED_TOOL.size:
        raise WireError(f"TDATA has {len(content)} bytes, expected a multiple of {TRACKED_TOOL.size}")
    tools: dict[str, Array] = {}
    for name_bytes, kind, *numbers in TRACKED_TOOL.iter_unpack(content):
        name = _text(name_bytes)
        if name in tools:
            raise WireError(f"TDATA has the tool '{name}' twice")
        if kind in TYPES_6D:
            tools[name] = _matrix_of(numbers)
    return tools


def start_tracking_content(resolution_ms: int) -> bytes:
    """Return the content of STT_TDATA, which requests TDATA at most this often."""
    return START_TRACKING.pack(resolution_ms, b"")


def status_content(status: Status) -> bytes:
    """Return the content of STATUS; its text ends with a zero byte, as readers in C expect."""
    head = STATUS_HEAD.pack(status.code, status.sub_code, _padded(status.name, 20))
    return head + status.text.encode("utf-8") + b"\0"


def status_of(content: bytes) -> Status:
    """Return the content of STATUS.

    Raises:
        WireError: it is too short, or its texts cannot be decoded.
    """
    if len(content) < STATUS_HEAD.size:
        raise WireError(f"STATUS has {len(content)} bytes, the minimum is {STATUS_HEAD.size}")
    code, sub_code, name = STATUS_HEAD.unpack_from(content)
    text = _decoded(content[STATUS_HEAD.size :].rstrip(b"\0"), "utf-8")
    return Status(code=code, sub_code=sub_code, name=_text(name), text=text)


def string_content(text: str) -> bytes:
    """Return the content of STRING, in ASCII if possible.

    Raises:
        WireError: it is too long.
    """
    encoded = text.encode("utf-8")
    if len(encoded) > MAX_STRING_BYTES:
        raise WireError(f"the text has {len(encoded)} bytes, the maximum is {MAX_STRING_BYTES}")
    return STRING_HEAD.pack(ASCII if text.isascii() else UTF_8, len(encoded)) + encoded


def string_of(content: bytes) -> str:
    """Return the text of STRING.

    Raises:
        WireError: The length differs from the stated one, or the encoding is not supported.
    """
    if len(content) < STRING_HEAD.size:
        raise WireError(f"STRING has {len(content)} bytes, the minimum is {STRING_HEAD.size}")
    encoding, length = STRING_HEAD.unpack_from(content)
    _reject_length("STRING", content, STRING_HEAD.size + length)
    if encoding not in {ASCII, UTF_8}:
        raise WireError(f"STRING has the encoding {encoding}, supported are {ASCII} and {UTF_8}")
    return _decoded(content[STRING_HEAD.size :], "ascii" if encoding == ASCII else "utf-8")


def points_content(points: Sequence[Point]) -> bytes:
    """Return the content of POINT; diameters are 0, and no point belongs to an image."""
    return b"".join(
        POINT.pack(
            _padded(point.name, 64), _padded(point.group, 32), *POINT_COLOUR, *point.position_mm, 0.0, b""
        )
        for point in points
    )


def points_of(content: bytes) -> tuple[Point, ...]:
    """Return the points of POINT.

    Raises:
        WireError: Its length is not a multiple of the size of a point.
    """
    if len(content) % POINT.size:
        raise WireError(f"POINT has {len(content)} bytes, expected a multiple of {POINT.size}")
    return tuple(
        Point(name=_text(one[0]), group=_text(one[1]), position_mm=np.array(one[6:9]))
        for one in POINT.iter_unpack(content)
    )


def capability_content(types: Sequence[str]) -> bytes:
    """Return the content of CAPABILITY, which lists types of messages."""
    return b"".join(struct.pack("12s", _padded(name, TYPE_BYTES)) for name in types)


def _with_metadata(message: Message) -> bytes:
    entries = [(key.encode("utf-8"), value.encode("utf-8")) for key, value in message.metadata.items()]
    index = METADATA_COUNT.pack(len(entries)) + b"".join(
        METADATA_ENTRY.pack(len(key), UTF_8, len(value)) for key, value in entries
    )
    texts = b"".join(key + value for key, value in entries)
    return (
        EXTENDED_HEADER.pack(EXTENDED_HEADER.size, len(index), len(texts), 0)
        + message.content
        + index
        + texts
    )


def _without_metadata(body: bytes) -> tuple[bytes, dict[str, str]]:
    if len(body) < EXTENDED_HEADER.size:
        raise WireError(f"the extended header has {len(body)} bytes, expected {EXTENDED_HEADER.size}")
    head_bytes, index_bytes, text_bytes, _ = EXTENDED_HEADER.unpack_from(body)
    content_bytes = len(body) - head_bytes - index_bytes - text_bytes
    if head_bytes < EXTENDED_HEADER.size or content_bytes < 0:
        raise WireError("the parts of the body are longer than the body")
    index_at = head_bytes + content_bytes
    index, texts = body[index_at : index_at + index_bytes], body[index_at + index_bytes :]
    return body[head_bytes:index_at], _metadata(index, texts)


def _metadata(index: bytes, texts: bytes) -> dict[str, str]:
    if not index:
        return {}
    if len(index) < METADATA_COUNT.size:
        raise WireError("the index of the metadata is truncated")
    (count,) = METADATA_COUNT.unpack_from(index)
    _reject_length("the index of the metadata", index, METADATA_COUNT.size + count * METADATA_ENTRY.size)
    metadata, at = {}, 0
    for key_bytes, encoding, value_bytes in METADATA_ENTRY.iter_unpack(index[METADATA_COUNT.size :]):
        key, value = texts[at : at + key_bytes], texts[at + key_bytes : at + key_bytes + value_bytes]
        at += key_bytes + value_bytes
        if encoding in {ASCII, UTF_8}:
            metadata[_decoded(key, "utf-8")] = _decoded(value, "utf-8")
    _reject_length("the metadata", texts, at)
    return metadata


def _reject_length(what: str, content: bytes, needed: int) -> None:
    if len(content) != needed:
        raise WireError(f"{what} has {len(content)} bytes, expected {needed}")


def _padded(text: str, length: int) -> bytes:
    """Encode a text for a field of fixed length; `struct` pads it with zero bytes."""
    encoded = text.encode("utf-8")[:length]
    # A truncated character is dropped.
    return encoded.decode("utf-8", errors="ignore").encode("utf-8")


def _text(field_bytes: bytes) -> str:
    return _decoded(field_bytes.split(b"\0", maxsplit=1)[0].rstrip(), "utf-8")


def _decoded(encoded: bytes, encoding: str) -> str:
    try:
        return encoded.decode(encoding)
    except UnicodeDecodeError as error:
        raise WireError("a text cannot be decoded") from error
