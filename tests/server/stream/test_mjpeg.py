"""MJPEG from a real server: immediate, current, never frozen; a stalled viewer costs nothing."""

import dataclasses
import http.client
import json
import re
import socket
import time
from collections.abc import Callable, Iterator
from typing import Any

import cv2
import numpy as np
import pytest
from fastapi import FastAPI

from server.live import Instant, LiveHub, ProcessState, ProcessStatus
from server.stream import mjpeg
from server.stream.mjpeg import Video, with_comment
from server.stream.scaling.picture_cache import PictureCache
from server.stream.scaling.sizes import SizeChoice
from server.stream.viewers import ViewerKind, Viewers
from tests.server.stream.simulated_time import LoopTime, run_in_made_time

LiveInstant = Callable[..., Instant]
Serve = Callable[[FastAPI], int]
PART_HEAD = b"--coaxial\r\nContent-Type: image/jpeg\r\n\r\n"
DEADLINE_S = 60.0


class MotionMonitor:
    """A viewer of the MJPEG stream that checks each byte."""

    def __init__(self, port: int, query: str = "") -> None:
        self._connection = http.client.HTTPConnection("127.0.0.1", port, timeout=DEADLINE_S)
        self._connection.request("GET", f"/video/main.mjpg{query}")
        self.response = self._connection.getresponse()
        assert self.response.read(len(PART_HEAD)) == PART_HEAD

    def picture(self) -> tuple[dict[str, Any], bytes]:
        """The metadata in the comment of the next JPEG, and the JPEG without it.

        Reads up to the header of the next part and no further: that header must follow directly.

        """
        data = b""
        while not data.endswith(b"\r\n" + PART_HEAD):
            data += self.response.read(1)
        return facts_in(data[: -len(b"\r\n" + PART_HEAD)])

    def close(self) -> None:
        self._connection.close()


def facts_in(jpeg: bytes) -> tuple[dict[str, Any], bytes]:
    """The metadata in the comment of a JPEG, and the JPEG without it."""
    found = re.search(rb"\xff\xfe(..)(\{.*?\})", jpeg, re.DOTALL)
    assert found is not None
    return json.loads(found[2]), jpeg[: found.start()] + jpeg[found.end() :]


@pytest.fixture
def port(patient_app: FastAPI, serve: Serve) -> int:
    return serve(patient_app)


@pytest.fixture
def watch(port: int) -> Iterator[Callable[..., MotionMonitor]]:
    watching: list[MotionMonitor] = []

    def start(query: str = "") -> MotionMonitor:
        watching.append(MotionMonitor(port, query))
        return watching[-1]

    yield start
    for one in watching:
        one.close()


def metric(port: int, name: str) -> float:
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=DEADLINE_S)
    connection.request("GET", "/metrics")
    lines = connection.getresponse().read().decode().splitlines()
    connection.close()
    return next((float(line.split()[-1]) for line in lines if line.startswith(name)), 0.0)


def received_until_cut(line: socket.socket) -> int:
    """Number of bytes until the connection ends."""
    total = 0
    try:
        while received := line.recv(1 << 20):
            total += len(received)
    except ConnectionResetError:
        pass
    return total


def test_a_late_joiner_sees_the_newest_image_as_it_was_published(
    hub: LiveHub, live_instant: LiveInstant, watch: Callable[[], MotionMonitor]
) -> None:
    instant = live_instant(3)
    hub.publish(live_instant(2))
    hub.publish(instant)
    viewer = watch()
    facts, jpeg = viewer.picture()
    assert facts["image_number"] == 1003
    assert facts["age_ms"] >= 0.0
    assert jpeg == instant.jpeg
    assert viewer.response.headers["Content-Type"] == "multipart/x-mixed-replace; boundary=coaxial"
    assert "no-store" in viewer.response.headers["Cache-Control"]


def test_each_viewer_gets_the_same_bytes(
    hub: LiveHub, live_instant: LiveInstant, watch: Callable[[], MotionMonitor]
) -> None:
    hub.publish(live_instant(1))
    one, other = watch(), watch()
    assert one.picture()[1] == other.picture()[1]
    instant = live_instant(2)
    hub.publish(instant)
    assert one.picture()[1] == other.picture()[1] == instant.jpeg


