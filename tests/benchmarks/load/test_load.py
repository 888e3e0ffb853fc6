"""The load command counts correctly: images, ages and sizes are parsed from recorded streams."""

import struct

import pytest

from tests.benchmarks.load.load_tables import growth, load_tables
from tests.benchmarks.load.run import LoadResult, ViewerResult, mix
from tests.benchmarks.load.stream_readers import Frames, Parts, ReceivedImages

TEXT = b'{"sequence":1,"sent_at_s":9.0,"shown_scale_ratio":0.5,"snapshot":{"captured_at_s":9.98}}'


def frame(content: bytes, opcode: int = 2) -> bytes:
    length = (
        bytes([len(content)])
        if len(content) < 126
        else b"\x7e" + struct.pack(">H", len(content))
        if len(content) < 65_536
        else b"\x7f" + struct.pack(">Q", len(content))
    )
    return bytes([0x80 | opcode]) + length + content


def part(content: bytes) -> bytes:
    return content + b"\r\n--coaxial\r\nContent-Type: image/jpeg\r\n\r\n"


@pytest.mark.parametrize("step", [1, 7, 4096, 10**6])
def test_frames_are_counted_however_they_are_cut(step: int) -> None:
    received = ReceivedImages()
    frames = Frames(received)
    sent = b"".join(
        [frame(TEXT, 1), frame(b"", 9), frame(TEXT + b"\xff" * 70_000), frame(TEXT + b"\xff" * 300)]
    )
    ended = sum(frames.read(memoryview(sent[at : at + step]), now_s=10.0) for at in range(0, len(sent), step))
    assert ended == 3
    assert [round(age) for age in received.ages_ms] == [20, 20, 20]
    assert received.scales == [0.5, 0.5, 0.5]
    assert received.total_bytes == len(sent)


@pytest.mark.parametrize("step", [1, 7, 4096, 10**6])
def test_parts_end_where_the_next_one_begins(step: int) -> None:
    received = ReceivedImages()
    parts = Parts(received)
    sent = b"--coaxial\r\nContent-Type: image/jpeg\r\n\r\n" + part(TEXT + b"\xff" * 9000) + part(b"card")
    sent += part(TEXT)
    ended = sum(parts.read(memoryview(sent[at : at + step]), now_s=10.0) for at in range(0, len(sent), step))
    # The first boundary ends no image, and the card is none.
    assert ended == 4
    assert [round(age) for age in received.ages_ms] == [20, 20]


@pytest.mark.parametrize(("viewers", "kinds"), [(1, (1, 0, 0)), (8, (5, 2, 1)), (28, (17, 7, 4))])
def test_each_kind_of_viewer_is_there(viewers: int, kinds: tuple[int, int, int]) -> None:
    assert tuple(mix(viewers).values()) == kinds


def test_growth_is_against_those_around() -> None:
    assert growth([12.0] * 10, [8.0] * 5 + [12.0] * 5, 50.0) == "+20 %"
    received = ViewerResult(
        kind="view", is_open=True, seconds=2.0, ages_ms=[30.0] * 60, scales=[1.0] * 60, total_bytes=4
    )
    none = LoadResult(viewers=0, tracker_ms=[8.0])
    with_load = LoadResult(viewers=1, tracker_ms=[10.0], received=[received])
    cost, gain = load_tables([none, none], [with_load])
    assert cost.rows[0][3:5] == ["+25 %", "+25 %"]
    assert gain.rows[0][:5] == ["1", "30.0 / 30.0", "30 / 30", "0.0", "full 100 %"]
