"""`WS /ws/view`: image and pose of one instant in one message, each asked for by the client.

The client sends `{"next": true}` and gets one binary message:

    4 bytes    length of the header, unsigned, little endian
    header     a `LiveMessage` as JSON, UTF-8
    the rest   the JPEG of that same instant; empty when there is no image

Then it may ask again. So one image is on the way at a time, and a thin line carries fewer images instead of
older ones. A second `{"next": true}` before the answer changes nothing.
"""

import asyncio
import json
import struct
import time

from starlette.websockets import WebSocket

from server.live import Instant, LiveHub
from server.stream.connection import line_of
from server.stream.messages import live_message
from server.stream.socket import REFUSED, Misbehaviour, converse
from server.stream.viewers import ViewerKind, Viewers

HEADER_LENGTH = struct.Struct("<I")
GRANT = {"next": True}


def view_message(instant: Instant, *, now_s: float) -> bytes:
    """Header length, header and JPEG of one instant, as sent at monotonic time `now_s`."""
    header = live_message(instant, now_s=now_s).model_dump_json().encode()
    return b"".join((HEADER_LENGTH.pack(len(header)), header, instant.jpeg))


async def watch_view(websocket: WebSocket, *, hub: LiveHub, viewers: Viewers) -> None:
    """Answer each grant of the client with the newest instant that it has not had, until it goes.

    One that grants but takes nothing for 2 s is cut off; one that sends anything else is closed with 1008.
    """
    await websocket.accept()
    line = line_of(websocket.scope)
    granted = asyncio.Event()
    with viewers.watching(ViewerKind.VIEW) as viewer:

        async def speak() -> None:
            while True:
                await granted.wait()
                instant = await hub.next_after(viewer.sequence)
                granted.clear()
                viewer.took(instant.sequence)
                content = view_message(instant, now_s=time.monotonic())
                await viewers.send(websocket.send_bytes(content), line)

        def hear(text: str) -> None:
            if not _is_grant(text):
                raise Misbehaviour(REFUSED, 'only {"next": true} is understood')
            granted.set()

        await converse(websocket, viewers, speak=speak, hear=hear)


def _is_grant(text: str) -> bool:
    try:
        return bool(json.loads(text) == GRANT)
    except (ValueError, RecursionError):
        return False
