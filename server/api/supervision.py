"""Who watches, what they mark and sign: the room's socket, and the requests beside it."""

from fastapi import APIRouter, Request, WebSocket

from server.api.errors import rejections
from server.api.supervision_messages import (
    RoomMessage,
    SignatureRequest,
    SignaturesMessage,
    room_message,
    signable_message,
)
from server.api.supervision_socket import sit_in_room
from server.security import person_of
from server.stream.viewers import Viewers
from server.supervision import Lobby, SignatureDesk, View
from server.supervision.budget import Budget
from server.supervision.people import Seat
from server.supervision.signatures import Signable
from server.supervision.told import Told

KEPT = rejections(404, 409, 422, 503, 507)

ROOM_IN_WORDS = """
`WS /ws/room?view=theatre|operator|supervisor`: the client sends `{"next": true}` and gets one `RoomMessage`
as JSON text, when something is new and at least once a second: who is here, pointers and drawings on the
picture, who asks to hold, what is co-signed. What was told is not told again. Supervisors and the operator
point and draw over the same socket.
"""


def room_router(lobby: Lobby, viewers: Viewers) -> APIRouter:
    """`WS /ws/room`, and the same once by `GET /api/supervision/room`."""
    router = APIRouter(tags=["supervision"])

    @router.get("/api/supervision/room")
    async def room(request: Request) -> RoomMessage:
        """Who is here, and what they mark, now; the same comes over `WS /ws/room` whenever it changes."""
        person, now_s = person_of(request.scope), lobby.now_s
        nobodys = Seat(
            number=0,
            person=person,
            view=View.SUPERVISOR,
            since="",
            budget=Budget.full(rate_hz=0.0, most=0.0, now_s=now_s),
        )
        return room_message(Told().news(lobby.picture()), seat=nobodys)

    @router.websocket("/ws/room")
    async def sit(websocket: WebSocket) -> None:
        await sit_in_room(websocket, lobby=lobby, viewers=viewers)

    return router


def signatures_router(desk: SignatureDesk) -> APIRouter:
    """Everything under `/api/supervision/signatures`. Plain functions: they wait for the disk, in threads."""
    router = APIRouter(prefix="/api/supervision/signatures", tags=["supervision"])

    @router.get("", responses=rejections(503))
    def signatures(request: Request) -> SignaturesMessage:
        """The plan and the registration that are to be drilled by, with the signatures of these versions."""
        return _message(request, desk.overview())

    @router.post("", status_code=201, responses=KEPT)
    def sign(request: Request, asked: SignatureRequest) -> SignaturesMessage:
        """Co-sign exactly this version; it must be the newest one, and somebody else must have made it."""
        return _message(request, desk.sign(asked.what, asked.document_id, person_of(request.scope)))

    @router.delete("/{signature_id}", responses=KEPT)
    def take_back(request: Request, signature_id: str) -> SignaturesMessage:
        """Take back your own signature; the operator, anybody's."""
        return _message(request, desk.take_back(signature_id, person_of(request.scope)))

    return router


def _message(request: Request, signable: tuple[Signable, ...]) -> SignaturesMessage:
    your_id = person_of(request.scope).id
    return SignaturesMessage(signable=[signable_message(one, your_id) for one in signable])
