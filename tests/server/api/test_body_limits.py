"""Bodies that are too long or too slow are rejected with a message, and the connection is closed."""

import asyncio
import contextlib
import socket
from collections.abc import Iterator

import pytest
from starlette.types import Message, Receive, Scope, Send

from server.api import body_limits
from server.api.body_limits import MAX_BYTES, MAX_TO_SIGN_IN_BYTES, UPLOADS, BodyLimitMiddleware
from tests.served import served
from tests.server.security.guarded_app import Guarded, guarded
from tests.server.stream.simulated_time import run_in_made_time
from tracker.errors import NavigationError


@pytest.fixture(scope="module")
def house(tmp_path_factory: pytest.TempPathFactory) -> Iterator[Guarded]:
    with guarded(tmp_path_factory.mktemp("home")) as house:
        yield house


def in_pieces(size_bytes: int) -> Iterator[bytes]:
    """Without a Content-Length."""
    yield b'{"name": "'
    for _ in range(size_bytes // 2**16):
        yield b"a" * 2**16


@pytest.mark.parametrize("has_length", [True, False])
@pytest.mark.parametrize(
    ("path", "max_bytes"), [("/api/session", MAX_TO_SIGN_IN_BYTES), ("/api/cases", MAX_BYTES)]
)
def test_more_than_is_taken_is_rejected(
    house: Guarded, path: str, max_bytes: int, *, has_length: bool
) -> None:
    headers = {"Content-Type": "application/json", **({} if path == "/api/session" else house.bearer())}
    pieces = in_pieces(max_bytes + 2**16)
    answer = house.door.post(path, content=b"".join(pieces) if has_length else pieces, headers=headers)
    assert (answer.status_code, answer.json()["code"]) == (413, "BODY_TOO_LARGE"), answer.text
    assert f"the maximum is {max_bytes // 1024} kB" in answer.json()["message"]
    assert answer.json()["remedy"]


def test_as_much_as_is_taken_is_read(house: Guarded) -> None:
    content = b'{"invitation": "a"}'
    for path, size, more in (
        ("/api/session", MAX_TO_SIGN_IN_BYTES, {}),
        ("/api/cases", MAX_BYTES, house.bearer()),
    ):
        headers = {"Content-Type": "application/json", **more}
        answer = house.door.post(path, content=content.ljust(size), headers=headers)
        assert answer.json()["code"] != "BODY_TOO_LARGE"


# Markups of a few points and certificates: files, and no larger than any other body.
OF_GENERAL_LIMIT = {
    "/api/certificates",
    "/api/plan/vertebrae/{name}/landmarks/import",
    "/api/plan/vertebrae/{name}/channels/{side}/import",
}


def test_what_has_a_limit_of_its_own_is_every_address_that_takes_a_file(house: Guarded) -> None:
    files = {
        path
        for path, methods in house.app.openapi()["paths"].items()
        for operation in methods.values()
        for content in [operation.get("requestBody", {}).get("content", {})]
        if content and not any("schema" in kind for kind in content.values())
    }
    assert files == UPLOADS | OF_GENERAL_LIMIT


def sent(path: str, pieces: list[tuple[float, int]], *, works_s: float = 0.0) -> tuple[str, float]:
    """Result and duration for a body of these pieces (seconds before each, bytes).

    The application works for this long on each piece. Time is simulated.

    """
    came: list[tuple[str, float]] = []

    async def run() -> None:
        now, waiting = asyncio.get_running_loop().time, iter(pieces)

        async def receive() -> Message:
            after_s, size = next(waiting, (float("inf"), 0))
            await (asyncio.sleep(after_s) if after_s < float("inf") else asyncio.Event().wait())
            return {"type": "http.request", "body": b"x" * size, "more_body": size != 1}

        async def reads(_scope: Scope, receive: Receive, _send: Send) -> None:
            while (await receive())["more_body"]:
                await asyncio.sleep(works_s)

        async def send(_message: Message) -> None:
            raise AssertionError("nothing is answered here")

        try:
            await BodyLimitMiddleware(reads)({"type": "http", "path": path, "headers": []}, receive, send)
            came.append(("whole", now()))
        except NavigationError as rejected:
            came.append((f"{rejected.code}: {rejected.message}" if rejected.remedy else "no remedy", now()))

    run_in_made_time(run())
    return came[0]


END = (0.0, 1)
JSON, FILE = "/api/cases", "/api/ct"


@pytest.mark.parametrize("path", [JSON, FILE])
def test_a_body_that_stops_coming_is_rejected_in_words(path: str) -> None:
    said, after_s = sent(path, [(0.1, 5000), (0.1, 0)])
    assert said == (
        "BODY_TOO_SLOW: 4.9 kB of the request arrived, the last 4.9 kB in 20 s; the minimum is 32 kB in "
        "this time"
    )
    assert after_s == pytest.approx(20.0)


@pytest.mark.parametrize("path", [JSON, FILE])
def test_letter_by_letter_is_no_progress(path: str) -> None:
    said, after_s = sent(path, [(1.0, 100)] * 10_000)
    assert said.startswith("BODY_TOO_SLOW")
    assert after_s == pytest.approx(20.0)


def test_a_large_file_takes_as_long_as_a_thin_line_needs() -> None:
    # 40 MB over 128 kbit/s, with a pause of 15 s now and then: three quarters of an hour.
    pieces = [(15.0 if number % 100 == 0 else 1.0, 16_384) for number in range(2500)]
    said, after_s = sent(FILE, [*pieces, END])
    assert (said, after_s > 2500.0) == ("whole", True)


def test_the_time_in_which_the_server_writes_to_its_disk_is_not_the_senders() -> None:
    assert sent(FILE, [(0.1, 1000)] * 50 + [END], works_s=60.0)[0] == "whole"


def test_to_sign_in_there_is_one_time_for_all() -> None:
    said, after_s = sent("/api/session", [(1.0, 600)] * 100)
    assert said == "BODY_TOO_SLOW: the request was not complete after 20 s"
    assert after_s == pytest.approx(20.0)


def test_a_client_may_be_silent_after_a_complete_request() -> None:
    """An endless picture stream ends when its viewer disconnects."""
    silent: list[Message] = []

    async def run() -> None:
        async def receive() -> Message:
            if silent:
                await asyncio.sleep(3600.0)
                return {"type": "http.disconnect"}
            return {"type": "http.request", "body": b"", "more_body": False}

        async def watches(_scope: Scope, receive: Receive, _send: Send) -> None:
            silent.append(await receive())
            silent.append(await receive())

        async def send(_message: Message) -> None: ...

        scope: Scope = {"type": "http", "path": "/video/main.mjpg", "headers": []}
        await BodyLimitMiddleware(watches)(scope, receive, send)

    run_in_made_time(run())
    assert [one["type"] for one in silent] == ["http.request", "http.disconnect"]


def test_every_request_with_a_body_has_the_rejection_in_its_description(house: Guarded) -> None:
    with_body = [
        (path, method, operation)
        for path, methods in house.app.openapi()["paths"].items()
        for method, operation in methods.items()
        if "requestBody" in operation
    ]
    assert len(with_body) > 20
    assert [one[:2] for one in with_body if "408" not in one[2]["responses"]] == []


def test_a_late_sign_in_is_rejected_and_the_connection_closed(
    house: Guarded, monkeypatch: pytest.MonkeyPatch
) -> None:
    """Over a real connection with a time limit of 0: anything not there at once is too late."""
    monkeypatch.setattr(body_limits, "SIGN_IN_WITHIN_S", 0.0)
    head = (
        b"POST /api/session HTTP/1.1\r\nHost: 127.0.0.1\r\nContent-Type: application/json\r\n"
        b"Content-Length: 10000\r\n\r\n"
    )
    reported = bytearray()
    with (
        served(house.app, begun=True) as port,
        socket.create_connection(("127.0.0.1", port), timeout=60) as slow,
    ):
        slow.sendall(head + b'{"')
        # A connection left open would end this by its own time limit.
        with contextlib.suppress(ConnectionResetError):
            while some := slow.recv(65_536):
                reported.extend(some)
    assert reported.startswith(b"HTTP/1.1 408")
    assert b"BODY_TOO_SLOW" in reported
    assert b"not complete after 0 s" in reported
    assert b"connection: close" in reported.lower()
