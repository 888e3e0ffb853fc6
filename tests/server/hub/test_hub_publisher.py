"""A theatre and a NATS server: nothing stored is lost or stored twice, and names are not shared."""

import asyncio
import json
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import ExitStack, contextmanager
from dataclasses import replace
from pathlib import Path

import pytest

from server.hub.connection import HubAddress
from server.hub.outbox import Outbox
from server.hub.pictures import picture_unpacked
from server.hub.publisher import OUTBOX_NUMBER, Outgoing, Publisher, PublisherSettings
from server.hub.state import state_of
from server.hub.subjects import Hospital, Leaf
from server.hub.watcher import Received, Watcher
from server.live import Instant
from server.security.tls.self_signed import load_or_create
from server.stream.messages import live_message
from tests.nats_server import NatsServer, nats_in
from tests.server.conftest import make_instant, make_snapshot
from tracker.errors import NavigationError

PATIENCE_S = 60.0
HOSPITAL = Hospital("clinic")
USERS = """
authorization { users: [
  { user: "OR-1", password: "one", permissions: {
      publish: ["coaxial.clinic.theatre.OR-1.>", "$KV.coaxial_clinic.OR-1",
        "$JS.API.STREAM.INFO.*", "$JS.API.STREAM.MSG.GET.*", "$JS.API.DIRECT.GET.>"],
      subscribe: ["_INBOX_OR-1.>", "coaxial.clinic.hub.*.beat"] } }
  { user: "hub", password: "two" }
] }
"""


def live_text(instant: Instant | None = None) -> str:
    instant = instant or make_instant(1, snapshot=make_snapshot(judged=True))
    return live_message(instant, now_s=0.0).model_dump_json()


@pytest.fixture(scope="module")
def server(tmp_path_factory: pytest.TempPathFactory) -> Iterator[NatsServer]:
    with nats_in(tmp_path_factory.mktemp("nats")) as running:
        yield running


class Theatre:
    """A theatre that publishes, of which the test gives each message."""

    def __init__(self, folder: Path, address: HubAddress, name: str) -> None:
        folder.mkdir(exist_ok=True)
        self.outbox = Outbox(folder)
        settings = PublisherSettings(address=address, theatre=name, home=folder, max_rate_hz=60.0)
        self.publisher = Publisher(settings)
        self.text = live_text()

    def problem(self) -> NavigationError | None:
        try:
            self.publisher.receive(
                Outgoing(text=self.text, captured_at_s=time.monotonic() - 0.25, picture=b"jpeg")
            )
        except NavigationError as error:
            return error
        return None

    def until(self, true: Callable[[], object]) -> None:
        """Send messages until it is true."""
        deadline_s = time.monotonic() + PATIENCE_S
        while not true():
            problem = self.problem()
            assert time.monotonic() < deadline_s, f"it did not become true: {problem}"

    def close(self) -> None:
        self.publisher.close()
        self.outbox.close()


@pytest.fixture
def theatre(tmp_path: Path, server: NatsServer) -> Iterator[Callable[..., Theatre]]:
    with ExitStack() as stack:

        def make(name: str, *, folder: str = "home", address: HubAddress | None = None) -> Theatre:
            address = address or HubAddress(url=server.url, hospital=HOSPITAL)
            made = Theatre(tmp_path / folder, address, name)
            stack.callback(made.close)
            return made

        yield make


def stored(address: HubAddress, name: str, leaf: Leaf) -> list[tuple[int, str]]:
    """Number and content of all messages of a subject in the stream, in its order."""

    async def read() -> list[tuple[int, str]]:
        async with address.connected("reader") as link:
            jetstream = link.jetstream()
            subject = address.hospital.subject(name, leaf)
            reading = await jetstream.subscribe(subject, ordered_consumer=True)
            found: list[tuple[int, str]] = []
            while not found or (await reading.consumer_info()).num_pending or reading.pending_msgs:
                message = await reading.next_msg(timeout=10.0)
                found.append((int((message.headers or {})[OUTBOX_NUMBER]), message.data.decode()))
            return found

    return asyncio.run(read())


def create(address: HubAddress) -> None:
    """Create stream and bucket, which a theatre's user may not."""

    async def run() -> None:
        async with address.connected("admin") as link:
            await link.ensure_stream()
            await link.claims()

    asyncio.run(run())


@contextmanager
def watching(address: HubAddress, *leaves: Leaf) -> Iterator[Watcher]:
    """A hub in a thread."""
    loop = asyncio.new_event_loop()
    watcher = Watcher(address, leaves)
    running = loop.create_task(watcher.run())
    thread = threading.Thread(target=lambda: loop.run_until_complete(asyncio.wait([running])))
    thread.start()
    try:
        yield watcher
    finally:
        loop.call_soon_threadsafe(running.cancel)
        thread.join()
        loop.close()


def test_a_hub_gets_state_numbers_and_picture_and_knows_how_old_they_are(
    server: NatsServer, theatre: Callable[..., Theatre]
) -> None:
    address = HubAddress(url=server.url, hospital=HOSPITAL)
    with watching(address, Leaf.STATE, Leaf.LIVE, Leaf.PICTURE) as watcher:
        running = theatre("OR-3")

        def measured(leaf: Leaf) -> Received | None:
            one = watcher.newest.get(("OR-3", leaf))
            return one if one is not None and one.arrival.transfer_ms is not None else None

        running.until(lambda: all(map(measured, (Leaf.STATE, Leaf.LIVE, Leaf.PICTURE))))
        live, picture = measured(Leaf.LIVE), measured(Leaf.PICTURE)
    assert live is not None
    assert picture is not None
    assert json.loads(live.content) == json.loads(running.text)
    text, jpeg = picture_unpacked(picture.content)
    assert (json.loads(text), jpeg) == (json.loads(running.text), b"jpeg")
    age_ms = live.arrival.image_age_ms(now_s=live.arrival.arrived_s)
    assert age_ms is not None
    assert age_ms >= 250.0


