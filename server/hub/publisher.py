"""The theatre's process that publishes: takes the newest message as a sink does, and sends what a hub needs.

Each connection starts from nothing: it takes the theatre's name, reads from the stream what was stored
last, and goes on from there. Live messages are sent only on a connection, and never stored here.
"""

import asyncio
import logging
import secrets
import threading
import time
from collections.abc import Callable, Coroutine
from contextlib import suppress
from dataclasses import dataclass
from functools import partial
from pathlib import Path
from typing import Any

import structlog
from nats.aio.msg import Msg
from nats.js.api import Header as NatsHeader
from nats.js.errors import NotFoundError
from nats.js.kv import KeyValue

from server.clock import elapsed_s
from server.hub.claim import RENEW_AFTER_S, Claim
from server.hub.connection import LOST, HubAddress, HubError, Link, unreachable
from server.hub.envelope import Beats, Header, packed
from server.hub.outbox import Outbox
from server.hub.pictures import picture_packed
from server.hub.state import state_of
from server.hub.subjects import STORED, Leaf
from tracker.errors import NavigationError

STATE_PERIOD_S = 0.5
OUTBOX_POLL_S = 0.25
BATCH = 100
FLUSH_TIMEOUT_S = 5
CONNECT_AGAIN_S = 1.0
CLOSE_TIMEOUT_S = 1.5
OUTBOX_ID, OUTBOX_NUMBER = "Coaxial-Outbox", "Coaxial-Number"
log = structlog.get_logger(__name__)


@dataclass(frozen=True, slots=True, kw_only=True)
class Outgoing:
    """The newest message of the theatre.

    Attributes:
        text: A `LiveMessage` as JSON.
        captured_at_s: Capture of its image, monotonic; None without an image.
        picture: A small JPEG of this image; empty where none is due.
    """

    text: str
    captured_at_s: float | None
    picture: bytes = b""


@dataclass(frozen=True, slots=True, kw_only=True)
class PublisherSettings:
    """Settings of the process.

    Attributes:
        address: The NATS server.
        theatre: Name of this theatre.
        home: Folder of the outbox.
        max_rate_hz: Maximum rate of live messages.
    """

    address: HubAddress
    theatre: str
    home: Path
    max_rate_hz: float


