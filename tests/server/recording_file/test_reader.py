"""Reading a recording, also if it is truncated or damaged."""

import random
import struct
from pathlib import Path

import pytest
from mcap.opcode import Opcode

from server.errors import RecordingError
from server.recording_file import RecordedMessage, RecordingReader, Topic
from server.recording_file.locations import CHUNK, MAGIC, RECORD, MessageLocations, read_duration_s
from tests.server.recording_file.written import OFFSET_S, write_recording


def read(path: Path) -> tuple[list[RecordedMessage], RecordingReader]:
    reader = RecordingReader(path)
    return list(reader.messages()), reader


def test_messages_come_in_their_order_with_time_number_and_pixels(tmp_path: Path) -> None:
    messages, reader = read(write_recording(tmp_path / "a.mcap"))
    assert reader.is_whole
    assert reader.incomplete_reason == ""
    assert [message.topic for message in messages] == [Topic.NOTE, Topic.IMAGE] * 20
    images = [message for message in messages if message.topic is Topic.IMAGE]
    assert [image.sequence for image in images] == list(range(20))
    assert images[3].unix_s == pytest.approx(OFFSET_S + 0.3, abs=1e-6)
    pixels = images[3].image
    assert pixels is not None
    assert pixels[5, 5].tolist() == [3, 3, 3]
    assert messages[6].json()["message"] == "3"


def test_a_file_cut_anywhere_is_readable_up_to_the_cut(tmp_path: Path) -> None:
    content = write_recording(tmp_path / "a.mcap").read_bytes()
    every, _ = read(tmp_path / "a.mcap")
    cut = tmp_path / "cut.mcap"
    draw = random.Random(5)
    counts = []
    for length in sorted(draw.sample(range(60, len(content) - 1), 40)):
        cut.write_bytes(content[:length])
        messages, reader = read(cut)
        assert not reader.is_whole
        assert reader.incomplete_reason
        assert [one.content for one in messages] == [one.content for one in every[: len(messages)]]
        counts.append(len(messages))
    assert counts == sorted(counts)
    # Truncation behind the data loses none of them: the index is not needed.
    assert counts[0] == 0
    assert counts[-1] == len(every)


def test_images_of_another_encoding_are_named(tmp_path: Path) -> None:
    path = write_recording(tmp_path / "a.mcap")
    own, other = b"zstd-row-differences-bgr8", b"zstd-another-encoding-bgr"
    content = path.read_bytes()
    assert own in content
    path.write_bytes(content.replace(own, other))
    with pytest.raises(RecordingError, match=r"cannot read its images \(zstd-another-encoding-bgr\)"):
        list(MessageLocations(path))


def test_a_changed_bit_ends_the_reading_before_its_chunk(tmp_path: Path) -> None:
    path = write_recording(tmp_path / "a.mcap")
    content = bytearray(path.read_bytes())
    at = content.index(b'"message": "9"') + 12
    content[at] ^= 1
    path.write_bytes(content)
    messages, reader = read(path)
    assert not reader.is_whole
    assert reader.incomplete_reason == "a checksum is wrong"
    assert 0 < len(messages) <= 18


@pytest.mark.parametrize("content", [b"", b"no recording at all", b"\x89MCAP0\r\n" + b"\x00" * 40])
def test_another_file_is_rejected(content: bytes, tmp_path: Path) -> None:
    other = tmp_path / "other.mcap"
    other.write_bytes(content)
    with pytest.raises(RecordingError) as rejected:
        RecordingReader(other)
    assert rejected.value.code == "RECORDING_NOT_READABLE"
    with pytest.raises(RecordingError, match="no such file"):
        RecordingReader(tmp_path / "missing.mcap")


@pytest.mark.parametrize("length", [2**40, 2**63], ids=["more-than-memory", "no-index"])
def test_a_damaged_length_ends_the_reading(tmp_path: Path, length: int) -> None:
    path = write_recording(tmp_path / "a.mcap")
    content = bytearray(path.read_bytes())
    # Of the first chunk, after opcode, length, times, size, checksum and the empty compression name.
    at = _first_record(content, Opcode.CHUNK) + struct.calcsize("<BQQQQII")
    content[at : at + 8] = struct.pack("<Q", length)
    path.write_bytes(content)
    messages, reader = read(path)
    assert (messages, reader.is_whole) == ([], False)
    assert reader.incomplete_reason


def nested_chunks(inner: bytes) -> bytes:
    for _ in range(2000):
        content = CHUNK.pack(0, 0, 0, 0) + bytes(4) + struct.pack("<Q", len(inner)) + inner
        inner = RECORD.pack(Opcode.CHUNK, len(content)) + content
    return inner


@pytest.mark.parametrize(
    "records",
    [
        pytest.param(nested_chunks(b""), id="chunks-in-chunks"),
        # Its content would be all of the file.
        pytest.param(RECORD.pack(Opcode.MESSAGE, 3) + bytes(40), id="a-message-without-content"),
    ],
)
def test_records_that_no_writer_makes_end_the_reading(tmp_path: Path, records: bytes) -> None:
    path = write_recording(tmp_path / "a.mcap")
    content = bytearray(path.read_bytes())
    at = _first_record(content, Opcode.CHUNK)
    path.write_bytes(bytes(content[:at]) + records)
    locations = MessageLocations(path)
    assert (list(locations), locations.is_whole) == ([], False)


def test_the_duration_of_a_file_with_damaged_statistics_is_not_known(tmp_path: Path) -> None:
    path = tmp_path / "a.mcap"
    footer = RECORD.pack(Opcode.FOOTER, 20) + struct.pack("<QQI", len(MAGIC), 0, 0)
    path.write_bytes(MAGIC + RECORD.pack(Opcode.STATISTICS, 46) + footer + MAGIC)
    assert read_duration_s(path) is None


def _first_record(content: bytearray, opcode: Opcode) -> int:
    at = len(MAGIC)
    while content[at] != opcode:
        at += RECORD.size + RECORD.unpack_from(content, at)[1]
    return at
