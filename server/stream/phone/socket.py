"""`WS /ws/camera`: one page sends its camera's images, as many as are granted. Text is JSON with one key.

    page    {"hello": {"key"}}                          first; the key gives it its place back after a loss
    server  {"welcome": {size, rate, quality, ...}}     or {"refused": {code, message, remedy}} and the end
    server  {"note": {"ping", "credit", ...}}           for each image that came, and twice a second
    page    {"pong": {"ping", "at_ms"}}                 at once, with its clock
    page    {"camera": {...}}                           what its browser granted; after each change
    page    {"image": {"bytes", "captured_ms", "clock"}}, then binary messages of at most `part_bytes`

A page of which nothing comes for 3 s is gone; so its place is free for another one.
"""

import asyncio
import contextlib
import time
from dataclasses import dataclass

from starlette.websockets import WebSocket, WebSocketDisconnect

from server.live import LiveHub, Problem
from server.security import person_of
from server.stream.connection import line_of
from server.stream.messages import problem_message
from server.stream.phone.messages import NoteMessage, PhoneTold
from server.stream.phone.receiver import PhoneTaken, Place, Receiver
from server.stream.phone.sender import Received, Sender, hello_in
from server.stream.race import until_one_ends
from server.stream.socket import LONGEST_REASON, REJECTED, TRY_LATER, Misbehaviour
from server.stream.viewers import Stalled, Viewers

NOTE_EVERY_S = 0.5
SILENT_AFTER_S = 3.0
REPLACED = 4409


@dataclass(frozen=True, slots=True, kw_only=True)
class PhoneDoor:
    """What a page that sends images meets.

    Attributes:
        hub: where the newest instant is.
        viewers: knows how long one sending may take.
        receiver: of the images; None where they come from elsewhere.
        source: from where they come.
    """

    hub: LiveHub
    viewers: Viewers
    receiver: Receiver | None
    source: str


async def receive_phone(websocket: WebSocket, door: PhoneDoor) -> None:
    """Receive images until the page goes, falls silent or misbehaves."""
    await websocket.accept()
    receiver = door.receiver
    try:
        if receiver is None:
            await _reject(websocket, door, _not_asked(door.source))
            return
        hello = hello_in(await _text(websocket))
        with receiver.sending(hello.key, person_of(websocket.scope)) as place:
            await _tell(websocket, door, PhoneTold(welcome=receiver.welcome()))
            await _Talk(websocket, door, receiver, place).run()
    except PhoneTaken as taken:
        await _reject(websocket, door, Problem.from_error(taken))
    except Misbehaviour as told:
        with contextlib.suppress(Stalled, WebSocketDisconnect, RuntimeError):
            await door.viewers.send(websocket.close(told.code, told.reason), None)
    except (Stalled, TimeoutError):
        line = line_of(websocket.scope)
        if line is not None:
            # A word of farewell would wait behind what the page does not take.
            line.cut()
        else:
            with contextlib.suppress(WebSocketDisconnect, RuntimeError):
                await websocket.close(TRY_LATER, "nothing came from this page")
    except WebSocketDisconnect:
        return


class _Talk:
    """Both directions of one connection."""

    def __init__(self, websocket: WebSocket, door: PhoneDoor, receiver: Receiver, place: Place) -> None:
        self._websocket = websocket
        self._door = door
        self._receiver = receiver
        self._place = place
        self._sender = Sender()
        self._news = asyncio.Event()
        self._delay_s: float | None = None

    async def run(self) -> None:
        await until_one_ends(self._speak(), self._listen(), self._until_replaced())

    async def _speak(self) -> None:
        while True:
            self._news.clear()
            await _tell(self._websocket, self._door, PhoneTold(note=self._note()))
            with contextlib.suppress(TimeoutError):
                async with asyncio.timeout(NOTE_EVERY_S):
                    await self._news.wait()

    async def _listen(self) -> None:
        while True:
            message = await _received(self._websocket)
            now_s = time.monotonic()
            text, part = message.get("text"), message.get("bytes")
            if isinstance(text, str):
                self._sender.hear(text, now_s)
                continue
            received = self._sender.take_part(part if isinstance(part, bytes) else b"", now_s)
            if received is None:
                continue
            if isinstance(received, Received):
                self._delay_s = received.arrived_s - received.captured_at_s
            self._receiver.deliver(self._place, received)
            self._news.set()

    async def _until_replaced(self) -> None:
        await self._place.replaced.wait()
        raise Misbehaviour(REPLACED, "this page has another connection")

    def _note(self) -> NoteMessage:
        grant, clock, newest = self._sender.grant(time.monotonic()), self._sender.clock, self._door.hub.newest
        problem = self._place.problem
        if problem is None and newest is not None:
            problem = newest.source.problem or newest.process.problem
        return NoteMessage(
            ping=grant.ping,
            credit=grant.credit,
            images=self._receiver.images,
            rate_hz=self._receiver.rate_hz,
            delay_ms=None if self._delay_s is None else self._delay_s * 1000.0,
            clock_error_ms=clock.error_s * 1000.0 if clock.is_known else None,
            source_state=None if newest is None else newest.source.state,
            problem=problem_message(problem),
        )


async def _received(websocket: WebSocket) -> dict[str, object]:
    """The next message.

    Raises:
        TimeoutError: nothing came for too long.
        WebSocketDisconnect: the page is gone.
    """
    async with asyncio.timeout(SILENT_AFTER_S):
        message = await websocket.receive()
    if message["type"] == "websocket.disconnect":
        raise WebSocketDisconnect(message.get("code", 1005))
    return dict(message)


async def _text(websocket: WebSocket) -> str:
    text = (await _received(websocket)).get("text")
    if not isinstance(text, str):
        raise Misbehaviour(REJECTED, "the first message is hello")
    return text


async def _tell(websocket: WebSocket, door: PhoneDoor, told: PhoneTold) -> None:
    text = told.model_dump_json(exclude_unset=True)
    await door.viewers.send(websocket.send_text(text), line_of(websocket.scope))


async def _reject(websocket: WebSocket, door: PhoneDoor, problem: Problem) -> None:
    """Say why in full, because the reason of a close has 123 bytes; then close."""
    with contextlib.suppress(Stalled, WebSocketDisconnect, RuntimeError):
        await _tell(websocket, door, PhoneTold(rejected=problem_message(problem)))
        await websocket.close(REJECTED, problem.message[:LONGEST_REASON])


def _not_asked(source: str) -> Problem:
    return Problem(
        code="PHONE_NOT_ASKED",
        message=f"this server takes its images from {source}, not from a phone",
        remedy="Start it with coaxial run --source phone, or set camera.source to phone in its settings.",
        context={"source": source},
    )
