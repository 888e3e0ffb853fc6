"""`/ws/live`: the newest at once, newest wins, and client messages are rejected."""

from collections.abc import Callable

import pytest
from starlette.testclient import WebSocketDenialResponse, WebSocketTestSession
from starlette.websockets import WebSocketDisconnect

from server.live import Instant, LiveHub, ProcessState, ProcessStatus

LiveInstant = Callable[..., Instant]
OpenSocket = Callable[..., WebSocketTestSession]


def test_a_late_joiner_gets_the_newest_at_once(
    open_socket: OpenSocket, hub: LiveHub, live_instant: LiveInstant
) -> None:
    for sequence in range(3):
        hub.publish(live_instant(sequence))
    with open_socket("/ws/live") as socket:
        reported = socket.receive_json()
    assert reported["sequence"] == 2
    assert reported["snapshot"]["image_number"] == 1002


def test_each_instant_is_reported_with_or_without_an_image(
    open_socket: OpenSocket, hub: LiveHub, live_instant: LiveInstant, instant_of: LiveInstant
) -> None:
    hub.publish(live_instant(0))
    with open_socket("/ws/live") as socket:
        assert socket.receive_json()["snapshot"]["image_number"] == 1000
        hub.publish(instant_of(1, process=ProcessStatus(state=ProcessState.RESTARTING, restarts=1)))
        reported = socket.receive_json()
        assert reported["snapshot"] is None
        assert reported["process"] == {"state": "restarting", "restarts": 1, "problem": None}
        hub.publish(live_instant(2))
        assert socket.receive_json()["sequence"] == 2


def test_a_client_message_is_rejected(open_socket: OpenSocket) -> None:
    with open_socket("/ws/live") as socket:
        socket.send_text("stop the drill")
        with pytest.raises(WebSocketDisconnect) as reported:
            socket.receive_json()
    assert reported.value.code == 1008
    assert "only sends" in reported.value.reason


@pytest.mark.parametrize("path", ["/ws/live", "/ws/view"])
@pytest.mark.parametrize(
    ("headers", "status", "code"),
    [
        ({"Origin": "http://evil.example"}, 403, "ORIGIN_REJECTED"),
        ({"Origin": "null"}, 403, "ORIGIN_REJECTED"),
        ({"Host": "evil.example"}, 421, "HOST_UNKNOWN"),
        ({"Host": "evil.example", "Origin": "http://evil.example"}, 421, "HOST_UNKNOWN"),
    ],
)
def test_foreign_pages_do_not_get_a_socket(
    open_socket: OpenSocket, path: str, headers: dict[str, str], status: int, code: str
) -> None:
    with pytest.raises(WebSocketDenialResponse) as reported, open_socket(path, headers=headers):
        pass
    assert reported.value.status_code == status
    assert reported.value.json()["code"] == code


def test_the_own_page_gets_a_socket(open_socket: OpenSocket, hub: LiveHub, live_instant: LiveInstant) -> None:
    hub.publish(live_instant(0))
    own = {"Host": "localhost:8000", "Origin": "http://localhost:8000"}
    with open_socket("/ws/live", headers=own) as socket:
        assert socket.receive_json()["sequence"] == 0
