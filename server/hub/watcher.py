"""The hub: the newest message of each theatre on each live subject, and how old it is at most.

Nothing is queued: of two messages only the newer one is stored.
"""

import asyncio
import secrets
from collections import deque
from contextlib import suppress
from dataclasses import dataclass, replace

from nats.aio.msg import Msg

from server.clock import elapsed_s
from server.hub.connection import LOST, HubAddress, HubError, Link, unreachable
from server.hub.delays import MAX_HELD_S, Arrival, arrival_of
from server.hub.envelope import unpacked
from server.hub.subjects import Leaf, is_theatre_name, theatre_of

BEAT_PERIOD_S = 0.2
# Those of the time for which a theatre may hold one, and of a transfer.
MAX_BEATS = round((MAX_HELD_S + 5.0) / BEAT_PERIOD_S)
CONNECT_AGAIN_S = 1.0
# A hub that is too slow for more loses messages; it must not show old ones.
MAX_WAITING = 64


@dataclass(frozen=True, slots=True, kw_only=True)
class Received:
    """The newest message of a subject.

    Attributes:
        run: Run of the theatre's process that sent it.
        number: Its number in this run.
        content: JSON or JPEG.
        arrival: When it arrived, and how old it was then.
    """

    run: str
    number: int
    content: bytes
    arrival: Arrival


class Watcher:
    """Receives live messages of theatres, and sends them this hub's clock. For one event loop.

    Attributes:
        newest: The newest message by theatre and subject.
        id: Of the clock by which delays are measured.
        messages: Number of messages received.
        beats: Those that this hub has sent of late; no other one measures a delay.
        problem: Why nothing is received now; None while connected.

    Args:
        address: The NATS server.
        leaves: Subjects to receive.
        theatre: The theatre; `*` for all.
        clock_of: Another hub in this process, whose beats measure the delays; None to send own ones.
        creates_storage: Whether it creates stream and bucket where they are missing, which a theatre's user
            may not: who may create streams can store the requests to other theatres.
    """

    def __init__(
        self,
        address: HubAddress,
        leaves: tuple[Leaf, ...],
        *,
        theatre: str = "*",
        clock_of: "Watcher | None" = None,
        creates_storage: bool = False,
    ) -> None:
        self.id = secrets.token_hex(4) if clock_of is None else clock_of.id
        # Whoever may send beats could send one of the future under our id, which would make messages young.
        self.beats: deque[float] = deque(maxlen=MAX_BEATS) if clock_of is None else clock_of.beats
        self.newest: dict[tuple[str, Leaf], Received] = {}
        self.messages = 0
        self.problem: HubError | None = None
        self._address = address
        self._leaves = leaves
        self._theatre = theatre
        self._sends_beats = clock_of is None
        self._creates_storage = creates_storage
        self._arrived = asyncio.Event()

    async def run(self) -> None:
        """Receive until cancelled; connects again whenever the connection is lost."""
        while True:
            try:
                async with self._address.connected(f"hub-{secrets.token_hex(4)}") as link:
                    await self._watch(link)
            except HubError as error:
                self.problem = error
            except LOST as error:
                self.problem = unreachable(self._address.url, error)
            await asyncio.sleep(CONNECT_AGAIN_S)

    async def next_after(self, theatre: str, leaf: Leaf, seen: Received | None) -> Received:
        """Wait for a message of a subject other than `seen`, and return the newest."""
        while (newest := self.newest.get((theatre, leaf))) is None or newest is seen:
            await self._arrived.wait()
        return newest

    async def _watch(self, link: Link) -> None:
        hospital = link.address.hospital
        for leaf in self._leaves:
            await link.client.subscribe(
                hospital.subject(self._theatre, leaf), cb=self._take, pending_msgs_limit=MAX_WAITING
            )
        if self._creates_storage:
            # Live messages arrive also without JetStream.
            with suppress(*LOST):
                await link.ensure_stream()
                await link.claims()
        self.problem = None
        if not self._sends_beats:
            await link.until_lost()
        while not link.closed.is_set():
            self.beats.append(elapsed_s())
            await link.client.publish(hospital.beats(self.id), repr(self.beats[-1]).encode())
            with suppress(TimeoutError):
                await asyncio.wait_for(link.closed.wait(), BEAT_PERIOD_S)
        await link.until_lost()

    async def _take(self, message: Msg) -> None:
        now_s = elapsed_s()
        try:
            header, content = unpacked(message.data)
        except ValueError:
            return
        self.messages += 1
        echo = header.echoes.get(self.id)
        if echo is not None and echo.beat_s not in self.beats:
            header = replace(header, echoes={})
        theatre = theatre_of(message.subject)
        if not is_theatre_name(theatre):
            return
        key = (theatre, Leaf(message.subject.rsplit(".", 1)[1]))
        self.newest[key] = Received(
            run=header.run,
            number=header.number,
            content=content,
            arrival=arrival_of(header, self.id, now_s=now_s),
        )
        self._arrived.set()
        self._arrived = asyncio.Event()
