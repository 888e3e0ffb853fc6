"""The OpenIGTLink server with real sockets: delivery, and independence of clients."""

import asyncio
import socket
import time
from collections.abc import Awaitable, Callable
from contextlib import suppress

import pyigtl
import pytest

from server import openigtlink_wire as wire
from server.app import AppParts, create_app
from server.config import Config
from server.live import Instant, LiveHub
from server.openigtlink import OpenIgtLinkServer
from server.openigtlink import server as link_server
from server.openigtlink_wire import Message
from tests.served import served
from tests.server.conftest import make_instant, make_snapshot
from tests.server.openigtlink.spoken import Said, said

AT_S, UNIX_S = 100.0, 1_764_000_000.0
TIP = ("POINT", "drillTip")
HEADLINE = ("STRING", "Headline")


class World:
    """A server, its hub, a stopped clock, and clients."""

    def __init__(self, **settings: object) -> None:
        self.now_s = AT_S
        self.hub = LiveHub()
        self.config = Config.model_validate({"openigtlink": {"port": 0, **settings}})
        self.server = OpenIgtLinkServer(
            self.hub, self.config, clock=lambda: self.now_s, wall_clock=lambda: self.now_s + UNIX_S
        )
        self.listener = listening()
        self.writers: list[asyncio.StreamWriter] = []

    def publish(self, sequence: int, *, captured_at_s: float | None = None) -> None:
        at_s = self.now_s if captured_at_s is None else captured_at_s
        self.hub.publish(instant(sequence, at_s))

    async def client(self, *, buffer_bytes: int | None = None) -> asyncio.StreamReader:
        raw = socket.socket()
        if buffer_bytes is not None:
            raw.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, buffer_bytes)
        raw.setblocking(False)
        await asyncio.get_running_loop().sock_connect(raw, self.listener.getsockname())
        reader, writer = await asyncio.open_connection(sock=raw, limit=1024)
        self.writers.append(writer)
        return reader


def instant(sequence: int, captured_at_s: float) -> Instant:
    tip = (1.5, -1.0, float(sequence % 30))
    snapshot = make_snapshot(judged=True, captured_at_s=captured_at_s, tip_in_vertebra_mm=tip)
    return make_instant(sequence, snapshot=snapshot)


def listening() -> socket.socket:
    listener = socket.socket()
    listener.bind(("127.0.0.1", 0))
    listener.listen()
    return listener


def played(scene: Callable[[World], Awaitable[None]], **settings: object) -> None:
    async def play() -> None:
        world = World(**settings)
        await world.server.start(world.listener)
        try:
            async with asyncio.timeout(30.0):
                await scene(world)
        finally:
            for writer in world.writers:
                writer.transport.abort()
            await world.server.stop()

    asyncio.run(play())


async def message_from(reader: asyncio.StreamReader) -> Message:
    header = wire.unpack_header(await reader.readexactly(wire.HEADER_BYTES))
    return wire.unpack(header, await reader.readexactly(header.body_bytes))


async def until(reader: asyncio.StreamReader, last: tuple[str, str]) -> Said:
    """All messages up to this one."""
    found: Said = {}
    while last not in found:
        found |= said([await message_from(reader)])
    return found


def depth_mm(found: Said) -> float:
    points = found[TIP]
    assert isinstance(points, tuple)
    return float(points[0].position_mm[2])


@pytest.mark.parametrize("version", [1, 2])
def test_each_client_gets_the_newest_instant_at_once_and_each_new_one(version: int) -> None:
    async def scene(world: World) -> None:
        world.publish(3)
        readers = [await world.client(), await world.client()]
        for reader in readers:
            assert depth_mm(await until(reader, HEADLINE)) == pytest.approx(3.0, abs=1e-4)
        world.publish(4)
        for reader in readers:
            assert depth_mm(await until(reader, HEADLINE)) == pytest.approx(4.0, abs=1e-4)

    played(scene, header_version=version)


def test_when_images_stop_the_client_is_informed_without_another_instant() -> None:
    async def scene(world: World) -> None:
        world.publish(3)
        reader = await world.client()
        await until(reader, HEADLINE)
        # The rate allows the next image from here on: the server waits only for an image.
        world.now_s += 0.05
        while not world.hub._waiting:
            await asyncio.sleep(0)
        world.now_s += 1.0
        received = await until(reader, HEADLINE)
        assert received["STATUS", "drillTip"] == "TOO_OLD"
        assert str(received[HEADLINE]).startswith("TOO_OLD")

    played(scene)


