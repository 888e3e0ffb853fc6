"""The guard: everything that is asked passes here, and is held against the table with who asks."""

import asyncio
import contextlib
from collections.abc import Callable

from starlette.types import ASGIApp, Receive, Scope, Send

from server.security.asking import Asked
from server.security.audit import Entry
from server.security.hosts import reject
from server.security.people import PeopleDesk, Session
from server.security.person import NOBODY, STATE_KEY, Person
from server.security.rejections import SessionRejected, TooManyTries, body_of, status_of
from server.security.written import pass_and_write
from tracker.errors import NavigationError

SESSION_KEY = "coaxial_session"
SECURE_KEY = "coaxial_secure"
# Whose session is over watches for at most so long, and what a cancelled sending takes.
LOOK_EVERY_S = 0.5
SESSION_OVER = 4401


class SessionGuard:
    """ASGI middleware: lets through what the table allows to who asks, and has written down what was changed.

    Args:
        people: who is signed in.
        is_page: whether a path is the page's own file or view: open to all.
        behind_proxy: a proxy speaks TLS; its word for that is taken, and no other of its words.
    """

    def __init__(
        self, app: ASGIApp, *, people: PeopleDesk, is_page: Callable[[str], bool], behind_proxy: bool = False
    ) -> None:
        self._app = app
        self._people = people
        self._is_page = is_page
        self._behind_proxy = behind_proxy

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass on what may pass, answer the rest."""
        if scope["type"] not in {"http", "websocket"}:
            await self._app(scope, receive, send)
            return
        asked = Asked.of(scope, is_page=self._is_page, behind_proxy=self._behind_proxy)
        session: Session | None = None
        try:
            session = asked.session(scope, self._people)
            person = asked.person(session, required=self._people.required)
            await self._reject_unwritable(asked)
        except NavigationError as rejection:
            await self._write_rejection(asked, session, rejection)
            await self._say_no(scope, receive, send, rejection)
            return
        state = {STATE_KEY: person, SESSION_KEY: session, SECURE_KEY: asked.is_secure}
        inner = {**scope, "state": {**scope.get("state", {}), **state}}
        await self._pass(inner, receive, send, asked, person, session)

    async def _pass(
        self,
        scope: Scope,
        receive: Receive,
        send: Send,
        asked: Asked,
        person: Person,
        session: Session | None,
    ) -> None:
        rule = asked.rule
        if rule is not None and rule.lasts and session is not None:
            await self._while_session_holds(scope, receive, send, session)
        elif rule is not None and rule.is_written and not asked.is_page:
            entry = Entry(who=person, what=rule.name, address=asked.address, of=asked.names)
            await pass_and_write(
                self._app,
                scope,
                receive,
                send,
                audit=self._people.audit,
                entry=entry,
                is_answered=rule.is_answered,
            )
        else:
            await self._app(scope, receive, send)

    async def _while_session_holds(
        self, scope: Scope, receive: Receive, send: Send, session: Session
    ) -> None:
        """Pass on until it ends by itself, or the session does."""
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
        while self._people.holds(session_id):
            await asyncio.sleep(LOOK_EVERY_S)

    async def _reject_unwritable(self, asked: Asked) -> None:
        """Raises StoreError: what was done before is not written yet, and cannot be now."""
        rule, audit = asked.rule, self._people.audit
        if rule is not None and rule.is_written and not rule.is_urgent and not audit.is_well:
            await asyncio.to_thread(audit.catch_up)

    async def _write_rejection(
        self, asked: Asked, session: Session | None, rejection: NavigationError
    ) -> None:
        """Tries are written down: of who is signed in, and with what is no key. Opening the page is none."""
        if rejection.code == "SESSION_NEEDED" or status_of(rejection) not in {401, 403, 429}:
            return
        entry = Entry(
            who=NOBODY if session is None else session.person,
            what=f"{asked.method} {asked.path}" if asked.rule is None else asked.rule.name,
            address=asked.address,
            of=asked.names,
            status=status_of(rejection),
            code=rejection.code,
        )
        await asyncio.to_thread(self._people.audit.rejected, entry)

    async def _say_no(self, scope: Scope, receive: Receive, send: Send, rejection: NavigationError) -> None:
        headers = {"Cache-Control": "no-store"}
        if isinstance(rejection, TooManyTries):
            headers["Retry-After"] = str(rejection.context["wait_s"])
        if isinstance(rejection, SessionRejected):
            headers["WWW-Authenticate"] = 'Bearer realm="coaxial"'
        status, body = status_of(rejection), body_of(rejection)
        await reject(scope, receive, send, status=status, body=body, headers=headers)
