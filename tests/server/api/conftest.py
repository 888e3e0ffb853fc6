"""Fixtures: the whole application, reached through HTTP."""

from collections.abc import Iterator

import pytest
from fastapi.testclient import TestClient

from server.app import AppParts, create_app
from server.config import Config
from server.live import LiveHub


@pytest.fixture
def hub() -> LiveHub:
    return LiveHub()


@pytest.fixture
def client(hub: LiveHub) -> Iterator[TestClient]:
    app = create_app(AppParts(hub=hub, config=Config()))
    with TestClient(app, base_url="http://127.0.0.1:8000", raise_server_exceptions=False) as client:
        yield client