class Publisher:
    """Publishes until it is closed; connects again whenever the connection is lost.

    It has the methods of a sink: `receive` and `close`.
    """

    def __init__(self, settings: PublisherSettings) -> None:
        self._settings = settings
        self._outbox = Outbox(settings.home)
        self._period_s = 1.0 / settings.max_rate_hz
        self._next_at_s = 0.0
        self._claim = Claim(settings.theatre, run=secrets.token_hex(8))
        self._numbers = dict.fromkeys(Leaf, 0)
        self._newest: Outgoing | None = None
        self._problem: NavigationError | None = None
        # What it logs reaches the log as our problem, in a sentence.
        logging.getLogger("nats").setLevel(logging.CRITICAL)
        self._loop = asyncio.new_event_loop()
        self._arrived = asyncio.Event()
        self._stop = asyncio.Event()
        self._thread = threading.Thread(target=self._run, name="hub", daemon=True)
        self._thread.start()

    def receive(self, outgoing: Outgoing) -> None:
        """Take the newest message, and return when the next one may come.

        Raises:
            NavigationError: HUB_UNREACHABLE, HUB_NAME_TAKEN and others: why nothing is published now.
        """
        self._loop.call_soon_threadsafe(self._take, outgoing)
        now_s = time.monotonic()
        # A schedule, not a pause: the sender adds its own time.
        self._next_at_s = max(self._next_at_s + self._period_s, now_s)
        time.sleep(self._next_at_s - now_s)
        if self._problem is not None:
            raise self._problem

    def close(self) -> None:
        """Give up the name and disconnect."""
        with suppress(RuntimeError):
            self._loop.call_soon_threadsafe(self._stop.set)
        self._thread.join(CLOSE_TIMEOUT_S)

    def _take(self, outgoing: Outgoing) -> None:
        self._newest = outgoing
        self._arrived.set()

    def _run(self) -> None:
        with asyncio.Runner(loop_factory=lambda: self._loop) as runner:
            runner.run(self._publish())

    async def _publish(self) -> None:
        stopping = asyncio.create_task(self._stop.wait())
        while not self._stop.is_set():
            serving = asyncio.create_task(self._serve_once())
            await asyncio.wait([stopping, serving], return_when=asyncio.FIRST_COMPLETED)
            serving.cancel()
            await asyncio.wait([serving])
            if not self._stop.is_set():
                await asyncio.wait([stopping], timeout=CONNECT_AGAIN_S)
        self._outbox.close()

    async def _serve_once(self) -> None:
        """Publish on one connection, and note why it ended."""
        settings = self._settings
        try:
            async with settings.address.connected(settings.theatre) as link:
                session = _Session(
                    link,
                    settings.theatre,
                    claim=self._claim,
                    outbox=self._outbox,
                    numbers=self._numbers,
                    newest=self._newest_message,
                )
                await session.run(self._works)
        except* HubError as group:
            self._problem = _first(group)
        except* LOST as group:
            self._problem = unreachable(settings.address.url, _first(group))
        except* Exception as group:
            # The outbox's disk, or a fault of ours: neither may end the thread silently.
            log.exception("publishing to the hub failed")
            cause = _first(group)
            reason = f"{type(cause).__name__}: {cause}"
            self._problem = HubError(
                "HUB_FAILED",
                f"publishing to the hub failed: {reason}",
                "The theatre works without it. See the server log.",
                {"library_error": reason},
            )

    def _works(self) -> None:
        self._problem = None

    async def _newest_message(self) -> Outgoing:
        """Wait for the next message."""
        await self._arrived.wait()
        self._arrived.clear()
        assert self._newest is not None  # noqa: S101  it is set with the event
        return self._newest


