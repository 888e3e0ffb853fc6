"""`/ws/view`: image and pose of one instant in one message, on request only."""

import dataclasses
import json
import struct
from collections.abc import Callable
from typing import Any

import cv2
import numpy as np
import pytest
from fastapi.testclient import TestClient
from starlette.testclient import WebSocketTestSession
from starlette.websockets import WebSocketDisconnect

from server.live import Instant, LiveHub
from server.stream.view_socket import ImagePace, ViewRequests
from server.stream.viewers import Viewer, ViewerKind
from tracker.navigation import NavigationSnapshot

LiveInstant = Callable[..., Instant]
OpenSocket = Callable[..., WebSocketTestSession]


def unpacked(message: bytes) -> tuple[dict[str, Any], bytes]:
    (length,) = struct.unpack_from("<I", message)
    return json.loads(message[4 : 4 + length]), message[4 + length :]


def test_an_image_and_its_pose_come_in_one_message(
    open_socket: OpenSocket, hub: LiveHub, live_instant: LiveInstant
) -> None:
    instant = live_instant(5)
    hub.publish(instant)
    with open_socket("/ws/view?camera=main") as socket:
        socket.send_text('{"next": true}')
        header, jpeg = unpacked(socket.receive_bytes())
    assert header["sequence"] == 5
    assert header["snapshot"]["image_number"] == 1005
    # The published bytes: nothing is encoded again.
    assert jpeg == instant.jpeg


def test_each_image_is_requested_and_is_the_newest_then(
    client: TestClient, open_socket: OpenSocket, hub: LiveHub, live_instant: LiveInstant
) -> None:
    hub.publish(live_instant(0))
    with open_socket("/ws/view") as socket:
        socket.send_text('{"next": true}')
        assert unpacked(socket.receive_bytes())[0]["sequence"] == 0
        # 1 and 2 were not requested and are never sent.
        for sequence in (1, 2, 3):
            hub.publish(live_instant(sequence))
        socket.send_text('{"next":true}')
        assert unpacked(socket.receive_bytes())[0]["sequence"] == 3
        # Requested before there is a newer one: the answer arrives with it.
        socket.send_text('{"next": true}')
        hub.publish(live_instant(4))
        assert unpacked(socket.receive_bytes())[0]["sequence"] == 4
    assert 'coaxial_viewer_dropped_total{kind="view"} 2.0' in client.get("/metrics").text


def test_an_instant_without_image_comes_with_an_empty_jpeg(
    open_socket: OpenSocket, hub: LiveHub, instant_of: LiveInstant
) -> None:
    hub.publish(instant_of(9))
    with open_socket("/ws/view") as socket:
        socket.send_text('{"next": true}')
        header, jpeg = unpacked(socket.receive_bytes())
    assert header["snapshot"] is None
    assert jpeg == b""


@pytest.mark.parametrize(
    ("said", "code", "reason"),
    [
        pytest.param("next", 1008, "only {", id="no-json"),
        pytest.param('{"next": false}', 1008, "only {", id="another-value"),
        pytest.param('{"next": true, "camera": "x"}', 1008, "only {", id="more-than-asked"),
        pytest.param('{"next": true, "showing_ms": -1}', 1008, "only {", id="before-it-came"),
        pytest.param('{"next": true, "showing_ms": "12"}', 1008, "only {", id="no-number"),
        pytest.param('{"next": true, "showing_ms": true}', 1008, "only {", id="a-truth-value"),
        pytest.param('{"next": true, "showing_ms": Infinity}', 1008, "only {", id="for-ever"),
        pytest.param(f'{{"next": true, "showing_ms": 1{"0" * 400}}}', 1008, "only {", id="no-float"),
        pytest.param('{"interval_ms": 1001}', 1008, "interval_ms", id="too-seldom"),
        pytest.param('{"interval_ms": NaN}', 1008, "interval_ms", id="no-interval"),
        pytest.param('{"largest": "auto"}', 1008, "only {", id="largest-of-all"),
        pytest.param('{"size": "tiny"}', 1008, "only {", id="unknown-size"),
        pytest.param('{"size": ["full"]}', 1008, "only {", id="sizes"),
        pytest.param("[" * 1000, 1008, "only {", id="deep"),
        pytest.param("x" * 1025, 1009, "1024", id="too-long"),
        pytest.param(b"\x00", 1008, "text", id="binary"),
    ],
)
def test_anything_else_ends_with_a_reason(
    open_socket: OpenSocket, said: str | bytes, code: int, reason: str
) -> None:
    with open_socket("/ws/view") as socket:
        if isinstance(said, bytes):
            socket.send_bytes(said)
        else:
            socket.send_text(said)
        with pytest.raises(WebSocketDisconnect) as reported:
            socket.receive_bytes()
    assert reported.value.code == code
    assert reason in reported.value.reason


