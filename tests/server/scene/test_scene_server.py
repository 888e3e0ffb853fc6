"""The scene on a real socket: who is admitted, what they receive, and what they cannot do."""

import contextlib
import os
import re
import socket
import threading
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from time import monotonic

import httpx2
import msgspec
import numpy as np
import pytest
from websockets.exceptions import ConnectionClosed, InvalidStatus
from websockets.sync.client import ClientConnection, connect
from websockets.typing import Subprotocol

from server.live import Instant
from server.scene import scene as scene_module
from server.scene.gate import Verdict
from server.scene.marks import Mark
from server.scene.stage import Stage
from tests.server.scene.packets import viser_messages
from tests.server.scene.scene_theatre import Running, Theatre, running
from tracker.plan import Surface

PROTOCOL = "viser-v1.1.1"


@contextlib.contextmanager
def viewer(
    server: Running, *, protocol: str = PROTOCOL, origin: str | None = None
) -> Iterator[ClientConnection]:
    line = connect(
        f"ws://127.0.0.1:{server.port}/scene",
        subprotocols=[Subprotocol(protocol)],
        additional_headers={"Origin": origin} if origin else {},
        max_size=None,
    )
    with contextlib.closing(line):
        yield line


def names_and_positions(packet: bytes | str) -> dict[str, list[float]]:
    assert isinstance(packet, bytes)
    return {m["name"]: m["position"] for m in viser_messages(packet) if m["type"] == "SetPositionMessage"}


def next_number(line: ClientConnection) -> int | None:
    """The image number in the next batch that has one; None if no image is shown."""
    while True:
        positions = names_and_positions(line.recv(timeout=20))
        if "/image_number" in positions:
            thousands, rest, _ = positions["/image_number"]
            return None if thousands == 0 else int((thousands - 1) * 1000 + rest)


def reach(line: ClientConnection, image: int | None) -> None:
    """Read until this image is reported."""
    while next_number(line) != image:
        pass


def until(happened: Callable[[], bool]) -> None:
    """Wait for an expected message; the test's time limit is the only clock."""
    end = monotonic() + 60
    while not happened():
        assert monotonic() < end, "it never happened"
        os.sched_yield()


def listening_sockets() -> set[str]:
    """Inodes of this process's own sockets that wait for connections or datagrams."""
    own = set()
    for descriptor in Path("/proc/self/fd").iterdir():
        try:
            found = re.fullmatch(r"socket:\[(\d+)\]", str(descriptor.readlink()))
        except FileNotFoundError:
            continue
        if found:
            own.add(found[1])
    listening = set()
    for table, states in (("tcp", {"0A"}), ("tcp6", {"0A"}), ("udp", {"07"}), ("udp6", {"07"})):
        lines = Path(f"/proc/self/net/{table}").read_text(encoding="ascii").splitlines()[1:]
        listening |= {line.split()[9] for line in lines if line.split()[3] in states}
    return own & listening


@pytest.mark.skipif(not Path("/proc/self/net/tcp").exists(), reason="needs Linux's /proc")
def test_the_only_door_is_the_applications_own(theatre: Theatre) -> None:
    before = listening_sockets()
    with running(theatre) as server, viewer(server) as line:
        line.recv(timeout=20)
        assert len(listening_sockets() - before) == 1


def test_who_comes_late_gets_the_state_at_once(theatre: Theatre) -> None:
    with running(theatre, stale_after_ms=60_000) as server:
        server.hub.publish(theatre.instant(0, image_number=41))
        with viewer(server) as first:
            reach(first, 41)
        with viewer(server) as late:
            assert next_number(late) == 41


def test_nothing_is_drawn_without_viewers_and_nothing_old_remains_for_the_next_one(
    theatre: Theatre, monkeypatch: pytest.MonkeyPatch
) -> None:
    shown: list[int] = []
    cleared = threading.Event()
    show, show_nothing = Stage.show, Stage.show_nothing

    def note(stage: Stage, instant: Instant, marks: Sequence[Mark]) -> None:
        shown.append(instant.sequence)
        show(stage, instant, marks)

    def clear(stage: Stage) -> None:
        show_nothing(stage)
        cleared.set()

    monkeypatch.setattr(Stage, "show", note)
    monkeypatch.setattr(Stage, "show_nothing", clear)
    with running(theatre, stale_after_ms=60_000) as server:
        server.hub.publish(theatre.instant(0, image_number=41))
        with viewer(server) as line:
            reach(line, 41)
        assert cleared.wait(20.0)
        before = list(shown)
        server.hub.publish(theatre.instant(1, image_number=42))
        with viewer(server) as line:
            reach(line, 42)
    assert (before, shown[-1]) == ([0], 1)


def test_many_viewers_get_the_newest(theatre: Theatre) -> None:
    with running(theatre, stale_after_ms=60_000) as server, viewer(server) as one, viewer(server) as two:
        for image in range(50):
            server.hub.publish(theatre.instant(image, image_number=image))
        reach(one, 49)
        reach(two, 49)
        assert server.app.state.scene.viewers == 2


def test_the_image_is_removed_when_no_message_arrives(theatre: Theatre) -> None:
    with running(theatre, stale_after_ms=200) as server, viewer(server) as line:
        server.hub.publish(theatre.instant(0, image_number=5))
        reach(line, 5)
        assert next_number(line) is None


