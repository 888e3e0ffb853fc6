"""`/ws/camera` over HTTP: one sender, its images in the inbox, and rejected clients."""

import json
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

import pytest
from fastapi.testclient import TestClient
from starlette.testclient import WebSocketTestSession
from starlette.websockets import WebSocketDisconnect

from server.app import AppParts, create_app
from server.capture.local_camera import CalibratedCamera
from server.capture.phone import PhoneImage, PhoneUpdate
from server.config import CameraConfig, Config
from server.live import ImageClock, LiveHub, Problem, SourceState, SourceStatus
from server.loop.phone_inbox import PhoneInbox
from server.security import Person, Role
from server.stream.phone import socket as phone_socket
from server.stream.phone.receiver import MAX_AGE_S, PhoneTaken, Receiver
from server.stream.phone.sender import Received
from tests.server.capture.fake_phone import CAMERA, jpeg_of
from tests.server.stream.test_phone_sender import CAMERA as CAMERA_SAID
from tracker.camera import CameraControl

# The server sends at least twice a second.
MAX_MESSAGES = 20
KEY, OTHER_KEY = "0" * 32, "1" * 32
ITO = Person(id="ito", name="Dr. Ito", role=Role.OPERATOR)
GUEST = Person(id="guest", name="Guest", role=Role.CAMERA)
SETTINGS = CameraConfig(source="phone")
CAMERA_WITHOUT_ZOOM = replace(CAMERA, zoom_percent=None)


@pytest.fixture
def inbox() -> Iterator[PhoneInbox]:
    inbox = PhoneInbox()
    yield inbox
    inbox.close()


@pytest.fixture
def receiver(inbox: PhoneInbox) -> Receiver:
    return Receiver(inbox, SETTINGS)


@pytest.fixture
def door(hub: LiveHub, receiver: Receiver, monkeypatch: pytest.MonkeyPatch) -> Iterator[TestClient]:
    # A busy machine delays the messages of this test, too.
    monkeypatch.setattr(phone_socket, "SILENT_AFTER_S", 60.0)
    app = create_app(AppParts(hub=hub, config=Config(camera=SETTINGS), phone=receiver))
    with TestClient(app, base_url="http://127.0.0.1:8000") as client:
        yield client


def connected(client: TestClient) -> WebSocketTestSession:
    return client.websocket_connect("ws://127.0.0.1:8000/ws/camera")


class Phone:
    """A sending page as seen by the server. Its clock is this machine's."""

    def __init__(self, socket: WebSocketTestSession, key: str = KEY) -> None:
        self.socket = socket
        self.credit = 0
        self.say(hello={"key": key})

    def say(self, **message: object) -> None:
        self.socket.send_text(json.dumps(message))

    def reported(self, what: str) -> dict[str, Any]:
        """The next message of this kind; pings before it are answered."""
        for _ in range(MAX_MESSAGES):
            message = self.socket.receive_json()
            if "note" in message:
                self.credit = message["note"]["credit"]
                self.say(pong={"ping": message["note"]["ping"], "at_ms": time.monotonic() * 1000.0})
            if what in message:
                reported: dict[str, Any] = message[what]
                return reported
        pytest.fail(f"the server says no {what}")

    def note_after(self, images: int) -> dict[str, Any]:
        """The note with this image count."""
        for _ in range(MAX_MESSAGES):
            if (note := self.reported("note"))["images"] >= images:
                return note
        pytest.fail(f"no {images} images were handed on")

    def problem(self) -> dict[str, Any]:
        """The next note with a problem."""
        for _ in range(MAX_MESSAGES):
            if (note := self.reported("note"))["problem"] is not None:
                return note
        pytest.fail("nothing is said to be wrong")

    def begin(self) -> dict[str, Any]:
        welcome = self.reported("welcome")
        self.reported("note")
        self.say(camera=CAMERA_SAID)
        return welcome

    def send(self, jpeg: bytes, *, age_s: float = 0.0) -> None:
        captured_ms = (time.monotonic() - age_s) * 1000.0
        self.say(image={"bytes": len(jpeg), "captured_ms": captured_ms, "clock": "capture"})
        self.socket.send_bytes(jpeg)