class _Session:
    """What is published on one connection."""

    def __init__(
        self,
        link: Link,
        theatre: str,
        *,
        claim: Claim,
        outbox: Outbox,
        numbers: dict[Leaf, int],
        newest: Callable[[], Coroutine[Any, Any, Outgoing]],
    ) -> None:
        self._link = link
        self._theatre = theatre
        self._claim = claim
        self._outbox = outbox
        self._numbers = numbers
        self._newest = newest
        self._beats = Beats()

    async def run(self, works: Callable[[], None]) -> None:
        """Publish until the connection or the name is lost; `works` is called when both are there.

        Raises:
            ExceptionGroup: of `HubError` and errors of the connection.
            HubError, nats.errors.Error: the name is taken, or the server does not answer.
        """
        link = self._link
        await link.ensure_stream()
        bucket = await link.claims()
        await self._claim.renew(bucket)
        try:
            await link.client.subscribe(link.address.hospital.beats("*"), cb=self._beat)
            works()
            async with asyncio.TaskGroup() as tasks:
                tasks.create_task(link.until_lost())
                tasks.create_task(self._renew(bucket))
                tasks.create_task(self._publish_live())
                for leaf in STORED:
                    tasks.create_task(self._publish_stored(leaf))
        except asyncio.CancelledError:
            # Stopped, and not cut off: the name is free at once.
            with suppress(*LOST):
                async with asyncio.timeout(CLOSE_TIMEOUT_S / 2.0):
                    await self._claim.release(bucket)
            raise

    async def _renew(self, bucket: KeyValue) -> None:
        while True:
            await asyncio.sleep(RENEW_AFTER_S)
            await self._claim.renew(bucket)

    async def _beat(self, message: Msg) -> None:
        with suppress(ValueError, IndexError):
            self._beats.take(message.subject.split(".")[3], float(message.data), now_s=elapsed_s())

    async def _publish_live(self) -> None:
        state_at_s = 0.0
        while True:
            outgoing = await self._newest()
            if not self._claim.is_held:
                continue
            send = partial(self._send_live, captured_at_s=outgoing.captured_at_s)
            await send(Leaf.LIVE, outgoing.text.encode())
            if outgoing.picture:
                await send(Leaf.PICTURE, picture_packed(outgoing.text, outgoing.picture))
            if elapsed_s() >= state_at_s:
                state_at_s = elapsed_s() + STATE_PERIOD_S
                await send(Leaf.STATE, state_of(outgoing.text).encode())
            # Until the server has read it: buffers of a slow line would hold seconds of old messages.
            await self._link.client.flush(timeout=FLUSH_TIMEOUT_S)

    async def _send_live(self, leaf: Leaf, content: bytes, *, captured_at_s: float | None) -> None:
        self._numbers[leaf] += 1
        header = header_now(
            self._claim.run, self._numbers[leaf], captured_at_s=captured_at_s, beats=self._beats
        )
        await self._link.client.publish(self._subject(leaf), packed(header, content))

    async def _publish_stored(self, leaf: Leaf) -> None:
        """Publish the entries of the outbox one after the other, from after the last one in the stream.

        The sequence that is expected to be the last of the subject makes JetStream reject an entry that came
        on an earlier connection already, however long ago; its window of message ids ends after two minutes.
        """
        jetstream, subject = self._link.jetstream(), self._subject(leaf)
        sequence, number = await self._last_stored(leaf)
        await asyncio.to_thread(self._outbox.acknowledge, leaf, number)
        while True:
            entries = await asyncio.to_thread(self._outbox.after, leaf, number, count=BATCH)
            for entry in entries:
                if not self._claim.is_held:
                    break
                headers = {
                    NatsHeader.MSG_ID: f"{self._outbox.id}-{entry.number}",
                    NatsHeader.EXPECTED_LAST_SUBJECT_SEQUENCE: str(sequence),
                    OUTBOX_ID: self._outbox.id,
                    OUTBOX_NUMBER: str(entry.number),
                }
                stored = await jetstream.publish(subject, entry.content.encode(), headers=headers)
                sequence, number = stored.seq, entry.number
            if entries:
                await asyncio.to_thread(self._outbox.acknowledge, leaf, number)
            else:
                await asyncio.sleep(OUTBOX_POLL_S)

    async def _last_stored(self, leaf: Leaf) -> tuple[int, int]:
        """Return the last sequence of a subject in the stream, and the number of its entry in this outbox.

        Both are 0 without one. An entry of another outbox has the number 0 in this one.
        """
        stream = self._link.address.hospital.stream
        try:
            last = await self._link.jetstream().get_last_msg(stream, self._subject(leaf))
        except NotFoundError:
            return 0, 0
        headers = last.headers or {}
        is_ours = headers.get(OUTBOX_ID) == self._outbox.id
        return last.seq or 0, int(headers.get(OUTBOX_NUMBER, 0)) if is_ours else 0

    def _subject(self, leaf: Leaf) -> str:
        return self._link.address.hospital.subject(self._theatre, leaf)


def header_now(run: str, number: int, *, captured_at_s: float | None, beats: Beats) -> Header:
    """Return the header of a message that is sent now.

    The age is that after the beats were held: between the two clocks the thread may wait for milliseconds,
    which must not be missing in the age at the hub, and may be counted twice.
    """
    echoes = beats.echoes(now_s=elapsed_s())
    age_ms = None if captured_at_s is None else (time.monotonic() - captured_at_s) * 1000.0
    return Header(run=run, number=number, age_ms=age_ms, echoes=echoes)


def _first(group: BaseExceptionGroup[Any]) -> Any:  # noqa: ANN401  one of the errors that the group was made of
    """Return the first error of a group of groups."""
    error: BaseException = group
    while isinstance(error, BaseExceptionGroup):
        error = error.exceptions[0]
    return error
