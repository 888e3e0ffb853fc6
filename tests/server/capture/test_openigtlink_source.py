"""An external tracker by OpenIGTLink: a server of pyigtl, and others that send what they must not."""

import signal
import socket
import threading
from collections.abc import Iterator
from contextlib import closing, contextmanager
from itertools import count

import numpy as np
import pyigtl
import pytest

from server import openigtlink_wire as wire
from server.capture import openigtlink
from server.capture.address import source_from_text
from server.capture.openigtlink import OpenIgtLinkSource
from server.capture.shot import Shot
from server.config import ExternalTrackerConfig
from server.errors import CaptureError
from server.openigtlink_wire import Message
from tests.server.capture.test_pose_frames import DRILL, PATIENT, T_S, at, tracking_data, transform

NAMES = [DRILL, PATIENT]


class Tracker:
    """The source, and the sockets of a server that this test writes to by itself."""

    def __init__(self) -> None:
        self.now_s = 50.0
        self.listener = socket.create_server(("127.0.0.1", 0))
        self.source = source(self.listener.getsockname()[1], clock=lambda: self.now_s)
        self.source.open()
        self.peer, _ = self.listener.accept()

    def send(self, *messages: Message, now_s: float) -> Shot:
        """The poses after these messages, which arrive at this time."""
        self.now_s = now_s
        self.peer.sendall(b"".join(wire.pack(one, version=2) for one in messages))
        return read(self.source)

    def close(self) -> None:
        for one in (self.source, self.peer, self.listener):
            one.close()


def source(port: int, **options: object) -> OpenIgtLinkSource:
    settings = ExternalTrackerConfig(port=port, transforms=NAMES, sd_mm=0.2, sd_deg=0.3, latency_ms=40.0)
    return OpenIgtLinkSource(
        source_from_text("openigtlink"),
        settings=settings,
        stop=threading.Event(),
        first_number=0,
        **options,  # pyrefly: ignore[bad-argument-type]  # a clock
    )


def read(source: OpenIgtLinkSource) -> Shot:
    shot = source.read()
    assert shot is not None
    return shot


@contextmanager
def pyigtl_server() -> Iterator[pyigtl.OpenIGTLinkServer]:
    before = {one: signal.getsignal(one) for one in (signal.SIGTERM, signal.SIGINT)}
    server = pyigtl.OpenIGTLinkServer(port=0)
    try:
        yield server
    finally:
        server.stop()
        for number, handler in before.items():
            signal.signal(number, handler)


@pytest.mark.parametrize("version", [1, 2])
def test_poses_of_pyigtl_arrive_with_the_direction_and_unit_that_they_have(
    version: int,
) -> None:
    with pyigtl_server() as server, closing(source(server.server_address[1])) as tracker:
        tracker.open()
        for name, x_mm in ((DRILL, 5.0), (PATIENT, 7.0)):
            one = pyigtl.TransformMessage(at(x_mm), device_name=name, timestamp=T_S)
            one.header_version = version
            server.send_message(one, wait=False)
        shot = read(tracker)
    assert shot.poses is not None
    # By hand: a quarter turn about z takes x to y, and then moves by (5, 2, 3) mm.
    np.testing.assert_allclose(shot.poses[DRILL].move_points(np.array([1.0, 0.0, 0.0])), [5.0, 3.0, 3.0])
    np.testing.assert_allclose(shot.poses[PATIENT].move_points(np.zeros(3)), [7.0, 2.0, 3.0])


def test_a_pose_has_the_time_of_its_measurement_however_late_it_arrives() -> None:
    with closing(Tracker()) as tracker:
        captured = []
        for n, delay_s in enumerate([0.015, 0.005, 0.105]):
            moment = tracking_data({DRILL: at(n), PATIENT: at(-n)}, T_S + 0.02 * n)
            captured.append(tracker.send(moment, now_s=60.0 + 0.02 * n + delay_s).captured_at_s)
    # The stated latency of 40 ms is that of the fastest message, which is the second one from then on.
    assert captured == pytest.approx([60.015 - 0.04, 60.025 - 0.04, 60.045 - 0.04], abs=1e-6)


