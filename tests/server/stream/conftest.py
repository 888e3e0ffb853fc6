"""Fixtures: the whole application for a viewer, and pictures."""

import time
from collections.abc import Callable, Iterator

import numpy as np
import pytest
from fastapi import FastAPI
from fastapi.testclient import TestClient
from starlette.testclient import WebSocketTestSession

from server.app import AppParts, create_app
from server.config import Config, LimitsConfig
from server.live import Instant, LiveHub
from server.overlay import encode_jpeg
from tracker.navigation import NavigationSnapshot


@pytest.fixture
def hub() -> LiveHub:
    return LiveHub()


@pytest.fixture
def app(hub: LiveHub) -> FastAPI:
    return create_app(AppParts(hub=hub, config=Config()))


@pytest.fixture
def patient_app(hub: LiveHub) -> FastAPI:
    """The same, with age limits that no test reaches on a slow machine."""
    return create_app(AppParts(hub=hub, config=Config(limits=LimitsConfig(video_stale_after_ms=10_000.0))))


@pytest.fixture
def client(app: FastAPI) -> Iterator[TestClient]:
    with TestClient(app, base_url="http://127.0.0.1:8000") as client:
        yield client


@pytest.fixture
def open_socket(client: TestClient) -> Callable[..., WebSocketTestSession]:
    """Open a WebSocket of the application, with additional headers if given."""

    def opened(path: str, headers: dict[str, str] | None = None) -> WebSocketTestSession:
        return client.websocket_connect(f"ws://127.0.0.1:8000{path}", headers=headers or {})

    return opened


@pytest.fixture
def live_instant(
    snapshot_of: Callable[..., NavigationSnapshot], instant_of: Callable[..., Instant]
) -> Callable[..., Instant]:
    """A present instant whose picture has its sequence number as brightness."""

    def make(sequence: int, *, jpeg: bytes | None = None) -> Instant:
        picture = np.full((90, 160, 3), sequence % 256, np.uint8)
        snapshot = snapshot_of(
            size_wh_px=(160, 90), image_number=1000 + sequence, captured_at_s=time.monotonic()
        )
        return instant_of(sequence, snapshot=snapshot, jpeg=jpeg or encode_jpeg(picture, 80))

    return make
