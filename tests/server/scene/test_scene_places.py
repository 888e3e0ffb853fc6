"""Limits of the 3-D scene: as many viewers as of pictures, and eight per user."""

from contextlib import ExitStack

import pytest
from fastapi.testclient import TestClient
from starlette.websockets import WebSocketDisconnect

from server.app import AppParts, create_app
from server.config import Config
from server.live import LiveHub
from server.scene.gate import SUBPROTOCOL
from server.scene.scene import CROWDED
from tests.server.supervision.signed_in_people import sign_people_in


def test_one_person_has_eight_places_and_takes_none_from_others_or_from_pictures() -> None:
    app = create_app(AppParts(hub=LiveHub(), config=Config()))
    sign_people_in(app)
    with TestClient(app, base_url="http://127.0.0.1:8000") as client, ExitStack() as watching:

        def watch(path: str, person: str) -> None:
            address = f"ws://127.0.0.1:8000{path}?person={person}"
            protocols = [SUBPROTOCOL] if path == "/scene" else None
            watching.enter_context(client.websocket_connect(address, subprotocols=protocols))

        for _ in range(8):
            watch("/scene", "s1")
        with pytest.raises(WebSocketDisconnect) as rejected:
            watch("/scene", "s1")
        assert rejected.value.code == CROWDED
        assert app.state.scene.viewers == 8
        watch("/scene", "s2")
        watch("/ws/live", "s1")
        assert 'coaxial_viewers{kind="scene"} 9.0' in client.get("/metrics").text
        watching.pop_all().close()
        # Released places are free again.
        watch("/scene", "s1")
