"""In the theatre: performs a supervisor's request from the hub by this server's own application.

It passes the same guards as any other request: host, session, access rules, audit log, limits. In the audit
log its address is `hub`.
"""

import json
from collections.abc import Awaitable, Callable

from starlette.types import ASGIApp, Message, Scope

from server.api.errors import status_of
from server.hub.connection import HubError
from server.hub.requests import HubAnswer, HubRequest
from server.security import PeopleService, Role
from server.security.access_rules import is_through_hub
from server.stream.messages import translated_problem
from server.texts import set_requested_language

ADDRESS = "hub"


def rejected(error: HubError, language: str) -> HubAnswer:
    """Return the answer of an error."""
    set_requested_language(language)
    body = translated_problem(error).model_dump_json().encode()
    return HubAnswer(status=status_of(error), content_type="application/json", token=None, body=body)


def performer(app: ASGIApp, people: PeopleService) -> Callable[[HubRequest], Awaitable[HubAnswer]]:
    """Return the function that performs requests, for supervisors of this theatre and listed routes alone."""

    async def perform(request: HubRequest) -> HubAnswer:
        if not is_through_hub(request.method, request.path):
            error = HubError(
                "HUB_REQUEST_REJECTED",
                f"{request.method} {request.path[:200]} is not possible through the hub",
                "Use the theatre's own page.",
                {"path": request.path[:200], "method": request.method},
            )
            return rejected(error, request.language)
        roles = {people.role_of(request.token), people.role_of(_invitation_in(request))}
        # An operator's session at the hub would let it do what only people in theatre may do.
        if role := next(iter(roles - {None, Role.SUPERVISOR}), None):
            error = HubError(
                "HUB_SUPERVISORS_ONLY",
                f"the role {role} cannot be used through the hub",
                "Ask the operator of the theatre for an invitation as supervisor.",
                {"role": str(role)},
            )
            return rejected(error, request.language)
        return await _call(app, request)

    return perform


def _invitation_in(request: HubRequest) -> str:
    try:
        body = json.loads(request.body or "{}")
    except (ValueError, RecursionError):
        return ""
    return str(body.get("invitation", "")) if isinstance(body, dict) else ""


async def _call(app: ASGIApp, request: HubRequest) -> HubAnswer:
    body = request.body.encode()
    is_read = False
    status, headers, parts = 500, dict[str, str](), list[bytes]()

    async def receive() -> Message:
        nonlocal is_read
        if is_read:
            return {"type": "http.disconnect"}
        is_read = True
        return {"type": "http.request", "body": body, "more_body": False}

    async def send(message: Message) -> None:
        nonlocal status
        if message["type"] == "http.response.start":
            status = int(message["status"])
            headers.update({name.decode().lower(): value.decode() for name, value in message["headers"]})
        elif message["type"] == "http.response.body":
            parts.append(message.get("body", b""))

    await app(_scope(request, len(body)), receive, send)
    cookie = headers.get("set-cookie")
    return HubAnswer(
        status=status,
        content_type=headers.get("content-type", "application/octet-stream"),
        token=None if cookie is None else cookie.partition("=")[2].partition(";")[0],
        body=b"".join(parts),
    )


def _scope(request: HubRequest, body_bytes: int) -> Scope:
    headers = {
        "host": "localhost",
        "accept-language": request.language,
        "content-type": "application/json",
        "content-length": str(body_bytes),
    }
    if request.token:
        headers["authorization"] = f"Bearer {request.token}"
    return {
        "type": "http",
        "asgi": {"version": "3.0"},
        "http_version": "1.1",
        "method": request.method,
        "scheme": "http",
        "path": request.path,
        "raw_path": request.path.encode(),
        "query_string": request.query.encode(),
        "root_path": "",
        "headers": [(name.encode(), value.encode("latin-1", "replace")) for name, value in headers.items()],
        "client": (ADDRESS, 0),
        "server": ("localhost", 80),
        "state": {},
    }
