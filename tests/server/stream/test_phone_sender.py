"""Messages of a sending page, in simulated time: clock, order, size."""

import json
from collections.abc import Callable

import pytest

from server.capture.phone import Focus
from server.live import ImageClock, Problem
from server.loop.phone_inbox import MAX_JPEG_BYTES
from server.stream.phone.page_clock import PageClock
from server.stream.phone.sender import MAX_IMAGES_IN_FLIGHT, Received, Sender, parse_hello
from server.stream.socket import ProtocolViolation
from tests.server.capture.fake_phone import jpeg_of

CAMERA = {
    "label": "back",
    "width_px": 160,
    "height_px": 90,
    "rate_hz": 30,
    "focus": "locked",
    "focus_mm": 400,
    "zoom_percent": None,
}
# Offset of the page's clock from this machine's.
AHEAD_S = 5000.0


def said(**message: object) -> str:
    return json.dumps(message)


def pong(sender: Sender, *, sent_s: float, down_s: float = 0.004, up_s: float = 0.02) -> None:
    """A round trip with these delays."""
    grant = sender.update_credit(sent_s)
    at_ms = (sent_s + down_s + AHEAD_S) * 1000.0
    sender.receive_text(said(pong={"ping": grant.ping, "at_ms": at_ms}), sent_s + down_s + up_s)


def introduced(at_s: float = 0.0) -> Sender:
    """A sender that is ready to send."""
    sender = Sender()
    pong(sender, sent_s=at_s)
    sender.receive_text(said(camera=CAMERA), at_s)
    return sender


def announce(sender: Sender, jpeg: bytes, *, captured_s: float, clock: str = "capture") -> None:
    image = {"bytes": len(jpeg), "captured_ms": (captured_s + AHEAD_S) * 1000.0, "clock": clock}
    sender.receive_text(said(image=image), captured_s)


def test_an_image_in_parts_is_whole_with_its_last_one() -> None:
    sender, jpeg = introduced(), jpeg_of(90)
    announce(sender, jpeg, captured_s=1.0)
    assert sender.take_part(jpeg[:100], 1.03) is None
    received = sender.take_part(jpeg[100:], 1.05)
    assert isinstance(received, Received)
    assert received.jpeg == jpeg
    assert (received.clock, received.arrived_s) == (ImageClock.BROWSER, 1.05)
    assert received.camera.focus is Focus.LOCKED
    # Never younger than true, and older at most by the transfer time of a ping.
    assert 1.0 - 0.004 - 1e-6 <= received.captured_at_s <= 1.0 + 1e-6


def test_a_page_without_capture_times_is_reported_as_such() -> None:
    sender, jpeg = introduced(), jpeg_of(90)
    announce(sender, jpeg, captured_s=1.0, clock="presentation")
    received = sender.take_part(jpeg, 1.05)
    assert isinstance(received, Received)
    assert received.clock is ImageClock.ARRIVAL


def test_an_image_is_never_captured_after_it_came() -> None:
    sender, jpeg = introduced(), jpeg_of(90)
    announce(sender, jpeg, captured_s=9.0)
    received = sender.take_part(jpeg, 1.05)
    assert isinstance(received, Received)
    assert received.captured_at_s == 1.05


@pytest.mark.parametrize(
    "jpeg",
    [
        pytest.param(b"not a picture", id="none"),
        pytest.param(jpeg_of(90)[:-2], id="cut-off"),
    ],
)
def test_what_is_no_jpeg_is_reported_and_the_next_one_is_taken(jpeg: bytes) -> None:
    sender = introduced()
    announce(sender, jpeg, captured_s=1.0)
    reported = sender.take_part(jpeg, 1.05)
    assert isinstance(reported, Problem)
    assert reported.code == "PHONE_IMAGE_BROKEN"
    announce(sender, jpeg_of(90), captured_s=1.1)
    assert isinstance(sender.take_part(jpeg_of(90), 1.15), Received)


def test_a_size_that_nothing_could_hold_is_rejected_before_it_is_decoded() -> None:
    whole = jpeg_of(90)
    at = whole.index(b"\xff\xc0") + 5
    bomb = whole[:at] + b"\xff\xff\xff\xff" + whole[at + 4 :]
    sender = introduced()
    announce(sender, bomb, captured_s=1.0)
    reported = sender.take_part(bomb, 1.05)
    assert isinstance(reported, Problem)
    assert "65535x65535" in reported.message


def test_no_more_is_taken_than_was_granted() -> None:
    sender, jpeg = Sender(), jpeg_of(90)
    pong(sender, sent_s=0.0)
    sender.receive_text(said(camera=CAMERA), 0.0)
    for number in range(MAX_IMAGES_IN_FLIGHT):
        announce(sender, jpeg, captured_s=1.0 + number)
        sender.take_part(jpeg, 1.5 + number)
    with pytest.raises(ProtocolViolation, match="beyond the credit"):
        announce(sender, jpeg, captured_s=9.0)
    # Each received image grants one more, as soon as it is acknowledged.
    assert sender.update_credit(9.0).credit == 2 * MAX_IMAGES_IN_FLIGHT
    announce(sender, jpeg, captured_s=9.0)


def without_clock() -> Sender:
    sender = Sender()
    sender.update_credit(0.0)
    sender.receive_text(said(camera=CAMERA), 0.0)
    return sender


def without_camera() -> Sender:
    sender = Sender()
    pong(sender, sent_s=0.0)
    return sender


def in_an_image() -> Sender:
    sender = introduced()
    announce(sender, jpeg_of(90), captured_s=1.0)
    return sender


