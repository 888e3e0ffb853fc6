"""Sign-in, sign-out and the current session."""

from fastapi import APIRouter, Request, Response

from server.api.errors import rejections
from server.api.session_messages import EnteredMessage, EnterRequest, SessionMessage
from server.security.audit import note
from server.security.cookies import cookie_header
from server.security.guard import SECURE_KEY, SESSION_KEY
from server.security.people import PeopleService, Session
from server.security.person import LOCAL_USER
from server.security.rejections import SignInOff


def session_of(request: Request) -> Session | None:
    """Return the session of a request; None if sign-in is off."""
    found = request.scope.get("state", {}).get(SESSION_KEY)
    return found if isinstance(found, Session) else None


def session_router(people: PeopleService | None, *, is_hub: bool = False) -> APIRouter:
    """Return the router of `/api/session`."""
    router = APIRouter(prefix="/api/session", tags=["people"])

    def message(session: Session) -> SessionMessage:
        return SessionMessage(
            name=session.person.name,
            role=session.person.role,
            expires_at=session.expires_at,
            sign_in_required=True,
            is_hub=is_hub,
        )

    @router.get("")
    async def who(request: Request) -> SessionMessage:
        """Return name, role and expiry of the session."""
        session = session_of(request)
        if session is None:
            return SessionMessage(
                name=LOCAL_USER.name,
                role=LOCAL_USER.role,
                expires_at=None,
                sign_in_required=False,
                is_hub=is_hub,
            )
        return message(session)

    @router.post("", responses=rejections(408, 409, 422, 503))
    def enter(requested: EnterRequest, request: Request, response: Response) -> EnteredMessage:
        """Sign in with an invitation: the part of its link after the #.

        A browser receives a cookie. For a machine invitation the response contains the session token instead.
        """
        if people is None or not people.required:
            raise SignInOff.error()
        address = request.client.host if request.client else ""
        session, token = people.sign_in(requested.invitation, address=address)
        left = session_of(request)
        if left is not None and not session.for_machine:
            people.end_session(left.id)
        secure = bool(request.scope["state"][SECURE_KEY])
        note({"what": "session", "name": session.person.name, "from": None, "to": session.person.role.value})
        if not session.for_machine:
            lasts_s = round((session.expires_at - session.started_at).total_seconds())
            cookie = cookie_header(request.scope, token.text, secure=secure, lasts_s=lasts_s)
            response.headers.append("Set-Cookie", cookie)
        return EnteredMessage(
            **message(session).model_dump(), token=token.text if session.for_machine else None
        )

    @router.delete("", status_code=204, responses=rejections(409, 503))
    def leave(request: Request) -> Response:
        """Sign out: end the session and close its streams and sockets."""
        session = session_of(request)
        if people is None or session is None:
            raise SignInOff.error()
        people.end_session(session.id)
        note({"what": "session", "name": session.person.name, "from": session.person.role.value, "to": None})
        secure = bool(request.scope["state"][SECURE_KEY])
        cookie = cookie_header(request.scope, "", secure=secure, lasts_s=0)
        return Response(status_code=204, headers={"Set-Cookie": cookie})

    return router
