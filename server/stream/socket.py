"""Common parts of the WebSockets: a sending and a receiving task, and limits for client messages."""

import asyncio
import contextlib
from collections.abc import Callable, Coroutine

from starlette.websockets import WebSocket, WebSocketDisconnect

from server.stream.connection import connection_of
from server.stream.errors import TooManyViewers
from server.stream.tasks import run_until_first_ends
from server.stream.viewers import Stalled, Viewers

MAX_MESSAGE_BYTES = 1024
MAX_MESSAGES_PER_SECOND = 240

REJECTED, TOO_LARGE, TRY_LATER = 1008, 1009, 1013
# The reason of a close frame has at most 123 bytes.
MAX_REASON_BYTES = 120


class ProtocolViolation(Exception):
    """A client violated the protocol; the connection is closed with this code and reason."""

    def __init__(self, code: int, reason: str) -> None:
        super().__init__(reason)
        self.code = code
        self.reason = reason


async def run_duplex(
    websocket: WebSocket,
    viewers: Viewers,
    *,
    send: Callable[[], Coroutine[None, None, None]],
    receive_text: Callable[[str], None],
) -> None:
    """Run both directions of an accepted socket until the client disconnects, misbehaves or stalls.

    Args:
        websocket: accepted already.
        viewers: has the timeout of one send.
        send: sends forever; Stalled ends the connection.
        receive_text: handles one text message of at most 1 kB.
    """
    try:
        await run_until_first_ends(send(), _listen(websocket, receive_text))
    except WebSocketDisconnect:
        return
    except ProtocolViolation as violation:
        with contextlib.suppress(Stalled, WebSocketDisconnect, RuntimeError):
            await viewers.send(websocket.close(violation.code, violation.reason), None)
    except Stalled:
        connection = connection_of(websocket.scope)
        if connection is not None:
            # A close frame would wait behind data that the client does not read.
            connection.abort()
        else:
            with contextlib.suppress(Stalled, WebSocketDisconnect, RuntimeError):
                await viewers.send(websocket.close(TRY_LATER, "too slow"), None)
        raise


async def reject_viewer(websocket: WebSocket, full: TooManyViewers) -> None:
    """Close an accepted socket, with the reason: before accepting, a browser gives a page no reason."""
    with contextlib.suppress(WebSocketDisconnect, RuntimeError):
        await websocket.close(TRY_LATER, full.message[:MAX_REASON_BYTES])


async def _listen(websocket: WebSocket, receive_text: Callable[[str], None]) -> None:
    """Pass on text messages within the limits of size and rate."""
    loop = asyncio.get_running_loop()
    second, in_second = loop.time(), 0
    while True:
        message = await websocket.receive()
        if message["type"] == "websocket.disconnect":
            raise WebSocketDisconnect(message.get("code", 1005))
        text = message.get("text")
        if text is None:
            raise ProtocolViolation(REJECTED, "only text messages are accepted")
        if len(text) > MAX_MESSAGE_BYTES:
            raise ProtocolViolation(TOO_LARGE, f"messages may have at most {MAX_MESSAGE_BYTES} characters")
        if loop.time() - second >= 1.0:
            second, in_second = loop.time(), 0
        in_second += 1
        if in_second > MAX_MESSAGES_PER_SECOND:
            raise ProtocolViolation(
                REJECTED, f"at most {MAX_MESSAGES_PER_SECOND} messages per second are accepted"
            )
        receive_text(text)
