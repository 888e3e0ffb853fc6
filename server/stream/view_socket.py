"""`WS /ws/view`: image and pose of one instant in one message, each requested by the client.

The client sends `{"next": true}` and gets one binary message:

    4 bytes    length of the header, unsigned, little endian
    header     a `LiveMessage` as JSON, UTF-8
    the rest   the JPEG of that same instant; empty when there is no image

Then it may send the next request. So one image is in flight at a time, and a slow connection gets fewer
images instead of older ones. A second `{"next": true}` before the answer has no effect. `{"next": true,
"showing_ms": 12}` also reports how long the client needed to display the last image: that time does not count
against its connection. `{"size": "half"}` requests another size from the next image on: full, half, quarter,
or auto for the one that suits the connection. `{"largest": "half"}`: with auto, send none larger, because the
client cannot display it. `{"interval_ms": 50}`: send images at least this far apart, on average, because the
client has no time for more; a message without an image and a change of an alarm are sent at once.

Picture and pose cannot belong to different images, and the client sets the rate. MJPEG has neither property,
and browsers display a part only when the next one begins; it remains for programs that show pictures only.
"""

import asyncio
import json
import math
import struct
import time
from dataclasses import dataclass
from typing import TypeGuard

from starlette.websockets import WebSocket

from server.live import Instant, LiveHub
from server.overlay import OverlayContent
from server.security import person_of
from server.stream.connection import connection_of
from server.stream.errors import TooManyViewers
from server.stream.scaling.message_cache import MessageCache
from server.stream.scaling.picture_cache import PictureCache
from server.stream.scaling.sizes import PictureSize, SizeChoice
from server.stream.socket import REJECTED, ProtocolViolation, reject_viewer, run_duplex
from server.stream.viewers import Viewer, ViewerKind, Viewers

HEADER_LENGTH = struct.Struct("<I")
NEXT_REQUEST = {"next": True}
EXPECTED_MESSAGES = (
    'only {"next": true, "showing_ms"?: ms}, {"size": s}, {"largest": s} and {"interval_ms": 0 to 1000}'
)
MAX_INTERVAL_MS = 1000.0
# A page that was asleep reports how long.
MAX_SHOWING_MS = 1e12


@dataclass(frozen=True, slots=True, kw_only=True)
class ViewContext:
    """Shared parts of all connections.

    Attributes:
        hub: has the newest instant.
        viewers: registry of viewers.
        pictures, texts: of each instant, made once for all.
    """

    hub: LiveHub
    viewers: Viewers
    pictures: PictureCache
    texts: MessageCache


class ImagePace:
    """Selects images that are at least `interval_s` apart, on average.

    With 33 ms between images an interval of 50 ms selects two of three images, whereas a fixed distance would
    select every second one. A pause of the camera is not made up for.
    """

    def __init__(self) -> None:
        self.interval_s = 0.0
        self._due_s = -math.inf
        self._alarm_revision = -1

    def takes(self, instant: Instant) -> bool:
        """Return whether this instant is sent; call it once for each."""
        changed = instant.alarms.revision != self._alarm_revision
        self._alarm_revision = instant.alarms.revision
        if instant.snapshot is None or self.interval_s == 0.0:
            return True
        captured_at_s = instant.snapshot.captured_at_s
        if captured_at_s < self._due_s and not changed:
            return False
        is_late = captured_at_s - self._due_s >= self.interval_s
        self._due_s = (captured_at_s if is_late else self._due_s) + self.interval_s
        return True


