"""Uploads rejected before their end, by clients that read the answer only after sending everything."""

import http.client
import json
import socket
from collections.abc import Callable, Iterator
from pathlib import Path

import pytest
from fastapi import FastAPI

from server import disk
from server.api import body_drain
from server.app import AppParts, create_app
from server.config import Config
from server.live import LiveHub
from server.store import CaseStore, Home

# More than the buffers of a connection hold.
BODY = bytes(48 * 2**20)
CHUNKED = {"Transfer-Encoding": "chunked"}
PATH = "/api/cases/archive"


@pytest.fixture
def app(tmp_path: Path) -> Iterator[FastAPI]:
    with Home(tmp_path / "home") as home, CaseStore(home) as store:
        yield create_app(AppParts(hub=LiveHub(), config=Config(), store=store))


def sent(port: int, *, chunked: bool = False) -> tuple[int, str]:
    """Status and code of the answer to an upload that is sent completely."""
    line = http.client.HTTPConnection("127.0.0.1", port, timeout=30.0)
    pieces = (BODY[at : at + 2**20] for at in range(0, len(BODY), 2**20))
    # On a keep-alive connection the web server keeps reading.
    line.request(
        "POST",
        PATH,
        pieces if chunked else BODY,
        {"Connection": "close"} | (CHUNKED if chunked else {}),
        encode_chunked=chunked,
    )
    answer = line.getresponse()
    code = json.loads(answer.read())["code"]
    line.close()
    return answer.status, code


def test_a_client_that_sends_all_first_still_hears_that_the_disk_is_full(
    app: FastAPI, serve: Callable[[FastAPI], int], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(disk, "RESERVED_BYTES", 2**60)
    assert sent(serve(app)) == (507, "STORE_FULL")


def test_a_body_without_an_announced_length_that_grows_too_large_is_reported(
    app: FastAPI, serve: Callable[[FastAPI], int], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("server.api.cases.MAX_ARCHIVE_BYTES", 2**20)
    assert sent(serve(app), chunked=True) == (413, "UPLOAD_TOO_LARGE")


@pytest.mark.parametrize("expect", [False, True])
def test_who_sends_no_more_is_answered_all_the_same(
    app: FastAPI, serve: Callable[[FastAPI], int], monkeypatch: pytest.MonkeyPatch, *, expect: bool
) -> None:
    monkeypatch.setattr(disk, "RESERVED_BYTES", 2**60)
    # A client that expects 100-continue is answered at once.
    monkeypatch.setattr(body_drain, "DRAIN_TIMEOUT_S", 60.0 if expect else 0.05)
    port = serve(app)
    with socket.create_connection(("127.0.0.1", port), timeout=20.0) as line:
        asks = "Expect: 100-continue\r\n" if expect else ""
        head = f"POST {PATH} HTTP/1.1\r\nHost: 127.0.0.1:{port}\r\nContent-Length: 1000000\r\n{asks}\r\n"
        line.sendall(head.encode())
        assert line.recv(100).startswith(b"HTTP/1.1 507")
