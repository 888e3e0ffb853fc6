"""`WS /ws/camera`: one page sends its camera's images, limited by a credit. Text is JSON with one key.

    page    {"hello": {"key"}}                          first; with the key it keeps its slot after a loss
    server  {"welcome": {size, rate, quality, ...}}     or {"rejected": {code, message, remedy}} and a close
    server  {"note": {"ping", "credit", ...}}           for each received image, and twice a second
    page    {"pong": {"ping", "at_ms"}}                 at once, with the page's clock
    page    {"camera": {...}}                           settings granted by the browser; after each change
    page    {"image": {"bytes", "captured_ms", "clock"}}, then binary messages of at most `part_bytes`

A page that sends nothing for 3 s is disconnected, which frees its slot.
"""

import asyncio
import contextlib
import time
from dataclasses import dataclass

from starlette.websockets import WebSocket, WebSocketDisconnect

from server.live import LiveHub, Problem
from server.security import person_of
from server.stream.connection import connection_of
from server.stream.messages import problem_message
from server.stream.phone.messages import NoteMessage, PhoneServerMessage
from server.stream.phone.receiver import PhoneTaken, Receiver, SenderSlot
from server.stream.phone.sender import Received, Sender, parse_hello
from server.stream.socket import MAX_REASON_BYTES, REJECTED, TRY_LATER, ProtocolViolation
from server.stream.tasks import run_until_first_ends
from server.stream.viewers import Stalled, Viewers

NOTE_EVERY_S = 0.5
SILENT_AFTER_S = 3.0
REPLACED = 4409


@dataclass(frozen=True, slots=True, kw_only=True)
class PhoneEndpoint:
    """Parts of the endpoint for a sending page.

    Attributes:
        hub: has the newest instant.
        viewers: has the timeout of one send.
        receiver: receives the images; None for another source.
        source: name of the configured source.
    """

    hub: LiveHub
    viewers: Viewers
    receiver: Receiver | None
    source: str


async def receive_phone(websocket: WebSocket, endpoint: PhoneEndpoint) -> None:
    """Receive images until the page disconnects, falls silent or violates the protocol."""
    await websocket.accept()
    receiver = endpoint.receiver
    try:
        if receiver is None:
            await _reject(websocket, endpoint, _not_selected(endpoint.source))
            return
        hello = parse_hello(await _text(websocket))
        with receiver.sending(hello.key, person_of(websocket.scope)) as slot:
            await _send(websocket, endpoint, PhoneServerMessage(welcome=receiver.welcome()))
            await _PhoneConnection(websocket, endpoint, receiver, slot).run()
    except PhoneTaken as taken:
        await _reject(websocket, endpoint, Problem.from_error(taken))
    except ProtocolViolation as violation:
        with contextlib.suppress(Stalled, WebSocketDisconnect, RuntimeError):
            await endpoint.viewers.send(websocket.close(violation.code, violation.reason), None)
    except (Stalled, TimeoutError):
        connection = connection_of(websocket.scope)
        if connection is not None:
            # A close frame would wait behind data that the page does not read.
            connection.abort()
        else:
            with contextlib.suppress(WebSocketDisconnect, RuntimeError):
                await websocket.close(TRY_LATER, "this page sent nothing")
    except WebSocketDisconnect:
        return


class _PhoneConnection:
    """Both directions of one connection."""

    def __init__(
        self, websocket: WebSocket, endpoint: PhoneEndpoint, receiver: Receiver, slot: SenderSlot
    ) -> None:
        self._websocket = websocket
        self._endpoint = endpoint
        self._receiver = receiver
        self._slot = slot
        self._sender = Sender()
        self._news = asyncio.Event()
        self._delay_s: float | None = None

    async def run(self) -> None:
        await run_until_first_ends(self._send_notes(), self._listen(), self._until_replaced())

    async def _send_notes(self) -> None:
        while True:
            self._news.clear()
            await _send(self._websocket, self._endpoint, PhoneServerMessage(note=self._note()))
            with contextlib.suppress(TimeoutError):
                async with asyncio.timeout(NOTE_EVERY_S):
                    await self._news.wait()

    async def _listen(self) -> None:
        while True:
            message = await _received(self._websocket)
            now_s = time.monotonic()
            text, part = message.get("text"), message.get("bytes")
            if isinstance(text, str):
                self._sender.receive_text(text, now_s)
                continue
            received = self._sender.take_part(part if isinstance(part, bytes) else b"", now_s)
            if received is None:
                continue
            if isinstance(received, Received):
                self._delay_s = received.arrived_s - received.captured_at_s
            self._receiver.deliver(self._slot, received)
            self._news.set()

    async def _until_replaced(self) -> None:
        await self._slot.replaced.wait()
        raise ProtocolViolation(REPLACED, "this page has another connection")

    def _note(self) -> NoteMessage:
        update, clock, newest = (
            self._sender.update_credit(time.monotonic()),
            self._sender.clock,
            self._endpoint.hub.newest,
        )
        problem = self._slot.problem
        if problem is None and newest is not None:
            problem = newest.source.problem or newest.process.problem
        return NoteMessage(
            ping=update.ping,
            credit=update.credit,
            images=self._receiver.images,
            rate_hz=self._receiver.rate_hz,
            delay_ms=None if self._delay_s is None else self._delay_s * 1000.0,
            clock_error_ms=clock.error_s * 1000.0 if clock.is_known else None,
            source_state=None if newest is None else newest.source.state,
            problem=problem_message(problem),
        )


async def _received(websocket: WebSocket) -> dict[str, object]:
    """Return the next message.

    Raises:
        TimeoutError: Nothing arrived within the timeout.
        WebSocketDisconnect: The page has disconnected.
    """
    async with asyncio.timeout(SILENT_AFTER_S):
        message = await websocket.receive()
    if message["type"] == "websocket.disconnect":
        raise WebSocketDisconnect(message.get("code", 1005))
    return dict(message)


async def _text(websocket: WebSocket) -> str:
    text = (await _received(websocket)).get("text")
    if not isinstance(text, str):
        raise ProtocolViolation(REJECTED, "the first message must be hello")
    return text


async def _send(websocket: WebSocket, endpoint: PhoneEndpoint, message: PhoneServerMessage) -> None:
    text = message.model_dump_json(exclude_unset=True)
    await endpoint.viewers.send(websocket.send_text(text), connection_of(websocket.scope))


async def _reject(websocket: WebSocket, endpoint: PhoneEndpoint, problem: Problem) -> None:
    """Send the full problem, because the reason of a close has 123 bytes; then close."""
    with contextlib.suppress(Stalled, WebSocketDisconnect, RuntimeError):
        await _send(websocket, endpoint, PhoneServerMessage(rejected=problem_message(problem)))
        await websocket.close(REJECTED, problem.message[:MAX_REASON_BYTES])


def _not_selected(source: str) -> Problem:
    return Problem(
        code="PHONE_NOT_SELECTED",
        message=f"the image source of this server is {source}, not a phone",
        remedy="Start it with coaxial run --source phone, or set camera.source to phone in its settings.",
        context={"source": source},
    )
