"""Users signed in to an application under test, without keys.

The user named in a header, query or cookie replaces the session's.

"""

from http.cookies import SimpleCookie
from urllib.parse import parse_qs

from fastapi import FastAPI
from starlette.middleware import Middleware
from starlette.types import ASGIApp, Receive, Scope, Send

from server.security import Person, Role
from server.security.person import STATE_KEY

SATO = Person(id="s1", name="Dr Sato", role=Role.SUPERVISOR)
KIM = Person(id="s2", name="Dr Kim", role=Role.SUPERVISOR)
LEE = Person(id="s3", name="Dr Lee", role=Role.SUPERVISOR, invited_by="ito")
ITO = Person(id="o1", name="ito", role=Role.OPERATOR)
GUEST = Person(id="v1", name="Guest", role=Role.VIEWER)
PERSONS = {person.id: person for person in (SATO, KIM, LEE, ITO, GUEST)}


def sign_people_in(app: FastAPI) -> None:
    """Runs after the application's own middleware."""
    app.user_middleware.append(Middleware(SignedIn))


class SignedIn:
    """ASGI middleware: the header `x-person`, or `person` in the query or a cookie, names the user."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        if scope["type"] in ("http", "websocket"):
            headers = dict(scope["headers"])
            named = headers.get(b"x-person", b"").decode()
            named = named or parse_qs(scope["query_string"].decode()).get("person", [""])[0]
            cookie = SimpleCookie(headers.get(b"cookie", b"").decode()).get("person")
            named = named or ("" if cookie is None else cookie.value)
            if named in PERSONS:
                scope["state"] = {**scope.get("state", {}), STATE_KEY: PERSONS[named]}
        await self._app(scope, receive, send)
