"""What the WebSockets have in common: one task speaks, one listens, and who misbehaves is told why."""

import asyncio
import contextlib
from collections.abc import Callable, Coroutine

from starlette.websockets import WebSocket, WebSocketDisconnect

from server.stream.connection import line_of
from server.stream.errors import TooManyViewers
from server.stream.race import until_one_ends
from server.stream.viewers import Stalled, Viewers

LARGEST_MESSAGE_BYTES = 1024
MESSAGES_A_SECOND = 240

REJECTED, TOO_LARGE, TRY_LATER = 1008, 1009, 1013
# A farewell holds no more than 123 bytes.
LONGEST_REASON = 120


class Misbehaviour(Exception):
    """A client sent what it may not; it is told this, and goes."""

    def __init__(self, code: int, reason: str) -> None:
        super().__init__(reason)
        self.code = code
        self.reason = reason


async def converse(
    websocket: WebSocket,
    viewers: Viewers,
    *,
    speak: Callable[[], Coroutine[None, None, None]],
    hear: Callable[[str], None],
) -> None:
    """Run both directions of an accepted socket until the client goes, misbehaves or stalls.

    Args:
        websocket: accepted already.
        viewers: knows how long one sending may take.
        speak: sends for ever; Stalled ends the line.
        hear: takes one text message of at most 1 kB.
    """
    try:
        await until_one_ends(speak(), _listen(websocket, hear))
    except WebSocketDisconnect:
        return
    except Misbehaviour as told:
        with contextlib.suppress(Stalled, WebSocketDisconnect, RuntimeError):
            await viewers.send(websocket.close(told.code, told.reason), None)
    except Stalled:
        line = line_of(websocket.scope)
        if line is not None:
            # A word of farewell would wait behind what the client does not take.
            line.cut()
        else:
            with contextlib.suppress(Stalled, WebSocketDisconnect, RuntimeError):
                await viewers.send(websocket.close(TRY_LATER, "too slow"), None)
        raise


async def turn_away(websocket: WebSocket, full: TooManyViewers) -> None:
    """Say to an accepted socket that there is no place for it: before that, a browser shows no page why."""
    with contextlib.suppress(WebSocketDisconnect, RuntimeError):
        await websocket.close(TRY_LATER, full.message[:LONGEST_REASON])


async def _listen(websocket: WebSocket, hear: Callable[[str], None]) -> None:
    """Hand on what comes, as long as it is small, text, and not too much of it."""
    loop = asyncio.get_running_loop()
    second, in_second = loop.time(), 0
    while True:
        message = await websocket.receive()
        if message["type"] == "websocket.disconnect":
            raise WebSocketDisconnect(message.get("code", 1005))
        text = message.get("text")
        if text is None:
            raise Misbehaviour(REJECTED, "only text messages are understood")
        if len(text) > LARGEST_MESSAGE_BYTES:
            raise Misbehaviour(TOO_LARGE, f"messages may have at most {LARGEST_MESSAGE_BYTES} characters")
        if loop.time() - second >= 1.0:
            second, in_second = loop.time(), 0
        in_second += 1
        if in_second > MESSAGES_A_SECOND:
            raise Misbehaviour(REJECTED, f"at most {MESSAGES_A_SECOND} messages a second are taken")
        hear(text)
