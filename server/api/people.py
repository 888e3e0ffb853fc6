"""Sessions and invitations, for the operator."""

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
from server.security.addresses import is_loopback, link_host
from server.security.audit import note
from server.security.guard import SECURE_KEY
from server.security.people import InvitationState, PeopleService
from server.security.people.service import NewInvitation
from server.security.person import actor_name
from server.security.rejections import SignInOff

ENTER_PATH = "/enter"


def people_router(people: PeopleService | None, *, listens_everywhere: bool) -> APIRouter:
    """Return the router of `/api/people`."""
    router = APIRouter(prefix="/api/people", tags=["people"])

    @router.get("", responses=rejections(503))
    def everybody(request: Request) -> PeopleMessage:
        """Return all sessions and invitations."""
        if people is None:
            return PeopleMessage(sign_in_required=False, sessions=[], invitations=[])
        own = session_of(request)
        return PeopleMessage(
            sign_in_required=people.required,
            sessions=[signed_in_message(one, own=own) for one in people.sessions()],
            invitations=[invitation_message(one, state) for one, state in people.invitations()],
        )

    @router.post("/invitations", status_code=201, responses=rejections(409, 422, 503))
    def invite(requested: InviteRequest, request: Request) -> InvitedMessage:
        """Create an invitation; its link and QR code are only returned here."""
        service = _required(people)
        session_h = requested.session_lasts_h
        wanted = NewInvitation(
            name=requested.name,
            role=requested.role,
            lasts=timedelta(hours=requested.lasts_h),
            single_use=requested.single_use,
            for_machine=requested.for_machine,
            session_lasts=None if session_h is None else timedelta(hours=session_h),
        )
        invitation, token = service.invite(wanted, by=actor_name(request.scope, None))
        note(
            {
                "what": "invitation",
                "name": requested.name,
                "id": token.id,
                "from": None,
                "to": requested.role.value,
            }
        )
        host = link_host(request.headers.get("host", ""), listens_everywhere=listens_everywhere)
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
        """Revoke an invitation. Sessions created with it remain until they are ended."""
        revoked = _required(people).revoke(invitation_id)
        note({"what": "invitation", "name": revoked.person.name, "from": "open", "to": "revoked"})
        return Response(status_code=204)

    @router.delete("/sessions/{session_id}", status_code=204, responses=rejections(404, 409, 503))
    def end(session_id: str) -> Response:
        """End a session; its streams close within two seconds."""
        ended = _required(people).end_session(session_id)
        note({"what": "session", "name": ended.person.name, "from": ended.person.role.value, "to": None})
        return Response(status_code=204)

    return router


def _required(people: PeopleService | None) -> PeopleService:
    if people is None or not people.required:
        raise SignInOff.error()
    return people


def _qr_svg(link: str) -> str:
    import segno  # noqa: PLC0415  loaded when somebody is invited, not at each start

    drawing = io.BytesIO()
    # Phone cameras need a quiet zone of four modules and a white background, also on a dark page.
    segno.make(link, error="m", micro=False).save(
        drawing, kind="svg", border=4, light="#ffffff", dark="#000000", xmldecl=False, omitsize=True
    )
    return drawing.getvalue().decode()
