"""Bodies that are too long, or come too slowly, are refused in words, and the line goes."""

import contextlib
import itertools
import socket
import threading
from collections.abc import Iterator

import pytest

from server.api import bodies
from server.api.bodies import MOST_BYTES, MOST_TO_SIGN_IN_BYTES, UPLOADS
from tests.served import served
from tests.server.security.doors import Guarded, guarded


@pytest.fixture(scope="module")
def house(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Guarded]:
    with guarded(tmp_path_factory.mktemp("home")) as house:
        yield house


def in_pieces(size_bytes: int) -> Iterator[bytes]:
    """Without a length that is told before."""
    yield b'{"name": "'
    for _ in range(size_bytes // 2**16):
        yield b"a" * 2**16


@pytest.mark.parametrize("is_told", [True, False])
@pytest.mark.parametrize(
    ("path", "most_bytes"), [("/api/session", MOST_TO_SIGN_IN_BYTES), ("/api/cases", MOST_BYTES)]
)
def test_more_than_is_taken_is_refused(house: Guarded, path: str, most_bytes: int, *, is_told: bool) -> None:
    headers = {"Content-Type": "application/json", **({} if path == "/api/session" else house.bearer())}
    pieces = in_pieces(most_bytes + 2**16)
    answer = house.door.post(path, content=b"".join(pieces) if is_told else pieces, headers=headers)
    assert (answer.status_code, answer.json()["code"]) == (413, "BODY_TOO_LARGE"), answer.text
    assert f"allowed are {most_bytes // 1024} kB" in answer.json()["message"]
    assert answer.json()["remedy"]


def test_as_much_as_is_taken_is_read(house: Guarded) -> None:
    content = b'{"invitation": "a"}'
    for path, size, more in (
        ("/api/session", MOST_TO_SIGN_IN_BYTES, {}),
        ("/api/cases", MOST_BYTES, house.bearer()),
    ):
        headers = {"Content-Type": "application/json", **more}
        answer = house.door.post(path, content=content.ljust(size), headers=headers)
        assert answer.json()["code"] != "BODY_TOO_LARGE"


def test_what_has_a_limit_of_its_own_is_every_address_that_takes_a_file(house: Guarded) -> None:
    files = {
        path
        for path, methods in house.app.openapi()["paths"].items()
        for operation in methods.values()
        for content in [operation.get("requestBody", {}).get("content", {})]
        if content and not any("schema" in kind for kind in content.values())
    }
    assert files == UPLOADS


def test_who_signs_in_letter_by_letter_is_cut_off(house: Guarded, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(bodies, "SIGN_IN_WITHIN_S", 0.3)
    head = (
        b"POST /api/session HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: application/json\r\n"
        b"Content-Length: 10000\r\n\r\n"
    )
    with (
        served(house.app, begun=True) as port,
        socket.create_connection(("127.0.0.1", port), timeout=60) as slow,
    ):
        slow.sendall(head)
        told, ended = bytearray(), threading.Event()

        def read() -> None:
            try:
                with contextlib.suppress(OSError):
                    while some := slow.recv(65_536):
                        told.extend(some)
            finally:
                ended.set()

        reading = threading.Thread(target=read)
        reading.start()
        letters = itertools.chain(b'{"', itertools.repeat(ord("x")))
        while not ended.wait(0.02):
            with contextlib.suppress(BrokenPipeError, ConnectionResetError):
                slow.sendall(bytes([next(letters)]))
        reading.join()
    assert told.startswith(b"HTTP/1.1 408")
    assert b"BODY_TOO_SLOW" in told
