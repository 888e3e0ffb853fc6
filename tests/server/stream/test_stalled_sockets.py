"""A WebSocket client that reads nothing is disconnected, on every socket."""

import contextlib
import http.client
import itertools
import socket
import threading
import time
from collections.abc import Callable

import pytest
from fastapi import FastAPI

from server.live import Instant, LiveHub, Problem, SourceState, SourceStatus
from server.stream.connection import ViewerHttpProtocol

DEADLINE_S = 60.0
# More than all buffers between both sides hold.
LARGE = 8_000_000
HANDSHAKE = (
    "GET /ws/{kind} HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
    "Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n\r\n"
)
NEXT_REQUEST = b'{"next": true}'
# A text message in one frame, masked with zeros, since a client must mask it.
GRANT_FRAME = bytes([0x81, 0x80 | len(NEXT_REQUEST), 0, 0, 0, 0]) + NEXT_REQUEST


def let_go(port: int, kind: str) -> bool:
    connection = http.client.HTTPConnection("127.0.0.1", port, timeout=DEADLINE_S)
    connection.request("GET", "/metrics")
    reported = connection.getresponse().read().decode()
    connection.close()
    return f'coaxial_viewer_let_go_total{{kind="{kind}"}} 1.0' in reported


@pytest.mark.parametrize("kind", ["live", "view"])
def test_a_stalled_client_is_cut_off(
    hub: LiveHub,
    app: FastAPI,
    serve: Callable[[FastAPI], int],
    live_instant: Callable[..., Instant],
    instant_of: Callable[..., Instant],
    kind: str,
) -> None:
    port = serve(app)
    if kind == "view":
        hub.publish(live_instant(1, jpeg=b"\xff" * LARGE))
    else:
        problem = Problem(code="LONG", message="x" * LARGE, remedy="None.")
        source = SourceStatus(name="0", state=SourceState.RECONNECTING, problem=problem)
        hub.publish(instant_of(1, source=source))
    with socket.socket() as stalled:
        stalled.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        stalled.connect(("127.0.0.1", port))
        stalled.sendall(HANDSHAKE.format(kind=kind).encode())
        assert stalled.recv(12) == b"HTTP/1.1 101"
        if kind == "view":
            stalled.sendall(GRANT_FRAME)
        deadline = time.monotonic() + DEADLINE_S
        while not let_go(port, kind):
            assert time.monotonic() < deadline


@pytest.mark.parametrize("beginning", [b"", b"GET / HTTP/1.1\r\nHost: 127."])
def test_a_connection_without_a_request_is_cut(
    app: FastAPI, serve: Callable[[FastAPI], int], monkeypatch: pytest.MonkeyPatch, beginning: bytes
) -> None:
    monkeypatch.setattr(ViewerHttpProtocol, "request_within_s", 0.05)
    port = serve(app)
    with socket.create_connection(("127.0.0.1", port), timeout=DEADLINE_S) as silent:
        silent.sendall(beginning)
        with contextlib.suppress(ConnectionResetError):
            assert silent.recv(1) == b""


def test_a_later_request_whose_head_trickles_is_cut(
    app: FastAPI, serve: Callable[[FastAPI], int], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(ViewerHttpProtocol, "request_within_s", 1.0)
    port = serve(app)
    with socket.create_connection(("127.0.0.1", port), timeout=DEADLINE_S) as slow:
        slow.sendall(b"GET /api/dashboard HTTP/1.1\r\nHost: 127.0.0.1\r\n\r\n")
        assert slow.recv(12) == b"HTTP/1.1 200"
        trickle = itertools.chain(b"GET / HTTP/1.1\r\nX: ", itertools.repeat(ord("x")))
        ended = threading.Event()
        reading = threading.Thread(target=_read_to_the_end, args=(slow, ended))
        reading.start()
        # Byte by byte, which once kept the connection open while only silence counted.
        while not ended.wait(0.01):
            with contextlib.suppress(BrokenPipeError, ConnectionResetError):
                slow.sendall(bytes([next(trickle)]))
        reading.join()


def test_a_socket_outlives_the_wait_for_a_request(
    hub: LiveHub,
    app: FastAPI,
    serve: Callable[[FastAPI], int],
    live_instant: Callable[..., Instant],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(ViewerHttpProtocol, "request_within_s", 1.0)
    port = serve(app)
    hub.publish(live_instant(1))
    with socket.create_connection(("127.0.0.1", port), timeout=DEADLINE_S) as viewer:
        viewer.sendall(HANDSHAKE.format(kind="live").encode())
        assert viewer.recv(12) == b"HTTP/1.1 101"
        with (
            contextlib.suppress(ConnectionResetError),
            socket.create_connection(("127.0.0.1", port), timeout=DEADLINE_S) as silent,
        ):
            # Arrives later and is closed: the time limit of the socket has expired too.
            assert silent.recv(1) == b""
        hub.publish(live_instant(2))
        received = b""
        while b'"sequence":2' not in received:
            received += (some := viewer.recv(65_536))
            assert some


def _read_to_the_end(line: socket.socket, ended: threading.Event) -> None:
    with contextlib.suppress(ConnectionResetError):
        while line.recv(65_536):
            pass
    ended.set()
