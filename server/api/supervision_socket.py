"""`WS /ws/room?view=theatre|operator|supervisor`: who is here, what they mark, and what is signed.

The client sends `{"next": true}` and gets one `RoomMessage` as JSON text: at once when something is new, else
after a second, so that silence means that the line is gone. One message is on the way at a time; what changed
meanwhile is told together, and what was told is not told again. How long the client takes to ask for the next
one is how its line does.

Supervisors and the operator may also send `point`, `lift`, `draw`, `extend`, `undo` and `clear` (`Said`). Who
sends what it may not, or too much of it, is closed with 1008 or 1009 and the reason in words.
"""

import asyncio

import structlog
from pydantic import ValidationError
from starlette.websockets import WebSocket

from server.api.supervision_messages import Said, room_message
from server.security import person_of
from server.stream.connection import line_of
from server.stream.errors import TooManyViewers
from server.stream.socket import REJECTED, TRY_LATER, Misbehaviour, converse, turn_away
from server.stream.viewers import ViewerKind, Viewers
from server.supervision import Lobby, Unfair, View
from server.supervision.lobby import HEARTBEAT_S, MIN_BETWEEN_S, Waiting
from server.supervision.marks import Moment
from server.supervision.room import RoomFull
from server.supervision.told import Told

_log = structlog.get_logger(__name__)


async def sit_in_room(websocket: WebSocket, *, lobby: Lobby, viewers: Viewers) -> None:
    """Be in the room until the client goes, misbehaves or stalls."""
    await websocket.accept()
    asked = websocket.query_params.get("view", "")
    if asked not in set(View):
        await websocket.close(REJECTED, f"view is one of {', '.join(View)}")
        return
    person = person_of(websocket.scope)
    try:
        with (
            viewers.watching(ViewerKind.ROOM, person=person),
            lobby.seated(person, View(asked)) as here,
        ):
            await _talk(websocket, lobby, viewers, here)
    except TooManyViewers as full:
        await turn_away(websocket, full)
    except RoomFull as full:
        await websocket.close(TRY_LATER, str(full))


async def _talk(websocket: WebSocket, lobby: Lobby, viewers: Viewers, here: Waiting) -> None:
    line, granted, told = line_of(websocket.scope), asyncio.Event(), Told()
    loop = asyncio.get_running_loop()

    async def speak() -> None:
        sent_at_s = -HEARTBEAT_S
        while True:
            await granted.wait()
            await _until_news(here.woken, sent_at_s + HEARTBEAT_S - loop.time())
            await asyncio.sleep(max(0.0, sent_at_s + MIN_BETWEEN_S - loop.time()))
            granted.clear()
            here.woken.clear()
            message = room_message(told.news(lobby.picture()), seat=here.seat)
            sent_at_s, here.seat.sent_at_s = loop.time(), lobby.now_s
            await viewers.send(websocket.send_text(message.model_dump_json()), line)

    def hear(text: str) -> None:
        said = _said(text)
        if said.next:
            here.seat.answered(lobby.now_s)
            granted.set()
            return
        try:
            _do(said, lobby, here)
        except Unfair as unfair:
            _log.warning("room_misused", by=here.seat.person.name, why=str(unfair))
            raise Misbehaviour(REJECTED, str(unfair)) from unfair
        lobby.changed()

    await converse(websocket, viewers, speak=speak, hear=hear)


async def _until_news(woken: asyncio.Event, max_s: float) -> None:
    try:
        async with asyncio.timeout(max(0.0, max_s)):
            await woken.wait()
    except TimeoutError:
        return


def _said(text: str) -> Said:
    try:
        return Said.model_validate_json(text, strict=True)
    except ValidationError as error:
        raise Misbehaviour(REJECTED, f"not understood: {error.errors()[0]['msg']}"[:120]) from None


def _do(said: Said, lobby: Lobby, here: Waiting) -> None:
    room, seat, now_s = lobby.room, here.seat, lobby.now_s
    if said.point is not None:
        moment = Moment(image_number=said.point.image_number, captured_at_s=said.point.captured_at_s)
        x, y = said.point.at_px
        room.point(seat, (x, y), moment, lobby.shown, now_s=now_s)
    elif said.draw is not None:
        _draw(said, lobby, here)
    elif said.extend is not None:
        points = [(x, y) for x, y in said.extend.points_px]
        room.extend(seat, said.extend.key, points, lobby.shown, now_s=now_s)
    elif said.undo:
        if room.undo(seat, now_s=now_s):
            _log.info("drawing_taken_back", by=seat.person.name)
    elif said.clear is not None:
        gone = room.clear(seat, everybodys=said.clear == "all", now_s=now_s)
        _log.info("drawings_cleared", by=seat.person.name, whose=said.clear, drawings=gone)
    else:
        room.lift(seat, now_s=now_s)


def _draw(said: Said, lobby: Lobby, here: Waiting) -> None:
    """Nothing of a drawing is kept but who made it, when, and on which image."""
    draw = said.draw
    if draw is None:
        return
    moment = Moment(image_number=draw.image_number, captured_at_s=draw.captured_at_s)
    points = [(x, y) for x, y in draw.points_px]
    seat = here.seat
    if lobby.room.draw(seat, draw.key, draw.shape, points, moment, lobby.shown, now_s=lobby.now_s):
        _log.info(
            "drawn",
            by=seat.person.name,
            role=seat.person.role.value,
            shape=draw.shape.value,
            image_number=draw.image_number,
        )
