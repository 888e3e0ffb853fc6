"""Remote supervision: the room socket (people, pointers, drawings) and co-signatures."""

from fastapi import APIRouter, Request, Response, WebSocket

from server.api.errors import NotYetAvailable, rejections
from server.api.supervision_messages import (
    ClientMessage,
    RoomMessage,
    SignatureRequest,
    SignaturesMessage,
    room_message,
    signable_message,
)
from server.api.supervision_socket import mark, serve_room
from server.security import person_of
from server.stream.viewers import Viewers
from server.supervision import RoomHub, RoomPolicyViolation, SignatureService, View
from server.supervision.participants import RoomSession
from server.supervision.room import RoomFull
from server.supervision.room_updates import SentState
from server.supervision.signatures import Signable
from server.supervision.token_bucket import TokenBucket
from tracker.errors import InvalidInput

STORE_ERRORS = rejections(404, 409, 422, 503, 507)

ROOM_DESCRIPTION = """
`WS /ws/room?view=theatre|operator|supervisor`: the client sends `{"next": true}` and receives one
`RoomMessage` as JSON text after each change and at least once a second: people present, pointers and drawings
on the image and on cuts of the CT, hold requests, and co-signatures. Unchanged parts are not repeated.
Supervisors and the operator point and draw over the same socket.
"""


def room_router(room_hub: RoomHub, viewers: Viewers) -> APIRouter:
    """Return the router of `WS /ws/room` and `GET /api/supervision/room`."""
    router = APIRouter(tags=["supervision"])

    @router.get("/api/supervision/room")
    async def room(request: Request) -> RoomMessage:
        """Return the state of the room; `WS /ws/room` sends the same on each change."""
        person, now_s = person_of(request.scope), room_hub.now_s
        nobodys = RoomSession(
            number=0,
            person=person,
            view=View.SUPERVISOR,
            since="",
            bucket=TokenBucket.full(rate_hz=0.0, capacity=0.0, now_s=now_s),
            look_bucket=TokenBucket.full(rate_hz=0.0, capacity=0.0, now_s=now_s),
        )
        return room_message(
            SentState().update(room_hub.state()), session=room_hub.visit_of(person) or nobodys
        )

    @router.post("/api/supervision/marks", status_code=204, responses=rejections(422, 503))
    async def marks(request: Request, message: ClientMessage) -> Response:
        """Point, draw or clear, as by `WS /ws/room`, for people without a socket, as through the hub."""
        try:
            mark(message, room_hub, room_hub.visit(person_of(request.scope)))
        except RoomPolicyViolation as unfair:
            raise InvalidInput(
                "MARK_REJECTED",
                "the mark was rejected: it is not valid, or there were too many",
                "Draw less at once, or wait a second.",
                {"reason": str(unfair)},
            ) from unfair
        except RoomFull as full:
            raise NotYetAvailable(
                "ROOM_FULL",
                "as many pages of supervisors are open as is possible",
                "Close pages that are not needed.",
                {"reason": str(full)},
            ) from full
        return Response(status_code=204)

    @router.websocket("/ws/room")
    async def sit(websocket: WebSocket) -> None:
        await serve_room(websocket, room_hub=room_hub, viewers=viewers)

    return router


def signatures_router(service: SignatureService) -> APIRouter:
    """Return the router of `/api/supervision/signatures`; synchronous: it waits for the disk."""
    router = APIRouter(prefix="/api/supervision/signatures", tags=["supervision"])

    @router.get("", responses=rejections(503))
    def signatures(request: Request) -> SignaturesMessage:
        """Return the plan and the registration in use with the signatures of these versions."""
        return _message(request, service.overview())

    @router.post("", status_code=201, responses=STORE_ERRORS)
    def sign(request: Request, requested: SignatureRequest) -> SignaturesMessage:
        """Co-sign this version. It must be the newest one and made by another person."""
        return _message(
            request, service.sign(requested.what, requested.document_id, person_of(request.scope))
        )

    @router.delete("/{signature_id}", responses=STORE_ERRORS)
    def take_back(request: Request, signature_id: str) -> SignaturesMessage:
        """Withdraw your own signature; the operator may withdraw any."""
        return _message(request, service.withdraw(signature_id, person_of(request.scope)))

    return router


def _message(request: Request, signable: tuple[Signable, ...]) -> SignaturesMessage:
    your_id = person_of(request.scope).id
    return SignaturesMessage(signable=[signable_message(one, your_id) for one in signable])