@pytest.mark.parametrize(
    ("interval_ms", "expected"),
    [
        (0.0, [0, 1, 2, 3, 4, 5, 6, 7, 8]),
        (50.0, [0, 2, 3, 5, 6, 8]),
        (60.0, [0, 2, 4, 6, 8]),
        (120.0, [0, 4, 8]),
    ],
)
def test_images_are_as_far_apart_as_asked_on_average(
    instant_of: LiveInstant,
    snapshot_of: Callable[..., NavigationSnapshot],
    interval_ms: float,
    expected: list[int],
) -> None:
    pace = ImagePace()
    pace.interval_s = interval_ms / 1000.0
    images = [instant_of(n, snapshot=snapshot_of(image_number=n, captured_at_s=n / 30.0)) for n in range(9)]
    assert [image.sequence for image in images if pace.takes(image)] == expected


def test_a_pause_of_the_camera_is_not_made_up_for(
    instant_of: LiveInstant, snapshot_of: Callable[..., NavigationSnapshot]
) -> None:
    pace = ImagePace()
    pace.interval_s = 0.1
    at_s = [0.0, 5.0, 5.033, 5.066, 5.1, 5.133]
    images = [instant_of(n, snapshot=snapshot_of(captured_at_s=one)) for n, one in enumerate(at_s)]
    assert [image.sequence for image in images if pace.takes(image)] == [0, 1, 4]


def test_no_image_and_a_change_of_alarms_are_sent_at_once(
    instant_of: LiveInstant, snapshot_of: Callable[..., NavigationSnapshot]
) -> None:
    pace = ImagePace()
    pace.interval_s = 1.0
    image = instant_of(0, snapshot=snapshot_of(captured_at_s=7.0))
    rung = dataclasses.replace(image, alarms=dataclasses.replace(image.alarms, revision=1))
    assert [pace.takes(one) for one in (image, image, rung, rung, instant_of(4))] == [
        True,
        False,
        True,
        False,
        True,
    ]


def test_the_interval_that_a_client_asks_for_is_kept(
    open_socket: OpenSocket, hub: LiveHub, live_instant: LiveInstant, instant_of: LiveInstant
) -> None:
    with open_socket("/ws/view") as socket:
        socket.send_text('{"interval_ms": 1000}')
        hub.publish(live_instant(0))
        socket.send_text('{"next": true}')
        first = unpacked(socket.receive_bytes())[0]
        # Within a second of the first, and not sent; one without an image is not held back.
        hub.publish(live_instant(1))
        socket.send_text('{"next": true}')
        hub.publish(instant_of(2))
        then = unpacked(socket.receive_bytes())[0]
    assert (first["sequence"], then["sequence"]) == (0, 2)


def test_the_size_is_requested_in_the_query_and_changed_later(
    open_socket: OpenSocket, hub: LiveHub, live_instant: LiveInstant
) -> None:
    with open_socket("/ws/view?size=half") as socket:
        shown = []
        for sequence, said in enumerate((None, "quarter", "full", "auto")):
            if said is not None:
                socket.send_text(json.dumps({"size": said}))
            hub.publish(live_instant(sequence))
            socket.send_text('{"next": true}')
            header, jpeg = unpacked(socket.receive_bytes())
            decoded = cv2.imdecode(np.frombuffer(jpeg, np.uint8), cv2.IMREAD_COLOR)
            assert decoded is not None
            shown.append((header["shown_scale_ratio"], decoded.shape[1], header["snapshot"]["width_px"]))
    # Pixel coordinates in the message always refer to the camera's image.
    assert shown == [(0.5, 80, 160), (0.25, 40, 160), (1.0, 160, 160), (1.0, 160, 160)]


