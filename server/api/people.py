"""People, for the operator: who is signed in, who is invited, and how to end either."""

import io
from datetime import timedelta

from fastapi import APIRouter, Request, Response

from server.api.errors import rejections
from server.api.session import session_of
from server.api.session_messages import (
    InvitedMessage,
    InviteRequest,
    PeopleMessage,
    invitation_message,
    signed_in_message,
)
from server.security.audit import note
from server.security.guard import SECURE_KEY
from server.security.people import InvitationState, PeopleDesk
from server.security.people.desk import Wanted
from server.security.person import acting
from server.security.reach import is_loopback, shown_host
from server.security.rejections import SignInOff

ENTER_PATH = "/enter"


def people_router(people: PeopleDesk | None, *, listens_everywhere: bool) -> APIRouter:
    """Everything under `/api/people`."""
    router = APIRouter(prefix="/api/people", tags=["people"])

    @router.get("", responses=rejections(503))
    def everybody(request: Request) -> PeopleMessage:
        """Who is signed in, and who is invited."""
        if people is None:
            return PeopleMessage(sign_in_required=False, sessions=[], invitations=[])
        own = session_of(request)
        return PeopleMessage(
            sign_in_required=people.required,
            sessions=[signed_in_message(one, own=own) for one in people.sessions()],
            invitations=[invitation_message(one, state) for one, state in people.invitations()],
        )

    @router.post("/invitations", status_code=201, responses=rejections(409, 422, 503))
    def invite(asked: InviteRequest, request: Request) -> InvitedMessage:
        """Invite somebody: a link and its QR code, told once."""
        desk = _required(people)
        session_h = asked.session_lasts_h
        wanted = Wanted(
            name=asked.name,
            role=asked.role,
            lasts=timedelta(hours=asked.lasts_h),
            single_use=asked.single_use,
            for_machine=asked.for_machine,
            session_lasts=None if session_h is None else timedelta(hours=session_h),
        )
        invitation, token = desk.invite(wanted, by=acting(request.scope, None))
        note({"what": "invitation", "name": asked.name, "id": token.id, "from": None, "to": asked.role.value})
        host = shown_host(request.headers.get("host", ""), listens_everywhere=listens_everywhere)
        scheme = "https" if request.scope["state"][SECURE_KEY] else "http"
        link = f"{scheme}://{host}{ENTER_PATH}#{token.text}"
        return InvitedMessage(
            invitation=invitation_message(invitation, InvitationState.OPEN),
            link=link,
            qr_svg=_qr_svg(link),
            is_reachable=not is_loopback(host),
        )

    @router.delete("/invitations/{invitation_id}", status_code=204, responses=rejections(404, 409, 503))
    def revoke(invitation_id: str) -> Response:
        """Take an invitation back. Who came in by it stays until their session is ended."""
        revoked = _required(people).revoke(invitation_id)
        note({"what": "invitation", "name": revoked.person.name, "from": "open", "to": "revoked"})
        return Response(status_code=204)

    @router.delete("/sessions/{session_id}", status_code=204, responses=rejections(404, 409, 503))
    def end(session_id: str) -> Response:
        """End somebody's session: within two seconds they see nothing more."""
        ended = _required(people).end(session_id)
        note({"what": "session", "name": ended.person.name, "from": ended.person.role.value, "to": None})
        return Response(status_code=204)

    return router


def _required(people: PeopleDesk | None) -> PeopleDesk:
    if people is None or not people.required:
        raise SignInOff.told()
    return people


def _qr_svg(link: str) -> str:
    import segno  # noqa: PLC0415  loaded when somebody is invited, not at each start

    drawing = io.BytesIO()
    # A quiet zone of four modules, and white paper: cameras of phones want both, on a dark page too.
    segno.make(link, error="m", micro=False).save(
        drawing, kind="svg", border=4, light="#ffffff", dark="#000000", xmldecl=False, omitsize=True
    )
    return drawing.getvalue().decode()