def ending(socket: WebSocketTestSession) -> WebSocketDisconnect:
    """Close code and reason, skipping earlier messages."""
    for _ in range(MAX_MESSAGES):
        try:
            socket.receive_json()
        except WebSocketDisconnect as ended:
            return ended
    pytest.fail("the server does not end it")


def newest(inbox: PhoneInbox) -> PhoneUpdate:
    entry = inbox.newest()
    assert entry is not None
    return entry[1]


def test_images_reach_the_inbox_with_their_time_and_each_one_grants_the_next(
    door: TestClient, inbox: PhoneInbox
) -> None:
    with connected(door) as socket:
        phone = Phone(socket)
        welcome = phone.begin()
        assert (welcome["width_px"], welcome["height_px"], welcome["rate_hz"]) == (1280, 720, 30.0)
        before_s = time.monotonic()
        for number in range(5):
            phone.send(jpeg_of(100 + number))
            note = phone.note_after(number + 1)
            assert note["credit"] == number + 1 + 2
        image = newest(inbox).image
        assert isinstance(image, PhoneImage)
        assert image.jpeg == jpeg_of(104)
        assert (image.number, image.clock, image.camera) == (4, ImageClock.BROWSER, CAMERA_WITHOUT_ZOOM)
        assert before_s - 5.0 < image.captured_at_s <= time.monotonic()
        assert note["delay_ms"] >= 0.0
        assert note["problem"] is None
    # The page is closed: nobody is connected, which is reported at once.
    assert newest(inbox) == PhoneUpdate(sender="")


def test_a_page_hears_what_the_server_has_against_its_images(
    door: TestClient, inbox: PhoneInbox, hub: LiveHub, instant_of: Callable[..., Any]
) -> None:
    with connected(door) as socket:
        phone = Phone(socket)
        phone.begin()
        phone.send(b"no picture")
        assert phone.problem()["problem"]["code"] == "PHONE_IMAGE_BROKEN"
        reported = newest(inbox)
        assert reported.problem is not None
        assert (reported.image, reported.problem.code) == (None, "PHONE_IMAGE_BROKEN")
        phone.send(jpeg_of(80))
        assert phone.note_after(1)["problem"] is None
        problem = Problem(code="PHONE_FOCUS_NOT_LOCKED", message="it is not", remedy="None.")
        hub.publish(
            instant_of(1, source=SourceStatus(name="phone", state=SourceState.RUNNING, problem=problem))
        )
        note = phone.problem()
        assert (note["problem"]["code"], note["source_state"]) == ("PHONE_FOCUS_NOT_LOCKED", "running")


def test_a_second_device_is_rejected_with_a_sentence_and_the_first_goes_on(
    door: TestClient, inbox: PhoneInbox
) -> None:
    with connected(door) as socket:
        phone = Phone(socket)
        phone.begin()
        with connected(door) as second:
            rejected = Phone(second, OTHER_KEY).reported("rejected")
            assert rejected["code"] == "PHONE_TAKEN"
            assert "STOP" in rejected["remedy"]
            assert ending(second).code == 1008
        phone.send(jpeg_of(50))
        phone.note_after(1)
        assert newest(inbox).sender
    with connected(door) as socket:
        assert Phone(socket, OTHER_KEY).begin()


def test_the_page_that_lost_its_connection_gets_its_slot_back(door: TestClient, inbox: PhoneInbox) -> None:
    # Its first connection is half-open: the server has not noticed its end.
    with connected(door) as hanging, connected(door) as socket:
        first = Phone(hanging)
        first.begin()
        again = Phone(socket)
        again.begin()
        assert ending(hanging).code == phone_socket.REPLACED
        again.send(jpeg_of(50))
        again.note_after(1)
        # The end of the first connection has not released the second one's place.
        assert newest(inbox).sender


