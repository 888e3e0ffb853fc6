"""The users of the guide on a real NATS server: they suffice, and a theatre cannot act as another one."""

import asyncio
import json
import re
import time
from contextlib import suppress
from pathlib import Path

import pytest
from nats.aio.msg import Msg
from nats.js.errors import NotFoundError

from server.hub.connection import HubAddress
from server.hub.publisher import Outgoing, Publisher, PublisherSettings
from server.hub.requester import request_line
from server.hub.requests import HubAnswer, HubRequest, RequestServer
from server.hub.subjects import Hospital, Leaf
from server.hub.watcher import Watcher
from tests.nats_server import nats_in
from tests.server.hub.test_hub_publisher import live_text
from tracker.errors import NavigationError

GUIDE = Path(__file__).parents[3] / "docs" / "guide" / "hub.md"
PATIENCE_S = 60.0
PASSWORD = "told"  # noqa: S105  of a server of this test
STREAM = {"name": "X", "subjects": ["coaxial.clinic.theatre.OR-4.request"], "storage": "memory"}


def users() -> str:
    """The permissions of the guide, with a password that is not hashed."""
    found = re.search(
        r"^authorization \{.*?^\] \}$", GUIDE.read_text(encoding="utf-8"), re.DOTALL | re.MULTILINE
    )
    assert found is not None
    return found[0].replace("$2a$11$…", PASSWORD)


def of(url: str, user: str) -> HubAddress:
    return HubAddress(url=url, hospital=Hospital("clinic"), user=(user, PASSWORD))


async def perform(request: HubRequest) -> HubAnswer:
    return HubAnswer(status=200, content_type="application/json", token=None, body=request.body.encode())


def publish(publisher: Publisher) -> None:
    # Not yet connected, or before the hub has created the stream.
    with suppress(NavigationError):
        publisher.receive(Outgoing(text=live_text(), captured_at_s=time.monotonic()))


async def acts_in_theatre(url: str, folder: Path) -> None:
    """A hub that creates stream and bucket receives OR-3, and OR-3 answers its request."""
    hub, theatre = of(url, "hub"), of(url, "OR-3")
    watcher = Watcher(hub, (Leaf.STATE,), creates_storage=True)
    server = RequestServer(
        theatre,
        "OR-3",
        perform=perform,
        is_published=lambda: ("OR-3", Leaf.STATE) in watcher.newest,
        rejected=lambda error, _: pytest.fail(error.code),
    )
    running = [asyncio.create_task(one.run()) for one in (watcher, server)]
    publisher = Publisher(PublisherSettings(address=theatre, theatre="OR-3", home=folder, max_rate_hz=60.0))
    try:
        async with asyncio.timeout(PATIENCE_S):
            while ("OR-3", Leaf.STATE) not in watcher.newest:
                await asyncio.to_thread(publish, publisher)
        async with request_line(hub, "OR-3") as line:
            answer = await line.ask(HubRequest(method="POST", path="/api/alarms/hold", body="{}"))
        assert (answer.status, answer.body) == (200, b"{}")
    finally:
        publisher.close()
        for task in running:
            task.cancel()
        await asyncio.wait(running)


async def acts_as_another(url: str) -> None:
    """What OR-3 publishes under the name of OR-4, and stores of the requests to it, arrives nowhere."""
    async with of(url, "OR-3").connected("OR-3") as own, of(url, "hub").connected("hub") as hub:
        arrived: list[str] = []
        answered = asyncio.Event()

        async def note(message: Msg) -> None:
            arrived.append(message.subject)

        async def answer(message: Msg) -> None:
            await message.respond(b"{}\nfigures of another theatre")
            answered.set()

        await hub.client.subscribe("coaxial.clinic.theatre.OR-4.>", cb=note)
        await hub.client.flush()
        await own.client.subscribe("coaxial.clinic.theatre.OR-3.request", cb=answer)
        await own.client.publish("coaxial.clinic.theatre.OR-4.live", b"{}\n")
        await own.client.publish(
            "coaxial.clinic.theatre.OR-3.request", b"x", reply="coaxial.clinic.theatre.OR-4.live"
        )
        await asyncio.wait_for(answered.wait(), PATIENCE_S)
        await own.client.publish("$JS.API.STREAM.CREATE.X", json.dumps(STREAM).encode())
        for one in (own, hub):
            await one.client.flush()
        assert arrived == []
        with pytest.raises(NotFoundError):
            await hub.jetstream().stream_info("X")


def test_a_theatre_has_what_it_needs_and_cannot_act_as_another_one(tmp_path: Path) -> None:
    with nats_in(tmp_path / "nats", settings=users()) as server:
        asyncio.run(acts_in_theatre(server.url, tmp_path))
        asyncio.run(acts_as_another(server.url))