def test_one_bad_instant_hides_the_drill_and_the_next_is_shown(
    theatre: Theatre, monkeypatch: pytest.MonkeyPatch
) -> None:
    show = Stage.show

    def stumble(stage: Stage, instant: Instant, marks: Sequence[Mark]) -> None:
        if instant.sequence == 1:
            raise ValueError("a number that is none")
        show(stage, instant, marks)

    monkeypatch.setattr(Stage, "show", stumble)
    with running(theatre, stale_after_ms=60_000) as server, viewer(server) as line:
        server.hub.publish(theatre.instant(0, image_number=0))
        reach(line, 0)
        for sequence, shown in ((1, None), (2, 2)):
            server.hub.publish(theatre.instant(sequence, image_number=sequence))
            assert next_number(line) == shown


@pytest.mark.parametrize(
    "wish",
    [
        pytest.param({"origin": "http://evil.example"}, id="from another page"),
        pytest.param({"protocol": "viser-v1.1.0"}, id="of another version"),
    ],
)
def test_a_stranger_is_rejected_before_the_handshake(theatre: Theatre, wish: dict[str, str]) -> None:
    with running(theatre) as server:
        with pytest.raises(InvalidStatus) as rejected, viewer(server, **wish):
            pass
        assert rejected.value.response.status_code == 403
        assert server.app.state.scene.viewers == 0


def test_a_crowd_is_rejected(theatre: Theatre) -> None:
    with running(theatre, max_viewers=1) as server, viewer(server) as line:
        line.recv(timeout=20)
        with pytest.raises(InvalidStatus), viewer(server):
            pass
        assert server.app.state.scene.viewers == 1


def test_own_page_is_admitted(theatre: Theatre) -> None:
    with running(theatre) as server, viewer(server, origin=f"http://127.0.0.1:{server.port}") as line:
        assert line.subprotocol == PROTOCOL
        assert line.recv(timeout=20)


def test_what_a_viewer_sends_is_counted_and_goes_nowhere(theatre: Theatre) -> None:
    with running(theatre, stale_after_ms=60_000) as server, viewer(server) as line:
        scene = server.app.state.scene
        for kind in ("ShareUrlRequest", "GuiFormDirtyMessage", "ViewerCameraMessage"):
            line.send(msgspec.msgpack.encode({"type": kind}))
        line.send("text")
        until(lambda: sum(scene.counts.values()) == 4)
        assert scene.counts[Verdict.UNWANTED] == 3
        assert scene.counts[Verdict.CAMERA] == 1
        server.hub.publish(theatre.instant(0, image_number=6))
        reach(line, 6)


def test_who_floods_is_thrown_out(theatre: Theatre) -> None:
    def flood(line: ClientConnection) -> None:
        while True:
            line.send(b"")

    with running(theatre) as server, viewer(server) as line:
        with pytest.raises(ConnectionClosed) as closed:
            flood(line)
        assert closed.value.rcvd is None or closed.value.rcvd.code == 1008
        until(lambda: server.app.state.scene.viewers == 0)


def test_a_stalled_viewer_delays_no_other_and_is_dropped(
    theatre: Theatre, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(scene_module, "SEND_TIMEOUT_S", 0.3)
    monkeypatch.setattr(scene_module, "THINNEST_LINE_BYTES_PER_S", 1e9)
    # A surface of 24 MB exceeds the kernel's buffers for a client that does not read.
    large = Theatre(
        setup=theatre.setup,
        surface=Surface(vertices_mm=np.zeros((2_000_000, 3)), faces=np.zeros((1, 3), dtype=np.int64)),
    )
    with running(large, stale_after_ms=60_000) as server:
        scene = server.app.state.scene
        with socket.create_connection(("127.0.0.1", server.port)) as stalled:
            stalled.sendall(
                b"GET /scene HTTP/1.1\r\nHost: 127.0.0.1\r\nConnection: Upgrade\r\nUpgrade: websocket\r\n"
                b"Sec-WebSocket-Version: 13\r\nSec-WebSocket-Key: MDEyMzQ1Njc4OWFiY2RlZg==\r\n"
                b"Sec-WebSocket-Protocol: " + PROTOCOL.encode() + b"\r\n\r\n"
            )
            until(lambda: scene.viewers == 1)
            image = 0
            with viewer(server) as reader:
                while scene.slow_viewers == 0:
                    image += 1
                    server.hub.publish(theatre.instant(image, image_number=image))
                    number = next_number(reader)
                    while number != image:
                        number = next_number(reader)
            until(lambda: scene.viewers == 0)
        assert scene.slow_viewers == 1


def test_the_page_is_sent_small_and_only_once(theatre: Theatre) -> None:
    with running(theatre) as server, httpx2.Client(base_url=server.address) as client:
        answer = client.get("/scene/")
        assert answer.status_code == 200
        assert answer.headers["content-encoding"] == "gzip"
        assert answer.headers["content-type"] == "text/html; charset=utf-8"
        assert "coaxial-scene" in answer.text
        again = client.get("/scene/", headers={"If-None-Match": answer.headers["etag"]})
        assert again.status_code == 304
        assert again.content == b""
        plain = client.get("/scene/", headers={"Accept-Encoding": "identity"})
        assert "content-encoding" not in plain.headers
        assert plain.text == answer.text
        assert client.get("/scene", follow_redirects=True).status_code == 200


def test_the_page_may_talk_to_its_own_server_only(theatre: Theatre) -> None:
    with running(theatre) as server:
        policy = httpx2.get(f"{server.address}/scene/").headers["content-security-policy"]
        assert f"connect-src 'self' data: blob: ws://127.0.0.1:{server.port}" in policy
        assert "frame-ancestors 'self'" in policy
        assert "unsafe-eval'" not in policy.replace("wasm-unsafe-eval", "")
        odd = httpx2.get(f"{server.address}/scene/", headers={"Host": "a; script-src *"})
        assert "script-src *" not in odd.headers.get("content-security-policy", "")
