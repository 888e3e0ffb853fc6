"""`WS /ws/live`: one JSON message for each instant, for machines and for whoever needs no picture."""

import time

from starlette.websockets import WebSocket

from server.live import LiveHub
from server.security import person_of
from server.stream.connection import line_of
from server.stream.errors import TooManyViewers
from server.stream.fitting.texts import Texts
from server.stream.socket import REJECTED, Misbehaviour, converse, turn_away
from server.stream.viewers import Viewer, ViewerKind, Viewers


async def watch_live(websocket: WebSocket, *, hub: LiveHub, viewers: Viewers, texts: Texts) -> None:
    """Send a `LiveMessage` as text for each instant, the newest at once, until the client goes.

    Newest wins: a slow client skips instants, and sees how many by the gaps in `sequence`. One that takes
    nothing for 2 s is cut off. Instants without a snapshot are sent too: they say why there is none.
    The client sends nothing; one that does is closed with 1008.
    """
    await websocket.accept()
    try:
        with viewers.watching(ViewerKind.LIVE, person=person_of(websocket.scope)) as viewer:
            await _tell(websocket, viewer, hub=hub, viewers=viewers, texts=texts)
    except TooManyViewers as full:
        await turn_away(websocket, full)


async def _tell(
    websocket: WebSocket, viewer: Viewer, *, hub: LiveHub, viewers: Viewers, texts: Texts
) -> None:
    line = line_of(websocket.scope)

    async def speak() -> None:
        while True:
            instant = await hub.next_after(viewer.sequence)
            viewer.took(instant.sequence)
            text = texts.of(instant, now_s=time.monotonic())
            await viewers.send(websocket.send_text(text), line)

    await converse(websocket, viewers, speak=speak, hear=_hear_nothing)


def _hear_nothing(_text: str) -> None:
    raise Misbehaviour(REJECTED, "this socket only sends; open /ws/view to ask for images")