def test_poses_that_all_arrive_late_for_longer_than_the_window_are_not_shown_as_new() -> None:
    with closing(Tracker()) as tracker:
        ages_s = list[float]()

        def send_all() -> None:
            for n in range(100):
                moment = tracking_data({DRILL: at(n), PATIENT: at(-n)}, T_S + 0.5 * n)
                # The clock of Plus also drifts, by as much as a crystal may.
                now_s = 60.0 + 0.5 * n * (1.0 + 5e-5) + (1.0 if n > 40 else 0.0)
                ages_s.append(now_s - tracker.send(moment, now_s=now_s).captured_at_s)

        with pytest.raises(CaptureError, match="arrive 1000 ms later") as late:
            send_all()
    assert late.value.code == "TRACKER_LATE"
    # For as long as the window has a message from before, their age was right.
    assert len(ages_s) > 55
    assert min(ages_s[41:]) >= 1.0


GOOD = wire.pack(transform(DRILL, at(5)), version=2)


@pytest.mark.parametrize(
    ("sent", "reason"),
    [
        (b"HTTP/1.1 200 OK\r\n" + bytes(60), "header version"),
        (wire.HEADER.pack(2, b"IMAGE", b"Image", 0, 0, 2**20, 0), "IMAGE has 1048576 bytes"),
        (GOOD[:-1] + bytes([GOOD[-1] ^ 1]), "checksum"),
        (wire.pack(transform(DRILL, at(5) @ np.diag([1, -1, 1, 1])), version=1), "not a rigid"),
        (
            wire.pack(Message(type="TDATA", device="Plus", timestamp_s=T_S, content=bytes(69)), version=1),
            "69 bytes",
        ),
        (
            wire.HEADER.pack(2, b"TDATA", b"", 0, 0, 1, wire.crc64(b"\1")) + b"\1",
            "extended header",
        ),
    ],
    ids=["another protocol", "too long", "damaged", "mirrored", "cut", "no metadata"],
)
def test_what_is_no_message_ends_the_connection_with_its_reason(sent: bytes, reason: str) -> None:
    with closing(Tracker()) as tracker:
        tracker.peer.sendall(sent + wire.pack(transform(PATIENT, at(7)), version=1))
        with pytest.raises(CaptureError, match=reason) as rejected:
            tracker.source.read()
    assert rejected.value.code == "TRACKER_MESSAGE_INVALID"


def test_a_tracker_that_closes_is_silent_or_gone_is_named_and_a_new_connection_starts_afresh(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(openigtlink, "POLL_S", 0.001)
    with closing(Tracker()) as tracker:
        tracker.send(tracking_data({DRILL: at(1), PATIENT: at(2)}), now_s=60.0)
        ticks = count()
        tracker.source._clock = lambda: 60.0 + next(ticks)
        # A time that does not go on is no new pose.
        tracker.peer.sendall(wire.pack(tracking_data({DRILL: at(3), PATIENT: at(4)}), version=2))
        with pytest.raises(CaptureError) as silent:
            tracker.source.read()
        tracker.source._clock = lambda: tracker.now_s
        tracker.source.open()
        tracker.peer.close()
        tracker.peer, _ = tracker.listener.accept()
        # The clock of a restarted sender may have been set back.
        shot = tracker.send(tracking_data({DRILL: at(3), PATIENT: at(4)}, T_S - 900.0), now_s=70.0)
        assert shot.captured_at_s == pytest.approx(70.0 - 0.04)
        tracker.peer.close()
        with pytest.raises(CaptureError) as closed:
            tracker.source.read()
        tracker.listener.close()
        with pytest.raises(CaptureError) as gone:
            tracker.source.open()
    codes = [one.value.code for one in (silent, closed, gone)]
    assert codes == ["TRACKER_SILENT", "TRACKER_CLOSED", "TRACKER_UNREACHABLE"]


def test_plus_is_asked_for_metadata_and_tracking_data() -> None:
    with closing(Tracker()) as tracker:
        requests = list(wire.MessageReader(max_body_bytes=100).feed(tracker.peer.recv(1000)))
    kinds = [one.type for one in requests if isinstance(one, Message)]
    assert kinds == ["GET_STATUS", "STT_TDATA"]