def test_a_client_gets_none_larger_than_it_can_show_and_none_smaller_for_being_slow(
    open_socket: OpenSocket, hub: LiveHub, live_instant: LiveInstant
) -> None:
    with open_socket("/ws/view") as socket:
        shown = []
        for sequence, said in enumerate((None, "half", "full")):
            if said is not None:
                socket.send_text(json.dumps({"largest": said}))
            hub.publish(live_instant(sequence))
            socket.send_text('{"next": true, "showing_ms": 900}')
            shown.append(unpacked(socket.receive_bytes())[0]["shown_scale_ratio"])
    assert shown == [1.0, 0.5, 1.0]


@pytest.mark.parametrize(
    ("showing_s", "drained_at_s", "free_at_s"),
    [
        pytest.param(0.0, 10.0, 10.5, id="says-nothing"),
        pytest.param(0.3, 10.0, 10.2, id="busy-itself"),
        pytest.param(9.0, 10.1, 10.1, id="claims-more-than-there-was"),
        pytest.param(0.3, 11.0, 10.5, id="credited-before-it-was-recorded"),
    ],
)
def test_what_the_client_needed_itself_is_not_the_connections(
    showing_s: float, drained_at_s: float, free_at_s: float
) -> None:
    granting = ViewRequests(Viewer(ViewerKind.VIEW))
    granting.at_s, granting.showing_s = 10.5, showing_s
    assert granting.connection_free_at_s(drained_at_s=drained_at_s) == pytest.approx(free_at_s)


def test_a_flood_of_questions_ends_with_a_reason(open_socket: OpenSocket) -> None:
    with open_socket("/ws/view") as socket:
        for _ in range(700):
            socket.send_text('{"next": true}')
        with pytest.raises(WebSocketDisconnect) as reported:
            socket.receive_bytes()
    assert reported.value.code == 1008
    assert "per second" in reported.value.reason


def test_an_unknown_camera_is_rejected_with_the_known_ones(open_socket: OpenSocket) -> None:
    with open_socket("/ws/view?camera=side") as socket, pytest.raises(WebSocketDisconnect) as reported:
        socket.receive_bytes()
    assert reported.value.code == 1008
    assert reported.value.reason == "there is no camera 'side', only main"


@pytest.mark.parametrize(
    ("query", "reason"),
    [
        ("size=tiny", "there is no size 'tiny', available are auto, full, half, quarter"),
        ("overlay=none", "there is no overlay 'none', available are full, geometry"),
    ],
)
def test_an_unknown_choice_is_rejected_with_the_known_ones(
    open_socket: OpenSocket, query: str, reason: str
) -> None:
    with open_socket(f"/ws/view?{query}") as socket, pytest.raises(WebSocketDisconnect) as reported:
        socket.receive_bytes()
    assert (reported.value.code, reported.value.reason) == (1008, reason)


def test_the_overlay_is_requested_in_the_query(
    open_socket: OpenSocket, hub: LiveHub, live_instant: LiveInstant
) -> None:
    instant = live_instant(1)
    assert instant.snapshot is not None
    width, height = instant.snapshot.size_wh_px
    instant = dataclasses.replace(instant, jpeg=b"", image=np.full((height, width, 3), 77, np.uint8))
    hub.publish(instant)
    received = {}
    for query in ("", "?overlay=full", "?overlay=geometry"):
        with open_socket(f"/ws/view{query}") as socket:
            socket.send_text('{"next": true}')
            received[query] = unpacked(socket.receive_bytes())[1]
    assert received[""] == received["?overlay=full"] != received["?overlay=geometry"]
