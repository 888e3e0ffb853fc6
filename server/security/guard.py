"""Middleware that checks every request against the access rules and writes the audit log."""

import asyncio
import contextlib
from collections.abc import Callable

from starlette.types import ASGIApp, Receive, Scope, Send

from server.security.access_request import AccessRequest
from server.security.audit import Entry
from server.security.audited_response import run_audited
from server.security.hosts import reject
from server.security.people import PeopleService, Session
from server.security.person import ANONYMOUS, STATE_KEY, Person
from server.security.rejections import SessionRejected, TooManyTries, body_of, status_of
from tracker.errors import NavigationError

SESSION_KEY = "coaxial_session"
SECURE_KEY = "coaxial_secure"
# Maximum time for which a stream outlives its session, beside the time to cancel a pending send.
POLL_INTERVAL_S = 0.5
SESSION_OVER = 4401


class SessionGuard:
    """ASGI middleware: passes on what the access rules allow, and writes changes to the audit log.

    Args:
        people: sessions and invitations.
        is_page: returns whether a path is a public file or view of the page.
        behind_proxy: a proxy terminates TLS; its `X-Forwarded-Proto` is trusted, no other header.
    """

    def __init__(
        self,
        app: ASGIApp,
        *,
        people: PeopleService,
        is_page: Callable[[str], bool],
        behind_proxy: bool = False,
    ) -> None:
        self._app = app
        self._people = people
        self._is_page = is_page
        self._behind_proxy = behind_proxy

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass on an allowed request, answer any other with its error."""
        if scope["type"] not in {"http", "websocket"}:
            await self._app(scope, receive, send)
            return
        request = AccessRequest.of(scope, is_page=self._is_page, behind_proxy=self._behind_proxy)
        session: Session | None = None
        try:
            session = request.session(scope, self._people)
            person = request.person(session, required=self._people.required)
            await self._reject_unwritable(request)
        except NavigationError as rejection:
            await self._write_rejection(request, session, rejection)
            await self._send_rejection(scope, receive, send, rejection)
            return
        state = {STATE_KEY: person, SESSION_KEY: session, SECURE_KEY: request.is_secure}
        inner = {**scope, "state": {**scope.get("state", {}), **state}}
        await self._pass(inner, receive, send, request, person, session)

    async def _pass(
        self,
        scope: Scope,
        receive: Receive,
        send: Send,
        request: AccessRequest,
        person: Person,
        session: Session | None,
    ) -> None:
        rule = request.rule
        if rule is not None and rule.is_long_lived and session is not None:
            await self._while_session_is_valid(scope, receive, send, session)
        elif rule is not None and rule.is_audited and not request.is_page:
            entry = Entry(who=person, what=rule.name, address=request.address, of=request.names)
            await run_audited(
                self._app,
                scope,
                receive,
                send,
                audit=self._people.audit,
                entry=entry,
                keeps_answer=rule.keeps_answer,
            )
        else:
            await self._app(scope, receive, send)

    async def _while_session_is_valid(
        self, scope: Scope, receive: Receive, send: Send, session: Session
    ) -> None:
        """Run the application until it ends, or its session does."""
        serving = asyncio.ensure_future(self._app(scope, receive, send))
        watching = asyncio.create_task(self._until_over(session.id), name="session")
        try:
            await asyncio.wait([serving, watching], return_when=asyncio.FIRST_COMPLETED)
            ended_by_session = not serving.done()
        finally:
            for task in (serving, watching):
                task.cancel()
            await asyncio.wait([serving, watching])
        if not ended_by_session:
            serving.result()
        elif scope["type"] == "websocket":
            with contextlib.suppress(RuntimeError, OSError):
                await send({"type": "websocket.close", "code": SESSION_OVER, "reason": "SESSION_EXPIRED"})

    async def _until_over(self, session_id: str) -> None:
        while self._people.is_valid(session_id):
            await asyncio.sleep(POLL_INTERVAL_S)

    async def _reject_unwritable(self, request: AccessRequest) -> None:
        """Raise StoreError while earlier audit entries cannot be written."""
        rule, audit = request.rule, self._people.audit
        if rule is not None and rule.is_audited and not rule.is_urgent and not audit.is_writable:
            await asyncio.to_thread(audit.catch_up)

    async def _write_rejection(
        self, request: AccessRequest, session: Session | None, rejection: NavigationError
    ) -> None:
        """Write rejected attempts to the audit log. A page opened without any token is not an attempt."""
        if rejection.code == "SESSION_NEEDED" or status_of(rejection) not in {401, 403, 429}:
            return
        entry = Entry(
            who=ANONYMOUS if session is None else session.person,
            what=f"{request.method} {request.path}" if request.rule is None else request.rule.name,
            address=request.address,
            of=request.names,
            status=status_of(rejection),
            code=rejection.code,
        )
        await asyncio.to_thread(self._people.audit.append_rejection, entry)

    async def _send_rejection(
        self, scope: Scope, receive: Receive, send: Send, rejection: NavigationError
    ) -> None:
        headers = {"Cache-Control": "no-store"}
        if isinstance(rejection, TooManyTries):
            headers["Retry-After"] = str(rejection.context["wait_s"])
        if isinstance(rejection, SessionRejected):
            headers["WWW-Authenticate"] = 'Bearer realm="coaxial"'
        status, body = status_of(rejection), body_of(rejection)
        await reject(scope, receive, send, status=status, body=body, headers=headers)
