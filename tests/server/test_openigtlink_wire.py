"""Bytes of OpenIGTLink, against pyigtl in both directions; cut at each length, and with each bit flipped."""

import struct

import numpy as np
import pyigtl
import pytest
from pyigtl.messages import CRC64, MessageBase

from server import openigtlink_wire as wire
from server.openigtlink_wire import ChecksumError, Message, Point, Status, WireError
from tracker.geometry import Rigid, Tool, Vertebra

AT_S = 1_764_130_000.25
MATRIX = Rigid[Vertebra, Tool].from_vector([0.3, -0.5, 1.1], [12.5, -250.0, 971.75]).matrix


def of_theirs(content: bytes) -> MessageBase:
    fields = MessageBase.parse_header(content[: wire.HEADER_BYTES])
    assert len(content) == wire.HEADER_BYTES + fields["body_size"]
    (crc,) = struct.unpack(">Q", content[50:58])
    assert crc == CRC64(content[wire.HEADER_BYTES :])
    message = MessageBase.create_message(fields["message_type"])
    message.unpack(fields, content[wire.HEADER_BYTES :])
    return message


def of_ours(content: bytes) -> Message:
    header = wire.unpack_header(content)
    return wire.unpack(header, content[wire.HEADER_BYTES :])


def message(kind: str, content: bytes, **more: object) -> Message:
    return Message(type=kind, device="DrillToVertebra", timestamp_s=AT_S, content=content, **more)  # pyrefly: ignore[bad-argument-type]


@pytest.mark.parametrize("version", [1, 2])
def test_pyigtl_reads_what_is_written(version: int) -> None:
    metadata = {"Coordinates": "RAS"}
    read = of_theirs(
        wire.pack(message("TRANSFORM", wire.transform_content(MATRIX), metadata=metadata), version=version)
    )
    assert (read.device_name, read.header_version) == ("DrillToVertebra", version)
    assert read.timestamp == pytest.approx(AT_S, abs=1e-6)
    assert read.matrix == pytest.approx(MATRIX, abs=1e-4)
    assert read.metadata == ({} if version == 1 else metadata)
    for text in ("ON PATH", "AIM 3.1° medial"):
        assert (
            of_theirs(wire.pack(message("STRING", wire.string_content(text)), version=version)).string == text
        )
    points = [
        Point(name=name, group="Coaxial", position_mm=np.array([1.5, -2.0, n]))
        for n, name in enumerate(("entry", "target"))
    ]
    read = of_theirs(wire.pack(message("POINT", wire.points_content(points)), version=version))
    assert (read.names, read.groups) == (["entry", "target"], ["Coaxial", "Coaxial"])
    assert read.positions == [(1.5, -2.0, 0.0), (1.5, -2.0, 1.0)]


@pytest.mark.parametrize("version", [1, 2])
def test_what_pyigtl_writes_is_read(version: int) -> None:
    theirs = [
        pyigtl.TransformMessage(MATRIX, device_name="Probe", timestamp=AT_S),
        pyigtl.StringMessage("hello", device_name="Probe", timestamp=AT_S),
        pyigtl.PointMessage([[1, 2, 3], [4, 5, 6]], names=["a", "b"], device_name="Probe", timestamp=AT_S),
    ]
    for one in theirs:
        one.header_version = version
        if version == 2:
            one.metadata = {"key": "value"}
    transform, string, point = (of_ours(one.pack()) for one in theirs)
    assert (transform.type, transform.device) == ("TRANSFORM", "Probe")
    assert transform.timestamp_s == pytest.approx(AT_S, abs=1e-6)
    assert transform.metadata == ({"key": "value"} if version == 2 else {})
    assert wire.transform_of(transform.content) == pytest.approx(MATRIX, abs=1e-4)
    assert wire.string_of(string.content) == "hello"
    assert [one.name for one in wire.points_of(point.content)] == ["a", "b"]
    assert [one.position_mm.tolist() for one in wire.points_of(point.content)] == [[1, 2, 3], [4, 5, 6]]


def test_the_checksum_is_that_of_ecma_182() -> None:
    # The check value of CRC-64/ECMA-182 in the catalogue of CRC algorithms.
    assert wire.crc64(b"123456789") == 0x6C40DF5F0B497347
    assert wire.crc64(b"") == 0


def test_a_status_has_the_bytes_of_the_specification() -> None:
    status = Status(code=16, sub_code=-2, name="CAMERA_NOT_CALIBRATED", text="camera")
    content = wire.status_content(status)
    assert content == b"\x00\x10" + b"\xff" * 7 + b"\xfe" + b"CAMERA_NOT_CALIBRATE" + b"camera\x00"
    read = wire.status_of(content)
    assert (read.code, read.sub_code, read.name, read.text) == (16, -2, "CAMERA_NOT_CALIBRATE", "camera")