def test_a_page_of_which_nothing_comes_is_gone(
    door: TestClient, inbox: PhoneInbox, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(phone_socket, "SILENT_AFTER_S", 0.05)
    with connected(door) as socket:
        socket.send_text(json.dumps({"hello": {"key": KEY}}))
        assert ending(socket).code == 1013
    assert newest(inbox) == PhoneUpdate(sender="")


def test_a_page_that_misbehaves_is_reported_and_its_slot_is_free(door: TestClient, inbox: PhoneInbox) -> None:
    with connected(door) as socket:
        phone = Phone(socket)
        phone.begin()
        socket.send_bytes(b"x")
        ended = ending(socket)
        assert (ended.code, "announced" in ended.reason) == (1008, True)
    assert newest(inbox) == PhoneUpdate(sender="")


def test_a_server_with_another_camera_states_how_to_start_it(client: TestClient) -> None:
    with connected(client) as socket:
        rejected = socket.receive_json()["rejected"]
    assert rejected["code"] == "PHONE_NOT_SELECTED"
    assert "rehearsal" in rejected["message"]
    assert "--source phone" in rejected["remedy"]


def received(captured_at_s: float, age_s: float = 0.05) -> Received:
    return Received(
        jpeg=jpeg_of(1),
        captured_at_s=captured_at_s,
        arrived_s=captured_at_s + age_s,
        clock=ImageClock.BROWSER,
        camera=CAMERA,
    )


@pytest.mark.parametrize(
    ("second", "code"),
    [
        pytest.param(received(10.1), None, id="newer"),
        pytest.param(received(10.0), "PHONE_IMAGE_REPEATED", id="the-same-again"),
        pytest.param(received(9.9), "PHONE_IMAGE_REPEATED", id="older"),
        pytest.param(received(10.1, MAX_AGE_S + 0.1), "PHONE_IMAGE_OLD", id="too-long-on-its-way"),
    ],
)
def test_an_old_image_is_not_handed_on(
    receiver: Receiver, inbox: PhoneInbox, second: Received, code: str | None
) -> None:
    with receiver.sending(KEY, ITO) as place:
        receiver.deliver(place, received(10.0))
        receiver.deliver(place, second)
        reported = newest(inbox)
        assert (reported.image is None) == (code is not None)
        assert (None if place.problem is None else place.problem.code) == code


def test_an_image_of_a_connection_that_was_replaced_is_not_handed_on(
    receiver: Receiver, inbox: PhoneInbox
) -> None:
    with receiver.sending(KEY, ITO) as before, receiver.sending(KEY, ITO):
        assert before.replaced.is_set()
        receiver.deliver(before, received(10.0))
        assert newest(inbox) == PhoneUpdate(sender="Dr. Ito")


def test_a_key_alone_does_not_replace_a_sender(receiver: Receiver) -> None:
    with receiver.sending(KEY, ITO), pytest.raises(PhoneTaken, match="Ito"), receiver.sending(KEY, GUEST):
        pass


def test_a_page_is_requested_to_use_the_settings_of_the_calibration(inbox: PhoneInbox) -> None:
    calibrated = CalibratedCamera(size_wh_px=(1920, 1080), controls={CameraControl.FOCUS: 430})
    receiver = Receiver(inbox, SETTINGS)
    receiver.calibrated = calibrated
    welcome = receiver.welcome()
    assert (welcome.width_px, welcome.height_px, welcome.focus_mm, welcome.lock_focus) == (
        1920,
        1080,
        430,
        True,
    )
    settings = CameraConfig(source="phone", width=640, height=480, rate_hz=15.0, lock_controls=False)
    receiver = Receiver(inbox, settings)
    receiver.calibrated = calibrated
    welcome = receiver.welcome()
    assert (welcome.width_px, welcome.height_px, welcome.rate_hz, welcome.lock_focus) == (
        640,
        480,
        15.0,
        False,
    )
