"""Many theatres and supervisors on one NATS server that is killed, with lines that are cut and a slow reader.

    PYTHONPATH=. python -m tests.benchmarks.hub [--theatres 40] [--supervisors 200] [--seconds 70] [--rate 30]

Each theatre is a real publisher with an outbox; messages are those of a snapshot with figures. Each
supervisor is a connection to the NATS server that follows one theatre. All run on this computer, so that the
true age of each message is known, and compared with the age that the reader states. Alarms are stored all the
time, also while the server is gone; at the end the stream is compared with the outboxes.
"""

import argparse
import asyncio
import contextlib
import json
import multiprocessing
import secrets
import signal
import socket
import tempfile
import threading
import time
from collections import Counter
from collections.abc import Sequence
from dataclasses import dataclass, field
from multiprocessing.process import BaseProcess
from multiprocessing.queues import Queue
from pathlib import Path

from nats.aio.msg import Msg

from server.clock import elapsed_s
from server.hub.connection import HubAddress
from server.hub.outbox import Outbox
from server.hub.publisher import OUTBOX_ID, OUTBOX_NUMBER, Outgoing, Publisher, PublisherSettings
from server.hub.subjects import Hospital, Leaf
from server.hub.watcher import Watcher
from server.stream.messages import live_message
from tests.benchmarks.machine import machine_line
from tests.benchmarks.tables import Table, number, percentile
from tests.nats_server import NatsServer
from tests.server.conftest import make_instant, make_snapshot
from tracker.errors import NavigationError

HOSPITAL = Hospital("benchmark")
PICTURE = bytes(secrets.token_bytes(9000))
PICTURE_PERIOD_S, ALARM_PERIOD_S = 0.5, 1.0
PROCESSES = 2
# Theatres whose line leads through the relay, which is cut.
RELAYED_RATIO = 0.25
SLOW_READ_S = 0.25
# Python and 200 connections start on two cores.
WARM_UP_S = 25.0
CATCH_UP_S = 60.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Phase:
    """A part of the run, in seconds of `elapsed_s`."""

    name: str
    from_s: float
    to_s: float


@dataclass(slots=True)
class Heard:
    """What the supervisors of a process received.

    Attributes:
        ages_ms: True age of each live message at its arrival, by phase.
        excess_ms: Stated age minus true age, by phase.
        unmeasured: Messages whose age could not be stated, by phase.
        understated: Messages whose stated age was below the true one by more than a clock's digit.
        pictures: Pictures received, by phase.
        backward: Messages that are older than one that the same supervisor has received before.
    """

    ages_ms: dict[str, list[float]] = field(default_factory=dict)
    excess_ms: dict[str, list[float]] = field(default_factory=dict)
    unmeasured: Counter[str] = field(default_factory=Counter)
    understated: int = 0
    pictures: Counter[str] = field(default_factory=Counter)
    backward: int = 0


class Supervisor(Watcher):
    """A reader that follows one theatre, and compares the stated ages with the true ones."""

    def __init__(
        self, address: HubAddress, theatre: str, *, clock_of: Watcher, phases: Sequence[Phase], heard: Heard
    ) -> None:
        super().__init__(address, (Leaf.LIVE, Leaf.PICTURE), theatre=theatre, clock_of=clock_of)
        self._phases = phases
        self._heard = heard
        self._last: dict[str, int] = {}
        self.slow_s = 0.0

    async def _take(self, message: Msg) -> None:
        now_s = elapsed_s()
        await super()._take(message)
        phase = next((one.name for one in self._phases if one.from_s <= now_s < one.to_s), None)
        if self.slow_s:
            time.sleep(self.slow_s)
            phase = "slow reader" if phase else None
        if phase is None:
            return
        if message.subject.endswith(Leaf.PICTURE):
            self._heard.pictures[phase] += 1
            return
        newest = self.newest[self._theatre, Leaf.LIVE]
        if newest.number <= self._last.get(newest.run, 0):
            self._heard.backward += 1
        self._last[newest.run] = newest.number
        # The member that the theatre of this benchmark puts first.
        true_ms = (now_s - float(newest.content[12 : newest.content.index(b",")])) * 1000.0
        stated_ms = newest.arrival.image_age_ms(now_s=now_s)
        self._heard.ages_ms.setdefault(phase, []).append(true_ms)
        if stated_ms is None:
            self._heard.unmeasured[phase] += 1
            return
        self._heard.excess_ms.setdefault(phase, []).append(stated_ms - true_ms)
        self._heard.understated += stated_ms < true_ms - 0.01


