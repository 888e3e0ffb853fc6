"""Viewers above the maximum are rejected with a reason; every kind of connection counts."""

from collections.abc import Callable, Iterator
from contextlib import ExitStack

import pytest
from fastapi import FastAPI
from fastapi.testclient import TestClient
from starlette.testclient import WebSocketTestSession
from starlette.websockets import WebSocketDisconnect

from server.app import AppParts, create_app
from server.config import Config
from server.live import Instant, LiveHub
from tests.server.supervision.signed_in_people import sign_people_in

OpenSocket = Callable[..., WebSocketTestSession]


@pytest.fixture
def client(hub: LiveHub) -> Iterator[TestClient]:
    config = Config()
    two = config.model_copy(update={"video": config.video.model_copy(update={"max_viewers": 2})})
    with TestClient(create_app(AppParts(hub=hub, config=two)), base_url="http://127.0.0.1:8000") as client:
        yield client


def test_the_third_of_two_is_rejected_with_a_remedy(
    client: TestClient, open_socket: OpenSocket, hub: LiveHub, live_instant: Callable[..., Instant]
) -> None:
    hub.publish(live_instant(1))
    with (
        open_socket("/ws/view") as view,
        open_socket("/ws/view"),
        open_socket("/ws/live") as live,
        open_socket("/ws/live"),
    ):
        view.send_text('{"next": true}')
        view.receive_bytes()
        live.receive_text()
        answer = client.get("/video/main.mjpg")
        assert answer.status_code == 503
        assert answer.json()["code"] == "TOO_MANY_VIEWERS"
        assert answer.json()["message"] == "2 viewers are connected, the maximum is 2"
        assert "video.max_viewers" in answer.json()["remedy"]
        for path in ("/ws/view", "/ws/live"):
            with open_socket(path) as third, pytest.raises(WebSocketDisconnect) as reported:
                third.receive_bytes()
            assert (reported.value.code, reported.value.reason) == (
                1013,
                "2 viewers are connected, the maximum is 2",
            )
    # They have disconnected, so there is room again.
    with open_socket("/ws/live") as live:
        assert live.receive_text()


def test_one_person_does_not_take_the_places_of_all(
    app: FastAPI, hub: LiveHub, live_instant: Callable[..., Instant]
) -> None:
    sign_people_in(app)
    hub.publish(live_instant(1))
    with TestClient(app, base_url="http://127.0.0.1:8000") as client, ExitStack() as open_lines:

        def opened(path: str, who: str) -> WebSocketTestSession:
            where = f"ws://127.0.0.1:8000{path}"
            return open_lines.enter_context(client.websocket_connect(where, headers={"x-person": who}))

        for path in ("/ws/live", "/ws/view") * 8:
            opened(path, "v1")
        seats = [opened("/ws/room?view=theatre", "v1") for _ in range(8)]
        for path in ("/ws/live", "/ws/view", "/ws/room?view=theatre"):
            with pytest.raises(WebSocketDisconnect) as reported:
                opened(path, "v1").receive_text()
            assert reported.value.code == 1013
            assert "Guest has 8 open connections" in str(reported.value.reason)
        rejected = client.get("/video/main.mjpg", headers={"x-person": "v1"})
        assert (rejected.status_code, rejected.json()["code"]) == (503, "TOO_MANY_VIEWERS")
        assert "Close an unused page" in rejected.json()["remedy"]
        for one in (seats[0], opened("/ws/room?view=operator", "o1")):
            one.send_json({"next": True})
            assert one.receive_json()["people"]
        assert opened("/ws/live", "s1").receive_json()["sequence"] == 1


def test_who_is_rejected_does_not_count(client: TestClient, open_socket: OpenSocket) -> None:
    for _ in range(3):
        with open_socket("/ws/view?size=tiny") as rejected, pytest.raises(WebSocketDisconnect):
            rejected.receive_bytes()
    assert 'coaxial_viewers{kind="view"} 0.0' in client.get("/metrics").text
