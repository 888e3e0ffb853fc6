"""`WS /ws/live`: one JSON message per instant, for programs and clients without a picture."""

import time

from starlette.websockets import WebSocket

from server.live import LiveHub
from server.security import person_of
from server.stream.connection import connection_of
from server.stream.errors import TooManyViewers
from server.stream.scaling.message_cache import MessageCache
from server.stream.socket import REJECTED, ProtocolViolation, reject_viewer, run_duplex
from server.stream.viewers import Viewer, ViewerKind, Viewers


async def watch_live(websocket: WebSocket, *, hub: LiveHub, viewers: Viewers, texts: MessageCache) -> None:
    """Send a `LiveMessage` as text for each instant, the newest at once, until the client disconnects.

    Newest wins: a slow client skips instants, and sees how many by the gaps in `sequence`. A client that
    reads nothing for 2 s is disconnected. Instants without a snapshot are sent too: they contain the reason.
    The client sends nothing; one that does is closed with 1008.
    """
    await websocket.accept()
    try:
        with viewers.register(ViewerKind.LIVE, person=person_of(websocket.scope)) as viewer:
            await _send_messages(websocket, viewer, hub=hub, viewers=viewers, texts=texts)
    except TooManyViewers as full:
        await reject_viewer(websocket, full)


async def _send_messages(
    websocket: WebSocket, viewer: Viewer, *, hub: LiveHub, viewers: Viewers, texts: MessageCache
) -> None:
    connection = connection_of(websocket.scope)

    async def send() -> None:
        while True:
            instant = await hub.next_after(viewer.sequence)
            viewer.mark_taken(instant.sequence)
            text = texts.of(instant, now_s=time.monotonic())
            await viewers.send(websocket.send_text(text), connection)

    await run_duplex(websocket, viewers, send=send, receive_text=_reject_message)


def _reject_message(_text: str) -> None:
    raise ProtocolViolation(REJECTED, "this socket only sends; open /ws/view to request images")