def test_a_capability_lists_types_of_twelve_bytes() -> None:
    assert wire.capability_content(["STATUS", "GET_CAPABIL"]) == b"STATUS" + bytes(6) + b"GET_CAPABIL\0"


@pytest.mark.parametrize("device", ["", "a" * 21, "Bohrer ä", "a\nb"])
def test_a_name_that_does_not_fit_is_not_sent(device: str) -> None:
    with pytest.raises(WireError):
        wire.pack(Message(type="STATUS", device=device, timestamp_s=AT_S), version=1)


@pytest.mark.parametrize("at_s", [-1.0, 2.0**32, float("nan")])
def test_a_time_that_does_not_fit_is_not_sent(at_s: float) -> None:
    with pytest.raises(WireError):
        wire.pack(Message(type="STATUS", device="a", timestamp_s=at_s), version=1)


@pytest.mark.parametrize("version", [1, 2])
def test_a_message_cut_at_any_length_is_rejected(version: int) -> None:
    content = wire.pack(
        message("TRANSFORM", wire.transform_content(MATRIX), metadata={"a": "b"}), version=version
    )
    for length in range(len(content)):
        with pytest.raises(WireError):
            of_ours(content[:length])


@pytest.mark.parametrize("version", [1, 2])
def test_each_flipped_bit_of_a_body_is_noticed(version: int) -> None:
    content = wire.pack(
        message("TRANSFORM", wire.transform_content(MATRIX), metadata={"a": "b"}), version=version
    )
    header = wire.unpack_header(content)
    for bit in range(8 * wire.HEADER_BYTES, 8 * len(content)):
        damaged = bytearray(content)
        damaged[bit // 8] ^= 1 << bit % 8
        with pytest.raises(ChecksumError):
            wire.unpack(header, bytes(damaged[wire.HEADER_BYTES :]))


def test_a_flipped_bit_of_a_header_is_noticed_or_changes_a_name_or_a_time_only() -> None:
    content = wire.pack(message("TRANSFORM", wire.transform_content(MATRIX)), version=1)
    for bit in range(8 * wire.HEADER_BYTES):
        damaged = bytearray(content)
        damaged[bit // 8] ^= 1 << bit % 8
        try:
            read = of_ours(bytes(damaged))
        except WireError:
            continue
        assert 2 <= bit // 8 < 42, "version, length and checksum of a body are checked"
        assert read.content == content[wire.HEADER_BYTES :]


@pytest.mark.parametrize(
    "body",
    [
        pytest.param(struct.pack(">HHII", 11, 0, 0, 0), id="a-short-extended-header"),
        pytest.param(struct.pack(">HHII", 12, 1, 0, 0), id="an-index-longer-than-the-body"),
        pytest.param(struct.pack(">HHII", 12, 1, 0, 0) + b"\0", id="half-a-count"),
        pytest.param(struct.pack(">HHII", 12, 2, 0, 0) + b"\0\1", id="an-entry-that-is-missing"),
        pytest.param(
            struct.pack(">HHII", 12, 10, 1, 0) + b"\0\1" + struct.pack(">HHI", 1, 3, 9) + b"a",
            id="a-cut-value",
        ),
        pytest.param(
            struct.pack(">HHII", 12, 10, 2, 0) + b"\0\1" + struct.pack(">HHI", 1, 106, 1) + b"\xff\xff",
            id="no-text",
        ),
    ],
)
def test_metadata_that_contradict_themselves_are_rejected(body: bytes) -> None:
    header = wire.HEADER.pack(2, b"STATUS", b"a", 0, 0, len(body), wire.crc64(body))
    with pytest.raises(WireError):
        of_ours(header + body)


@pytest.mark.parametrize(
    ("read", "content"),
    [
        (wire.transform_of, bytes(47)),
        (wire.transform_of, bytes(52)),
        (wire.status_of, bytes(29)),
        (wire.status_of, bytes(30) + b"\xff"),
        (wire.string_of, bytes(3)),
        (wire.string_of, struct.pack(">HH", 3, 2) + b"a"),
        (wire.string_of, struct.pack(">HH", 4, 1) + b"a"),
        (wire.points_of, bytes(135)),
    ],
)
def test_a_content_of_another_length_or_encoding_is_rejected(read: object, content: bytes) -> None:
    assert callable(read)
    with pytest.raises(WireError):
        read(content)
