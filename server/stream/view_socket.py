"""`WS /ws/view`: image and pose of one instant in one message, each asked for by the client.

The client sends `{"next": true}` and gets one binary message:

    4 bytes    length of the header, unsigned, little endian
    header     a `LiveMessage` as JSON, UTF-8
    the rest   the JPEG of that same instant; empty when there is no image

Then it may ask again. So one image is on the way at a time, and a thin line carries fewer images instead of
older ones. A second `{"next": true}` before the answer changes nothing. `{"next": true, "showing_ms": 12}`
also says how long the client needed to show the last image: that time does not count against its line.
`{"size": "half"}` asks for another size from the next image on: full, half, quarter, or auto for the one that
the line carries. `{"largest": "half"}`: with auto, send none larger, because the client cannot show it.

Picture and pose cannot belong to different images, and the client sets the rate. MJPEG has neither, and
browsers show a part only when the next one begins; it remains for programs that show pictures only.
"""

import asyncio
import json
import math
import struct
import time
from dataclasses import dataclass

from starlette.websockets import WebSocket

from server.live import Instant, LiveHub
from server.security import person_of
from server.stream.connection import line_of
from server.stream.errors import TooManyViewers
from server.stream.fitting.pictures import Pictures
from server.stream.fitting.sizes import Choice, Size
from server.stream.fitting.texts import Texts
from server.stream.socket import REJECTED, Misbehaviour, converse, turn_away
from server.stream.viewers import Viewer, ViewerKind, Viewers

HEADER_LENGTH = struct.Struct("<I")
GRANT = {"next": True}
UNDERSTOOD = (
    'only {"next": true, "showing_ms"?: 0 or more}, {"size": ...} and {"largest": ...} are understood'
)


@dataclass(frozen=True, slots=True, kw_only=True)
class View:
    """What all who watch in this way have in common.

    Attributes:
        hub: where the newest instant is.
        viewers: who watches.
        pictures, texts: of each instant, made once for all.
    """

    hub: LiveHub
    viewers: Viewers
    pictures: Pictures
    texts: Texts


class Granting:
    """What the client allows and wants.

    Attributes:
        granted: whether the next image may be sent.
        at_s: when that was said last; monotonic.
        showing_s: how long the client says that it needed to show the last image.
    """

    def __init__(self, viewer: Viewer) -> None:
        self._viewer = viewer
        self.granted = asyncio.Event()
        self.at_s = 0.0
        self.showing_s = 0.0

    def hear(self, text: str) -> None:
        """One message of the client.

        Raises:
            Misbehaviour: it is not understood.
        """
        try:
            said = json.loads(text)
        except (ValueError, RecursionError):
            said = None
        if not isinstance(said, dict):
            raise Misbehaviour(REJECTED, UNDERSTOOD)
        if list(said) == ["size"] and said["size"] in list(Choice):
            self._viewer.pace.choose(Choice(said["size"]))
        elif list(said) == ["largest"] and said["largest"] in list(Size):
            self._viewer.pace.limit(Size(said["largest"]))
        elif said.pop("next", None) is True and (showing_ms := _showing_ms(said)) is not None:
            self.at_s, self.showing_s = time.monotonic(), showing_ms / 1000.0
            self.granted.set()
        else:
            raise Misbehaviour(REJECTED, UNDERSTOOD)

    def line_free_at_s(self, *, drained_at_s: float) -> float:
        """When the line had carried the last image; monotonic.

        That is before the client began to show it, and not before its last byte had left this machine.
        """
        return min(self.at_s, max(drained_at_s, self.at_s - self.showing_s))


def _showing_ms(rest: dict[str, object]) -> float | None:
    """How long the client says that it needed, 0 where it says nothing; None for what is not understood."""
    showing_ms = rest.pop("showing_ms", 0.0)
    if rest or isinstance(showing_ms, bool) or not isinstance(showing_ms, int | float):
        return None
    return float(showing_ms) if math.isfinite(showing_ms) and showing_ms >= 0.0 else None


async def view_message(view: View, instant: Instant, viewer: Viewer) -> bytes:
    """Header length, header and JPEG of one instant, in the size that this viewer has now."""
    size = viewer.pace.size
    jpeg = await view.pictures.of(instant, size)
    header = view.texts.of(instant, size=size, now_s=time.monotonic()).encode()
    return b"".join((HEADER_LENGTH.pack(len(header)), header, jpeg))


async def watch_view(websocket: WebSocket, view: View, *, choice: Choice = Choice.AUTO) -> None:
    """Answer each grant of the client with the newest instant that it has not had, until it goes.

    One that grants but takes nothing for 2 s is cut off; one that sends anything else is closed with 1008.
    """
    await websocket.accept()
    try:
        with view.viewers.watching(ViewerKind.VIEW, choice, person=person_of(websocket.scope)) as viewer:
            await _show(websocket, view, viewer)
    except TooManyViewers as full:
        await turn_away(websocket, full)


async def _show(websocket: WebSocket, view: View, viewer: Viewer) -> None:
    line, granting = line_of(websocket.scope), Granting(viewer)

    async def speak() -> None:
        began_s: float | None = None
        drained_at_s = 0.0
        while True:
            await granting.granted.wait()
            newest = view.hub.newest
            if began_s is not None and newest is not None:
                # Until the client asks again, but for what it needed itself: that is not its line's.
                missed = max(0, newest.sequence - viewer.sequence - 1)
                free_at_s = granting.line_free_at_s(drained_at_s=drained_at_s)
                viewer.pace.sent(began_s=began_s, ended_s=free_at_s, missed=missed)
            instant = await view.hub.next_after(viewer.sequence)
            granting.granted.clear()
            viewer.took(instant.sequence)
            content = await view_message(view, instant, viewer)
            began_s = time.monotonic()
            await view.viewers.send(websocket.send_bytes(content), line)
            drained_at_s = time.monotonic()

    await converse(websocket, view.viewers, speak=speak, hear=granting.hear)