def test_a_viewer_gets_the_size_that_it_asks_for(
    hub: LiveHub, live_instant: LiveInstant, watch: Callable[..., MotionMonitor]
) -> None:
    hub.publish(live_instant(1))
    for query, ratio, width_px in (("", 1.0, 160), ("?size=half", 0.5, 80), ("?size=quarter", 0.25, 40)):
        facts, jpeg = watch(query).picture()
        assert facts["shown_scale_ratio"] == ratio
        decoded = cv2.imdecode(np.frombuffer(jpeg, np.uint8), cv2.IMREAD_COLOR)
        assert decoded is not None
        assert decoded.shape[1] == width_px


def test_before_the_first_image_a_card_is_shown_and_then_the_image(
    hub: LiveHub, live_instant: LiveInstant, watch: Callable[[], MotionMonitor]
) -> None:
    viewer = watch()
    assert viewer.picture()[0] == {"image_number": None}
    hub.publish(live_instant(0))
    while (shown := viewer.picture()[0]["image_number"]) is None:
        pass
    assert shown == 1000


def test_when_tracking_dies_a_card_replaces_the_last_image(
    hub: LiveHub, live_instant: LiveInstant, instant_of: LiveInstant, watch: Callable[[], MotionMonitor]
) -> None:
    hub.publish(live_instant(0))
    viewer = watch()
    assert viewer.picture()[0]["image_number"] == 1000
    hub.publish(instant_of(1, process=ProcessStatus(state=ProcessState.RESTARTING)))
    assert viewer.picture()[0] == {"image_number": None}


def test_a_card_replaces_the_last_image_when_messages_stop(
    live_instant: LiveInstant, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(mjpeg, "time", LoopTime)
    viewers, hub, said = Viewers(), LiveHub(), live_instant(0)
    assert said.snapshot is not None
    # 30 ms old on arrival: at the viewer's timeout it is older than 500 ms.
    snapshot = dataclasses.replace(said.snapshot, captured_at_s=-0.03)
    video = Video(hub=hub, viewers=viewers, pictures=PictureCache(quality=80), stale_after_ms=500.0)
    came: list[tuple[float, int | None]] = []

    async def run() -> None:
        hub.publish(dataclasses.replace(said, snapshot=snapshot))
        with viewers.register(ViewerKind.MJPEG, SizeChoice.AUTO) as viewer:
            async for picture in video.pictures(viewer):
                came.append((LoopTime.monotonic(), facts_in(picture)[0]["image_number"]))
                if len(came) == 3:
                    break

    run_in_made_time(run())
    assert came == [(0.0, 1000), (pytest.approx(0.5), None), (pytest.approx(1.5), None)]


def test_a_stalled_viewer_is_disconnected_and_delays_no_other(
    hub: LiveHub, live_instant: LiveInstant, port: int, watch: Callable[[], MotionMonitor]
) -> None:
    noise = np.random.default_rng(1).integers(0, 255, 400_000, dtype=np.uint8).tobytes()
    sequence = 0

    def publish() -> None:
        nonlocal sequence
        sequence += 1
        hub.publish(live_instant(sequence, jpeg=b"\xff\xd8" + noise.replace(b"\xff", b"\x00")))

    publish()
    with socket.socket() as stalled:
        stalled.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        stalled.connect(("127.0.0.1", port))
        stalled.sendall(b"GET /video/main.mjpg HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n")
        deadline = time.monotonic() + DEADLINE_S
        while metric(port, 'coaxial_viewer_let_go_total{kind="mjpeg"}') == 0.0:
            publish()
            assert time.monotonic() < deadline
        # Its connection is closed for good: pending data is dropped.
        assert received_until_cut(stalled) < 2 * len(noise)
        assert metric(port, 'coaxial_viewers{kind="mjpeg"}') == 0.0
    publish()
    assert watch().response.status == 200


def test_a_viewer_that_goes_is_forgotten(
    hub: LiveHub, live_instant: LiveInstant, port: int, watch: Callable[[], MotionMonitor]
) -> None:
    hub.publish(live_instant(0))
    viewer = watch()
    viewer.picture()
    assert metric(port, 'coaxial_viewers{kind="mjpeg"}') == 1.0
    viewer.response.close()
    viewer.close()
    deadline = time.monotonic() + DEADLINE_S
    while metric(port, 'coaxial_viewers{kind="mjpeg"}') > 0.0:
        assert time.monotonic() < deadline


def test_a_comment_does_not_touch_the_picture() -> None:
    jfif = b"\xff\xd8\xff\xe0\x00\x04ab" + b"rest"
    assert with_comment(jfif, {"n": 1}) == b'\xff\xd8\xff\xe0\x00\x04ab\xff\xfe\x00\x09{"n":1}rest'
    assert with_comment(b"\xff\xd8rest", {}) == b"\xff\xd8\xff\xfe\x00\x04{}rest"