def run_theatres(
    names: Sequence[str], urls: Sequence[str], folder: Path, rate_hz: float, until_s: float
) -> None:
    """Publish these theatres, with an alarm a second each, until a time; then until all is stored."""
    text = live_message(make_instant(1, snapshot=make_snapshot(judged=True)), now_s=0.0).model_dump_json()

    def run(name: str, url: str) -> None:
        home = folder / name
        home.mkdir(exist_ok=True)
        outbox = Outbox(home)
        publisher = Publisher(
            PublisherSettings(
                address=HubAddress(url=url, hospital=HOSPITAL), theatre=name, home=home, max_rate_hz=rate_hz
            )
        )
        picture_at_s = alarm_at_s = elapsed_s()
        appended = 0
        while (now_s := elapsed_s()) < until_s + CATCH_UP_S and (now_s < until_s or outbox.waiting):
            if alarm_at_s <= now_s < until_s:
                alarm_at_s += ALARM_PERIOD_S
                appended += 1
                outbox.append(Leaf.ALARM, [json.dumps({"appended": appended, "at_s": now_s})])
            picture = b""
            if now_s >= picture_at_s:
                picture_at_s, picture = now_s + PICTURE_PERIOD_S, PICTURE
            with contextlib.suppress(NavigationError):
                publisher.receive(
                    Outgoing(
                        text=f'{{"captured":{now_s:.6f},{text[1:]}',
                        captured_at_s=now_s + time.monotonic() - elapsed_s(),
                        picture=picture,
                    )
                )
        publisher.close()
        outbox.close()

    threads = [threading.Thread(target=run, args=pair) for pair in zip(names, urls, strict=True)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()


def run_supervisors(
    url: str, theatres: Sequence[str], phases: Sequence[Phase], slow: bool, results: "Queue[Heard]"
) -> None:
    """Follow these theatres, each by a supervisor of its own, until the last phase has ended."""
    heard = Heard()

    async def run() -> None:
        address = HubAddress(url=url, hospital=HOSPITAL)
        hub = Watcher(address, (Leaf.STATE,))
        watchers: list[Watcher] = [hub]
        for theatre in theatres:
            one = Supervisor(address, theatre, clock_of=hub, phases=phases, heard=heard)
            one.slow_s = SLOW_READ_S if slow else 0.0
            watchers.append(one)
        tasks = [asyncio.create_task(one.run()) for one in watchers]
        await asyncio.sleep(phases[-1].to_s - elapsed_s())
        for task in tasks:
            task.cancel()
        await asyncio.wait(tasks)

    asyncio.run(run())
    results.put(heard)


class Relay:
    """A line between theatres and server that can be cut: nothing passes, and nobody is told."""

    def __init__(self, port: int) -> None:
        self._to = port
        self._is_cut = threading.Event()
        self._listener = socket.create_server(("127.0.0.1", 0))
        self.port: int = self._listener.getsockname()[1]
        threading.Thread(target=self._accept, daemon=True).start()

    def cut(self, cut: bool) -> None:
        """Cut or mend the line; connections of before do not come back."""
        (self._is_cut.set if cut else self._is_cut.clear)()

    def _accept(self) -> None:
        while True:
            near, _ = self._listener.accept()
            try:
                far = socket.create_connection(("127.0.0.1", self._to))
            except OSError:
                near.close()
                continue
            for one, other in ((near, far), (far, near)):
                threading.Thread(target=self._carry, args=(one, other), daemon=True).start()

    def _carry(self, one: socket.socket, other: socket.socket) -> None:
        with contextlib.suppress(OSError):
            while (content := one.recv(65536)) and not self._is_cut.is_set():
                other.sendall(content)
        while self._is_cut.is_set():
            time.sleep(0.05)
        for end in (one, other):
            with contextlib.suppress(OSError):
                end.shutdown(socket.SHUT_RDWR)
            end.close()


async def stored_entries(url: str) -> list[tuple[str, str, int, str]]:
    """Theatre, outbox, number and content of each alarm in the stream, in its order."""
    found: list[tuple[str, str, int, str]] = []
    async with HubAddress(url=url, hospital=HOSPITAL).connected("reader") as link:
        reading = await link.jetstream().subscribe(HOSPITAL.subject("*", Leaf.ALARM), ordered_consumer=True)
        count = (await reading.consumer_info()).num_pending or 0
        count += reading.pending_msgs
        while len(found) < count:
            message = await reading.next_msg(timeout=10.0)
            headers = message.headers or {}
            theatre = message.subject.split(".")[3]
            found.append((theatre, headers[OUTBOX_ID], int(headers[OUTBOX_NUMBER]), message.data.decode()))
    return found


def memory_mb(pid: int) -> float:
    """Resident memory of a process."""
    status = Path(f"/proc/{pid}/status").read_text()
    return int(next(line.split()[1] for line in status.splitlines() if line.startswith("VmRSS"))) / 1024.0


def second_of_one_name(url: str, folder: Path, name: str) -> str:
    """Return what a second theatre of a name is answered; empty if it may publish."""
    folder.mkdir()
    address = HubAddress(url=url, hospital=HOSPITAL)
    publisher = Publisher(PublisherSettings(address=address, theatre=name, home=folder, max_rate_hz=30.0))
    answer = ""
    for _ in range(60):
        try:
            publisher.receive(Outgoing(text="{}", captured_at_s=None))
        except NavigationError as error:
            answer = error.code
            break
    publisher.close()
    return answer


def main() -> None:
    """Run everything, and print the tables."""
    parser = argparse.ArgumentParser(
        description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    parser.add_argument("--theatres", type=int, default=40)
    parser.add_argument("--supervisors", type=int, default=200)
    parser.add_argument("--seconds", type=float, default=70.0)
    parser.add_argument("--rate", type=float, default=30.0)
    given = parser.parse_args()
    with tempfile.TemporaryDirectory() as folder:
        measure(given, Path(folder))


def measure(given: argparse.Namespace, folder: Path) -> None:
    """Run the phases one after the other, and print."""
    context = multiprocessing.get_context("spawn")
    server = NatsServer(folder / "nats")
    server.start()
    relay = Relay(server.port)
    names = [f"OR-{number + 1}" for number in range(given.theatres)]
    relayed = set(names[: round(RELAYED_RATIO * len(names))])
    urls = {name: f"nats://127.0.0.1:{relay.port if name in relayed else server.port}" for name in names}
    length_s = given.seconds / 5.0
    start_s = elapsed_s() + WARM_UP_S
    phases = [
        Phase(name=name, from_s=start_s + place * length_s, to_s=start_s + (place + 1) * length_s)
        for place, name in enumerate(
            ("undisturbed", "server killed", "lines cut", "theatres killed", "after all of it")
        )
    ]
    theatres = [names[place::PROCESSES] for place in range(PROCESSES)]
    results: Queue[Heard] = context.Queue()

    def start_theatres(group: Sequence[str]) -> BaseProcess:
        own = [urls[name] for name in group]
        process = context.Process(
            target=run_theatres, args=(group, own, folder, given.rate, phases[-1].to_s), daemon=True
        )
        process.start()
        return process

    publishing = [start_theatres(group) for group in theatres]
    followed = [names[place % len(names)] for place in range(given.supervisors)]
    groups = [(followed[place::PROCESSES], False) for place in range(PROCESSES)] + [([names[-1]], True)]
    reading = [
        context.Process(target=run_supervisors, args=(server.url, group, phases, slow, results), daemon=True)
        for group, slow in groups
    ]
    for process in reading:
        process.start()
    memory: dict[str, list[float]] = {}

    def sample() -> None:
        for kind, pids in (
            ("NATS server", [server.pid]),
            ("theatres", [one.pid for one in publishing]),
            ("supervisors", [one.pid for one in reading[:-1]]),
        ):
            memory.setdefault(kind, []).append(sum(memory_mb(pid) for pid in pids if pid is not None))

    wait_until(phases[0].from_s + 0.9 * length_s)
    sample()
    answer = second_of_one_name(server.url, folder / "second", names[0])
    wait_until(phases[1].from_s)
    server.kill()
    wait_until(phases[1].from_s + 3.0)
    server.start()
    wait_until(phases[2].from_s)
    relay.cut(True)
    wait_until(phases[2].from_s + 0.4 * length_s)
    relay.cut(False)
    wait_until(phases[3].from_s)
    publishing[0].kill()
    publishing[0].join()
    publishing[0] = start_theatres(theatres[0])
    wait_until(phases[-1].to_s - 1.0)
    sample()
    heard = [results.get(timeout=120.0) for _ in reading]
    for process in [*reading, *publishing]:
        process.join()
    print_tables(given, phases, heard, memory, answer)
    print_stored(names, folder, asyncio.run(stored_entries(server.url)))
    server.kill()


def wait_until(at_s: float) -> None:
    """Wait until a time of `elapsed_s`."""
    time.sleep(max(0.0, at_s - elapsed_s()))


def print_tables(
    given: argparse.Namespace,
    phases: Sequence[Phase],
    heard: Sequence[Heard],
    memory: dict[str, list[float]],
    answer: str,
) -> None:
    """Print messages, ages and memory."""
    rows = []
    spans_s = {one.name: one.to_s - one.from_s for one in phases}
    for name in (*spans_s, "slow reader"):
        span_s = spans_s.get(name, sum(spans_s.values()))
        ages = [age for one in heard for age in one.ages_ms.get(name, ())]
        excess = [value for one in heard for value in one.excess_ms.get(name, ())]
        pictures = sum(one.pictures[name] for one in heard)
        rows.append(
            [
                name,
                number(len(ages) / span_s, 0),
                number(pictures / span_s, 0),
                *(number(percentile(ages, percent), 1) for percent in (50, 99, 100)),
                *(number(percentile(excess, percent), 1) for percent in (50, 99)),
                str(sum(one.unmeasured[name] for one in heard)),
            ]
        )
    wanted = given.supervisors * given.rate
    print(  # noqa: T201
        Table(
            title=f"{given.theatres} theatres, {given.supervisors} supervisors",
            columns=(
                "phase", "live/s", "pictures/s", "age ms median", "p99", "maximum",
                "stated too old ms median", "p99", "age not stated",
            ),
            rows=rows,
            note=f"{machine_line()} All of it would be {wanted:.0f} live messages a second. "
            f"Ages stated too young: {sum(one.understated for one in heard)}. "
            f"Messages older than one received before: "
            f"{sum(one.backward for one in heard)}. "
            f"A second theatre of one name: {answer or 'it published'}.",
        ).markdown
    )  # fmt: skip
    print(  # noqa: T201
        Table(
            title="Resident memory, MB",
            columns=("processes", "undisturbed", "at the end"),
            rows=[[kind, *(number(value, 0) for value in values)] for kind, values in memory.items()],
            note=f"Theatres and supervisors: {PROCESSES} processes each, with their Python.",
        ).markdown
    )


def print_stored(names: Sequence[str], folder: Path, found: Sequence[tuple[str, str, int, str]]) -> None:
    """Compare the stream with the outboxes, and print."""
    lost = waiting = twice = disordered = appended = 0
    for name in names:
        outbox = Outbox(folder / name)
        written = {entry.number: entry.content for entry in outbox.after(Leaf.ALARM, 0, count=10**6)}
        waiting += outbox.waiting
        own = [(entry[2], entry[3]) for entry in found if entry[:2] == (name, outbox.id)]
        numbers = [entry[0] for entry in own]
        appended += len(written)
        lost += len(written.items() - set(own))
        twice += len(numbers) - len(set(numbers))
        disordered += numbers != sorted(numbers)
        outbox.close()
    print(  # noqa: T201
        Table(
            title="Alarms in the stream",
            columns=(
                "written by theatres",
                "in the stream",
                "not acknowledged",
                "lost",
                "twice",
                "out of order",
            ),
            rows=[[str(value) for value in (appended, len(found), waiting, lost, twice, disordered)]],
        ).markdown
    )


if __name__ == "__main__":
    signal.signal(signal.SIGTERM, signal.default_int_handler)
    main()
