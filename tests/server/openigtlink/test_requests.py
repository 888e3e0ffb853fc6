"""Client messages: in any pieces and order, damaged, too long, and too frequent."""

import pytest

from server import openigtlink_wire as wire
from server.openigtlink.requests import BURST, RequestReader, TooManyRequestsError
from server.openigtlink_wire import ChecksumError, Message, OversizeError, WireError


def request(kind: str, content: bytes = b"", version: int = 1) -> bytes:
    return wire.pack(Message(type=kind, device="any", timestamp_s=0.0, content=content), version=version)


def types(found: object) -> list[str]:
    assert isinstance(found, list)
    return [one.type if isinstance(one, Message) else type(one).__name__ for one in found]


def test_messages_come_out_whole_however_they_are_cut() -> None:
    stream = request("GET_STATUS") + request("STRING", wire.string_content("hi"), 2) + request("STT_TDATA")
    for size in (1, 7, 58, 59, len(stream)):
        reader = RequestReader()
        found = [
            one
            for at in range(0, len(stream), size)
            for one in reader.feed(stream[at : at + size], now_s=0.0)
        ]
        assert types(found) == ["GET_STATUS", "STRING", "STT_TDATA"], size


def test_a_damaged_body_is_reported_and_the_next_message_is_read() -> None:
    damaged = bytearray(request("STRING", wire.string_content("hi")))
    damaged[-1] ^= 1
    reader = RequestReader()
    found = list(reader.feed(bytes(damaged) + request("GET_STATUS"), now_s=0.0))
    assert types(found) == [ChecksumError.__name__, "GET_STATUS"]
    assert reader.damaged == 1


@pytest.mark.parametrize(
    "content", [b"GET / HTTP/1.1\r\n" + bytes(60), b"\x16\x03\x01" + bytes(60), bytes(58)]
)
def test_another_protocol_is_rejected(content: bytes) -> None:
    with pytest.raises(WireError):
        list(RequestReader().feed(content, now_s=0.0))


@pytest.mark.parametrize("length", [4097, 2**63, 2**64 - 1])
def test_a_body_that_is_too_long_is_never_waited_for(length: int) -> None:
    header = wire.HEADER.pack(1, b"IMAGE", b"a", 0, 0, length, 0)
    with pytest.raises(OversizeError):
        list(RequestReader().feed(header, now_s=0.0))


def test_more_messages_than_allowed_end_the_stream_and_fewer_never_do() -> None:
    reader = RequestReader()
    for n in range(200):
        assert len(list(reader.feed(request("GET_STATUS"), now_s=0.05 * n))) == 1
    with pytest.raises(TooManyRequestsError):
        list(reader.feed(request("GET_STATUS") * (int(BURST) + 1), now_s=10.0))