def test_the_state_for_the_list_of_theatres_has_no_figures() -> None:
    state = json.loads(state_of(live_text()))
    assert state["verdict"] is not None
    assert state["title"] is None
    without = json.loads(state_of(live_text(make_instant(1))))
    assert (without["verdict"], without["has_image"]) == (None, False)
    assert without["title"]["de"]


def test_after_an_outage_the_theatre_catches_up_and_nothing_is_stored_twice(
    tmp_path: Path, theatre: Callable[..., Theatre]
) -> None:
    with nats_in(tmp_path / "nats") as own:
        address = HubAddress(url=own.url, hospital=HOSPITAL)
        running = theatre("OR-1", address=address)
        running.outbox.append(Leaf.ALARM, [f"before {i}" for i in range(150)])
        running.outbox.append(Leaf.AUDIT, ["head"])
        # Killed while it stores them.
        running.until(lambda: running.outbox.waiting < 151)
        own.kill()
        running.until(lambda: (problem := running.problem()) and "Connect call failed" in problem.message)
        problem = running.problem()
        assert problem is not None
        assert problem.code == "HUB_UNREACHABLE"
        running.outbox.append(Leaf.ALARM, ["meanwhile"])
        own.start()
        running.until(lambda: running.outbox.waiting == 0)
        # As a theatre that was killed: it knows nothing but its outbox.
        running.close()
        again = theatre("OR-1", address=address)
        again.outbox.append(Leaf.ALARM, ["after"])
        again.until(lambda: again.outbox.waiting == 0)
        found = stored(address, "OR-1", Leaf.ALARM)
    assert [content for _, content in found] == [
        *(f"before {i}" for i in range(150)), "meanwhile", "after",
    ]  # fmt: skip
    numbers = [number for number, _ in found]
    assert numbers == sorted(set(numbers))


def test_what_the_server_lost_after_it_had_acknowledged_it_is_sent_again(
    tmp_path: Path, theatre: Callable[..., Theatre]
) -> None:
    with nats_in(tmp_path / "first") as own:
        running = theatre("OR-1", address=HubAddress(url=own.url, hospital=HOSPITAL))
        running.outbox.append(Leaf.ALARM, ["one", "two"])
        running.until(lambda: running.outbox.waiting == 0)
        running.close()
    with nats_in(tmp_path / "second") as empty:
        address = HubAddress(url=empty.url, hospital=HOSPITAL)
        again = theatre("OR-1", address=address)
        again.outbox.append(Leaf.ALARM, ["three"])
        again.until(lambda: again.outbox.waiting == 0)
        assert [content for _, content in stored(address, "OR-1", Leaf.ALARM)] == ["one", "two", "three"]


def test_the_second_theatre_of_one_name_publishes_nothing_until_the_first_is_gone(
    server: NatsServer, theatre: Callable[..., Theatre]
) -> None:
    address = HubAddress(url=server.url, hospital=HOSPITAL)
    first = theatre("OR-2")
    first.outbox.append(Leaf.ALARM, ["of the first"])
    first.until(lambda: first.outbox.waiting == 0)
    second = theatre("OR-2", folder="other")
    second.outbox.append(Leaf.ALARM, ["of the second"])
    second.until(lambda: second.problem() is not None)
    problem = second.problem()
    assert problem is not None
    assert problem.code == "HUB_NAME_TAKEN"
    assert "a theatre OR-2 publishes already, from " in problem.message
    assert second.outbox.waiting == 1
    assert [content for _, content in stored(address, "OR-2", Leaf.ALARM)] == ["of the first"]
    # It gives the name up when it is stopped.
    first.close()
    second.until(lambda: second.outbox.waiting == 0)
    assert [content for _, content in stored(address, "OR-2", Leaf.ALARM)] == [
        "of the first",
        "of the second",
    ]


def test_a_theatre_publishes_by_tls_and_under_its_own_name_only(
    tmp_path: Path, theatre: Callable[..., Theatre]
) -> None:
    made = load_or_create(tmp_path / "tls", host="127.0.0.1")
    tls = f'tls {{ cert_file: "{made.certificate}", key_file: "{made.key}" }}'
    with nats_in(tmp_path / "nats", settings=USERS + tls) as own:
        url = own.url.replace("nats://", "tls://")
        create(HubAddress(url=url, hospital=HOSPITAL, user=("hub", "two"), ca=made.certificate))
        address = HubAddress(url=url, hospital=HOSPITAL, user=("OR-1", "one"), ca=made.certificate)
        known = theatre("OR-1", address=address)
        known.outbox.append(Leaf.ALARM, ["stored"])
        known.until(lambda: known.outbox.waiting == 0)
        stranger = theatre("OR-9", folder="other", address=address)
        stranger.until(lambda: stranger.problem() is not None)
        problem = stranger.problem()
        assert problem is not None
        assert problem.code == "HUB_UNREACHABLE"
        assert "permissions violation" in problem.message
        distrustful = theatre("OR-1", folder="third", address=replace(address, ca=None))
        distrustful.until(lambda: (problem := distrustful.problem()) and "CERTIFICATE" in problem.message)