IMAGE = {"bytes": 1000, "captured_ms": 1.0, "clock": "capture"}


@pytest.mark.parametrize(
    ("begin", "text", "code", "why"),
    [
        pytest.param(introduced, "{", 1008, "invalid message", id="no-json"),
        pytest.param(introduced, "[" * 1000, 1008, "invalid message", id="deep"),
        pytest.param(introduced, "{}", 1008, "exactly one", id="nothing"),
        pytest.param(introduced, '{"image": null}', 1008, "exactly one", id="null"),
        pytest.param(introduced, said(camera=CAMERA, image=IMAGE), 1008, "exactly one", id="two-at-once"),
        pytest.param(introduced, said(image=IMAGE | {"rows": 3}), 1008, "Extra", id="more-than-asked"),
        pytest.param(introduced, '{"pong": {"ping": 0, "at_ms": Infinity}}', 1008, "finite", id="for-ever"),
        pytest.param(introduced, said(image=IMAGE | {"captured_ms": "1"}), 1008, "number", id="no-number"),
        pytest.param(introduced, said(hello={"key": "0" * 32}), 1008, "once", id="hello-twice"),
        pytest.param(
            introduced, said(pong={"ping": 0, "at_ms": 1.0}), 1008, "already answered", id="pong-twice"
        ),
        pytest.param(introduced, said(pong={"ping": 9, "at_ms": 1.0}), 1008, "never sent", id="unknown-ping"),
        pytest.param(introduced, "x" * 1025, 1009, "1024", id="too-long"),
        pytest.param(
            introduced,
            said(image=IMAGE | {"bytes": MAX_JPEG_BYTES + 1}),
            1009,
            "the maximum is",
            id="oversized",
        ),
        pytest.param(without_clock, said(image=IMAGE), 1008, "ping", id="before-its-clock-is-known"),
        pytest.param(without_camera, said(image=IMAGE), 1008, "camera", id="before-its-camera-is-known"),
        pytest.param(in_an_image, said(image=IMAGE), 1008, "0 of", id="in-the-middle-of-another"),
    ],
)
def test_what_is_not_understood_or_not_due_ends_the_connection(
    begin: Callable[[], Sender], text: str, code: int, why: str
) -> None:
    sender = begin()
    with pytest.raises(ProtocolViolation, match=why) as reported:
        sender.receive_text(text, 1.0)
    assert reported.value.code == code


@pytest.mark.parametrize(
    ("begin", "part"),
    [
        pytest.param(introduced, b"x", id="that-nobody-announced"),
        pytest.param(in_an_image, b"x" * 100_000, id="longer-than-announced"),
        pytest.param(in_an_image, b"", id="of-nothing"),
    ],
)
def test_a_part_that_cannot_be_ends_the_connection(begin: Callable[[], Sender], part: bytes) -> None:
    with pytest.raises(ProtocolViolation):
        begin().take_part(part, 1.0)


def test_the_first_message_is_hello() -> None:
    assert parse_hello(said(hello={"key": "0123456789abcdef" * 2})).key.startswith("0123")
    for text in (said(camera=CAMERA), said(hello={"key": "short"})):
        with pytest.raises(ProtocolViolation):
            parse_hello(text)


@pytest.mark.parametrize(
    ("down_s", "up_s"),
    [
        pytest.param([0.005] * 5, [0.005] * 5, id="a-quick-line"),
        pytest.param([0.003, 0.2, 0.08], [0.2, 0.003, 0.3], id="each-way-quick-once"),
        pytest.param([0.004] * 3, [0.9] * 3, id="large-images-on-the-way-back"),
        pytest.param([0.3] * 3, [0.002] * 3, id="slow-on-the-way-there"),
    ],
)
def test_a_capture_is_never_later_than_it_was_and_the_error_is_stated(
    down_s: list[float], up_s: list[float]
) -> None:
    clock = PageClock()
    for number, (down, up) in enumerate(zip(down_s, up_s, strict=True)):
        clock.take(sent_s=number, page_s=number + down + AHEAD_S, received_s=number + down + up)
    captured_at_s = clock.captured_at_s(1.0 + AHEAD_S)
    assert captured_at_s <= 1.0 + 1e-9
    assert captured_at_s == pytest.approx(1.0 - min(down_s))
    assert captured_at_s + clock.error_s >= 1.0 - 1e-9


def test_a_page_whose_clock_stood_still_is_taken_at_its_new_word() -> None:
    clock = PageClock()
    for number in range(3):
        clock.take(sent_s=number, page_s=number + 0.005 + AHEAD_S, received_s=number + 0.01)
    # The device slept for three seconds, and its clock with it.
    clock.take(sent_s=9.0, page_s=6.005 + AHEAD_S, received_s=9.01)
    assert clock.captured_at_s(7.0 + AHEAD_S) == pytest.approx(10.0, abs=0.006)
    # A clock that jumps ahead makes nothing look younger.
    clock.take(sent_s=11.0, page_s=20.005 + AHEAD_S, received_s=11.01)
    assert clock.captured_at_s(21.0 + AHEAD_S) == pytest.approx(12.0, abs=0.006)


def test_clocks_that_drift_apart_are_followed() -> None:
    clock, faster = PageClock(), 1.0 + 1e-4
    for number in range(100):
        at_s = float(number)
        clock.take(sent_s=at_s, page_s=at_s * faster + 0.1 + AHEAD_S, received_s=at_s + 0.2)
    captured_at_s = clock.captured_at_s(99.0 * faster + AHEAD_S)
    # Of the total drift (10 ms) only the part within the window remains.
    assert captured_at_s == pytest.approx(99.0 - 0.1, abs=0.0011)