def test_between_two_images_of_a_slow_rate_no_pose_stays_valid_and_the_newest_follows() -> None:
    async def scene(world: World) -> None:
        world.publish(3)
        reader = await world.client()
        await until(reader, HEADLINE)
        world.publish(4)
        world.now_s += 2.0
        world.publish(5)
        received = await until(reader, HEADLINE)
        assert received["STATUS", "drillTip"] == "TOO_OLD"
        assert depth_mm(await until(reader, HEADLINE)) == pytest.approx(5.0, abs=1e-4)

    played(scene, max_rate_hz=1.0)


def test_a_client_that_reads_nothing_delays_no_other_and_is_disconnected(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    monkeypatch.setattr(link_server, "SEND_TIMEOUT_S", 0.05)

    async def scene(world: World) -> None:
        await world.client(buffer_bytes=2048)
        reader = await world.client()
        world.publish(0)
        await until(reader, HEADLINE)
        for sequence in range(1, 5000):
            world.now_s += 0.03
            world.publish(sequence)
            found = await until(reader, HEADLINE)
            assert depth_mm(found) == pytest.approx(sequence % 30, abs=1e-4)
            if len(world.server._clients) == 1:
                break
        assert len(world.server._clients) == 1

    played(scene, max_rate_hz=240.0)


def test_a_client_above_the_limit_is_rejected_and_the_others_stay() -> None:
    async def scene(world: World) -> None:
        world.publish(3)
        reader = await world.client()
        await until(reader, HEADLINE)
        rejected = await world.client()
        assert said([await message_from(rejected)]) == {("STATUS", "Coaxial"): "TOO_MANY_CLIENTS"}
        assert await rejected.read() == b""
        world.publish(4)
        await until(reader, HEADLINE)
        # A released place is given to the next client.
        world.writers[0].transport.abort()
        while world.server._clients:
            await asyncio.wait(world.server._clients)
        await until(await world.client(), HEADLINE)

    played(scene, max_clients=1)


@pytest.mark.parametrize(
    ("sent", "name"),
    [
        pytest.param(b"GET / HTTP/1.1\r\n" * 5, "NO_OPENIGTLINK", id="http"),
        pytest.param(wire.HEADER.pack(1, b"IMAGE", b"", 0, 0, 2**40, 0), "TOO_LONG", id="too-long"),
        pytest.param(
            wire.pack(Message(type="GET_STATUS", device="a", timestamp_s=0.0), version=1) * 60,
            "TOO_MANY_REQUESTS",
            id="too-many",
        ),
    ],
)
def test_a_client_with_another_protocol_is_rejected_and_closed(sent: bytes, name: str) -> None:
    async def scene(world: World) -> None:
        reader = await world.client()
        world.writers[0].write(sent)
        names = set()
        with suppress(asyncio.IncompleteReadError, ConnectionError):
            while True:
                names |= set(said([await message_from(reader)]).values())
        assert name in names
        assert names <= {name, "NO_IMAGE"}

    played(scene)


def test_requests_are_answered_and_a_damaged_one_is_reported() -> None:
    async def scene(world: World) -> None:
        reader = await world.client()
        ask = wire.pack(Message(type="GET_STATUS", device="mine", timestamp_s=0.0), version=2)
        world.writers[0].write(ask[:-1] + b"\1" + ask)
        assert said([await message_from(reader)]) == {("STATUS", "Coaxial"): "CHECKSUM"}
        assert said([await message_from(reader)]) == {("STATUS", "mine"): "NO_IMAGE"}

    played(scene)


def test_pyigtl_is_served_by_the_whole_application() -> None:
    hub, listener = LiveHub(), listening()
    # No image of this test is too old, however busy the machine.
    config = Config.model_validate({"limits": {"pose_stale_after_ms": 10_000.0}})
    with served(create_app(AppParts(hub=hub, config=config, openigtlink=listener))):
        client = pyigtl.OpenIGTLinkClient("127.0.0.1", listener.getsockname()[1])
        try:
            hub.publish(instant(7, time.monotonic()))
            transform = client.wait_for_message("drillToVertebra", timeout=20.0)
            assert transform.matrix[:3, 3] == pytest.approx([-1.5, 1.0, 7.0], abs=1e-4)
            assert client.wait_for_message("Headline", timeout=20.0).string
            assert client.wait_for_message("Plan", timeout=20.0).names == ["entry", "target"]
        finally:
            client.stop()