class ViewRequests:
    """Requests of the client.

    Attributes:
        requested: set while the next image may be sent.
        at_s: time of the last request, monotonic.
        showing_s: time that the client reported for displaying the last image.
        pace: spacing of the images that the client requested.
    """

    def __init__(self, viewer: Viewer) -> None:
        self._viewer = viewer
        self.requested = asyncio.Event()
        self.at_s = 0.0
        self.showing_s = 0.0
        self.pace = ImagePace()

    def receive_text(self, text: str) -> None:
        """Handle one message of the client.

        Raises:
            ProtocolViolation: it is invalid.
        """
        try:
            message = json.loads(text)
        except (ValueError, RecursionError):
            message = None
        if not isinstance(message, dict):
            raise ProtocolViolation(REJECTED, EXPECTED_MESSAGES)
        if list(message) == ["size"] and message["size"] in list(SizeChoice):
            self._viewer.adaptive_size.choose(SizeChoice(message["size"]))
        elif list(message) == ["largest"] and message["largest"] in list(PictureSize):
            self._viewer.adaptive_size.limit(PictureSize(message["largest"]))
        elif list(message) == ["interval_ms"] and _is_number(message["interval_ms"], MAX_INTERVAL_MS):
            self.pace.interval_s = message["interval_ms"] / 1000.0
        elif message.pop("next", None) is True and (showing_ms := _showing_ms(message)) is not None:
            self.at_s, self.showing_s = time.monotonic(), showing_ms / 1000.0
            self.requested.set()
        else:
            raise ProtocolViolation(REJECTED, EXPECTED_MESSAGES)

    def connection_free_at_s(self, *, drained_at_s: float) -> float:
        """Return when the connection had delivered the last image, monotonic.

        That is before the client began to display it, and not before its last byte had left this machine.
        """
        return min(self.at_s, max(drained_at_s, self.at_s - self.showing_s))


def _showing_ms(rest: dict[str, object]) -> float | None:
    """Return the reported display time, 0 without one; None for an invalid message."""
    showing_ms = rest.pop("showing_ms", 0.0)
    return None if rest or not _is_number(showing_ms, MAX_SHOWING_MS) else float(showing_ms)


def _is_number(value: object, maximum: float) -> TypeGuard[float]:
    """Return whether this is a number from 0 to the maximum."""
    if isinstance(value, bool) or not isinstance(value, int | float):
        return False
    # Compared as it is, because an integer may be too long for a float.
    return 0.0 <= value <= maximum


async def view_message(view: ViewContext, instant: Instant, viewer: Viewer, overlay: OverlayContent) -> bytes:
    """Return header length, header and JPEG of one instant, in the viewer's present size."""
    size = viewer.adaptive_size.size
    jpeg = await view.pictures.of(instant, size, overlay)
    header = view.texts.of(instant, size=size, now_s=time.monotonic()).encode()
    return b"".join((HEADER_LENGTH.pack(len(header)), header, jpeg))


async def watch_view(
    websocket: WebSocket,
    view: ViewContext,
    *,
    choice: SizeChoice = SizeChoice.AUTO,
    overlay: OverlayContent = OverlayContent.FULL,
) -> None:
    """Answer each request of the client with the newest instant not sent to it yet, until it disconnects.

    A client that requests but reads nothing for 2 s is disconnected; one that sends anything else is closed
    with 1008.
    """
    await websocket.accept()
    try:
        with view.viewers.register(ViewerKind.VIEW, choice, person=person_of(websocket.scope)) as viewer:
            await _show(websocket, view, viewer, overlay)
    except TooManyViewers as full:
        await reject_viewer(websocket, full)


async def _show(websocket: WebSocket, view: ViewContext, viewer: Viewer, overlay: OverlayContent) -> None:
    connection, requests = connection_of(websocket.scope), ViewRequests(viewer)

    async def send() -> None:
        began_s: float | None = None
        drained_at_s = 0.0
        while True:
            await requests.requested.wait()
            newest = view.hub.newest
            if began_s is not None and newest is not None:
                # Until the next request, minus the client's own display time, which is not the connection's.
                missed = max(0, newest.sequence - viewer.sequence - 1)
                free_at_s = requests.connection_free_at_s(drained_at_s=drained_at_s)
                viewer.adaptive_size.sent(began_s=began_s, ended_s=free_at_s, missed=missed)
            instant = await view.hub.next_after(viewer.sequence)
            while not requests.pace.takes(instant):
                instant = await view.hub.next_after(instant.sequence)
            requests.requested.clear()
            viewer.mark_taken(instant.sequence)
            content = await view_message(view, instant, viewer, overlay)
            began_s = time.monotonic()
            await view.viewers.send(websocket.send_bytes(content), connection)
            drained_at_s = time.monotonic()

    await run_duplex(websocket, view.viewers, send=send, receive_text=requests.receive_text)
