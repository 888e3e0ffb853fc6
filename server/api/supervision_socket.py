"""`WS /ws/room?view=theatre|operator|supervisor&lang=en|de`: people, pointers, drawings and signatures.

The client sends `{"next": true}` and receives one `RoomMessage` as JSON text: at once after a change,
otherwise after a second as a heartbeat. One message is in flight at a time; changes are combined, and
unchanged parts are not repeated. The time until the next request of the client measures its connection.

Supervisors and the operator may also send `point`, `lift`, `draw`, `extend`, `undo` and `clear`
(`ClientMessage`). Marks are made on the video image or, with a plane, on a cut of the CT.
Every page may send `look`, what it shows, which is neither logged nor recorded.
Commands without permission, or too many, close the connection with 1008 or 1009.
"""

import asyncio
import json

import structlog
from pydantic import ValidationError
from starlette.websockets import WebSocket

from server.api.supervision_messages import ClientMessage, cut_plane, look_of, room_message
from server.security import Person, person_of
from server.stream.connection import connection_of
from server.stream.errors import TooManyViewers
from server.stream.socket import REJECTED, TRY_LATER, ProtocolViolation, reject_viewer, run_duplex
from server.stream.viewers import ViewerKind, Viewers
from server.supervision import RoomHub, RoomPolicyViolation, View
from server.supervision.marks import Moment
from server.supervision.participants import RoomSession
from server.supervision.room import RoomFull
from server.supervision.room_hub import HEARTBEAT_S, MIN_INTERVAL_S, RoomSubscription
from server.supervision.room_updates import SentState
from server.texts import set_requested_language

_log = structlog.get_logger(__name__)


async def serve_room(websocket: WebSocket, *, room_hub: RoomHub, viewers: Viewers) -> None:
    """Serve a client in the room until it disconnects, stalls, or sends an invalid message."""
    await websocket.accept()
    requested_view = websocket.query_params.get("view", "")
    if requested_view not in set(View):
        await websocket.close(REJECTED, f"view must be one of {', '.join(View)}")
        return
    # A browser sends the languages that it prefers; its page may be in another one.
    stated = websocket.query_params.get("lang") or websocket.headers.get("accept-language", "")
    set_requested_language(stated)
    person = person_of(websocket.scope)
    try:
        with (
            viewers.register(ViewerKind.ROOM, person=person),
            room_hub.join(person, View(requested_view)) as here,
        ):
            await _talk(websocket, room_hub, viewers, here)
    except TooManyViewers as full:
        await reject_viewer(websocket, full)
    except RoomFull as full:
        await websocket.close(TRY_LATER, str(full))


async def _talk(websocket: WebSocket, room_hub: RoomHub, viewers: Viewers, here: RoomSubscription) -> None:
    line, requested, sent = connection_of(websocket.scope), asyncio.Event(), SentState()
    loop = asyncio.get_running_loop()

    async def send() -> None:
        sent_at_s = -HEARTBEAT_S
        while True:
            await requested.wait()
            await _until_news(here.wakeup, sent_at_s + HEARTBEAT_S - loop.time())
            await asyncio.sleep(max(0.0, sent_at_s + MIN_INTERVAL_S - loop.time()))
            requested.clear()
            here.wakeup.clear()
            message = room_message(sent.update(room_hub.state()), session=here.session)
            sent_at_s, here.session.sent_at_s = loop.time(), room_hub.now_s
            await viewers.send(websocket.send_text(message.model_dump_json()), line)

    def receive_text(text: str) -> None:
        message = _parse_message(text)
        if message.next:
            here.session.answered(room_hub.now_s)
            requested.set()
            return
        try:
            if message.look is not None:
                if room_hub.room.look(here.session, look_of(message.look), now_s=room_hub.now_s):
                    room_hub.notify()
                return
            mark(message, room_hub, here.session)
        except RoomPolicyViolation as unfair:
            _log.warning("room_misused", by=here.session.person.name, why=str(unfair))
            raise ProtocolViolation(REJECTED, str(unfair)) from unfair

    await run_duplex(websocket, viewers, send=send, receive_text=receive_text)


async def _until_news(wakeup: asyncio.Event, max_s: float) -> None:
    try:
        async with asyncio.timeout(max(0.0, max_s)):
            await wakeup.wait()
    except TimeoutError:
        return


def _parse_message(text: str) -> ClientMessage:
    try:
        return ClientMessage.model_validate_json(text, strict=True)
    except ValidationError as error:
        raise ProtocolViolation(REJECTED, f"invalid message: {error.errors()[0]['msg']}"[:120]) from None


def mark(message: ClientMessage, room_hub: RoomHub, session: RoomSession) -> None:
    """Point, draw or clear as this page, and notify the others.

    Raises:
        RoomPolicyViolation: not for this role; rate limit; an invalid drawing.
    """
    _do(message, room_hub, session)
    room_hub.on_mark(_mark_json(message, session.person))
    room_hub.notify()


def _mark_json(message: ClientMessage, person: Person) -> str:
    """Return a command and its author as JSON."""
    done = message.model_dump(mode="json", exclude_unset=True)
    return json.dumps({"by": person.name, "role": person.role.value, **done}, ensure_ascii=False)


def _do(message: ClientMessage, room_hub: RoomHub, session: RoomSession) -> None:
    room, now_s = room_hub.room, room_hub.now_s
    if message.point is not None:
        moment = Moment(image_number=message.point.image_number, captured_at_s=message.point.captured_at_s)
        x, y = message.point.at
        plane = cut_plane(message.point.plane)
        room.point(session, (x, y), moment, room_hub.shown, plane=plane, now_s=now_s)
    elif message.draw is not None:
        _draw(message, room_hub, session)
    elif message.extend is not None:
        points = [(x, y) for x, y in message.extend.points]
        room.extend(session, message.extend.key, points, room_hub.shown, now_s=now_s)
    elif message.undo:
        if room.undo(session, now_s=now_s):
            _log.info("drawing_taken_back", by=session.person.name)
    elif message.clear is not None:
        gone = room.clear(session, everybodys=message.clear == "all", now_s=now_s)
        _log.info("drawings_cleared", by=session.person.name, whose=message.clear, drawings=gone)
    else:
        room.lift(session, now_s=now_s)


def _draw(message: ClientMessage, room_hub: RoomHub, session: RoomSession) -> None:
    """Log author, time, image and CT of a drawing; its points are not stored."""
    draw = message.draw
    if draw is None:
        return
    moment = Moment(image_number=draw.image_number, captured_at_s=draw.captured_at_s)
    points = [(x, y) for x, y in draw.points]
    plane = cut_plane(draw.plane)
    if room_hub.room.draw(
        session, draw.key, draw.shape, points, moment, room_hub.shown, plane=plane, now_s=room_hub.now_s
    ):
        _log.info(
            "drawn",
            by=session.person.name,
            role=session.person.role.value,
            shape=draw.shape.value,
            image_number=draw.image_number,
            ct_id=None if plane is None else plane.ct_id,
        )
