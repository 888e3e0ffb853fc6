"""Host and origin checks: protection against DNS rebinding and cross-site requests.

A foreign page can make a browser inside the hospital's network send requests to this server: by a name that
resolves to our address (DNS rebinding), or by opening a WebSocket, which browsers allow across origins. Both
are rejected by the headers that the browser itself writes: `Host` and `Origin`.
"""

import ipaddress
import socket
from dataclasses import dataclass
from urllib.parse import urlsplit

from starlette.datastructures import Headers
from starlette.responses import JSONResponse
from starlette.types import ASGIApp, Receive, Scope, Send

DEFAULT_PORTS = {"http": 80, "https": 443}
SAFE_METHODS = frozenset({"GET", "HEAD", "OPTIONS"})


@dataclass(frozen=True, slots=True)
class KnownHosts:
    """The host names of this server, in lower case.

    Every literal IP address is accepted too: a rebinding attack needs a name of the attacker's own.
    """

    names: frozenset[str]

    @classmethod
    def of(cls, configured: str) -> "KnownHosts":
        """Return loopback, the machine's own name, and the configured host."""
        own = socket.gethostname().lower()
        return cls(frozenset({"localhost", own, f"{own.split('.')[0]}.local", configured.lower()}))

    def has(self, host_header: str) -> bool:
        """Return whether a `Host` header, with or without a port, names this server."""
        name = _hostname(f"//{host_header}")
        return name is not None and (name in self.names or name.endswith(".localhost") or _is_address(name))


def is_same_origin(*, origin: str | None, host: str) -> bool:
    """Return whether a page from `origin` may open a socket at `host`.

    True without an Origin: browsers always send one with a WebSocket, other programs need not. The scheme is
    ignored, because a proxy may terminate TLS.
    """
    if origin is None:
        return True
    default = DEFAULT_PORTS.get(origin.partition(":")[0])
    page, here = _host_and_port(origin, default), _host_and_port(f"//{host}", default)
    return default is not None and page is not None and page == here


def _host_and_port(address: str, default: int | None) -> tuple[str, int | None] | None:
    try:
        parts = urlsplit(address)
        name, port = parts.hostname, parts.port or default
    except ValueError:
        return None
    return (name, port) if name else None


class HostGuard:
    """ASGI middleware: rejects unknown hosts, and cross-origin sockets and changes."""

    def __init__(self, app: ASGIApp, *, hosts: KnownHosts) -> None:
        self._app = app
        self._hosts = hosts

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass on an allowed request, answer any other with an error."""
        if scope["type"] not in {"http", "websocket"}:
            await self._app(scope, receive, send)
            return
        headers = Headers(scope=scope)
        host, origin = headers.get("host", ""), headers.get("origin")
        if not self._hosts.has(host):
            await reject(scope, receive, send, status=421, body=_unknown_host(host))
            return
        changes = scope["type"] == "websocket" or scope["method"] not in SAFE_METHODS
        if changes and not is_same_origin(origin=origin, host=host):
            await reject(scope, receive, send, status=403, body=_cross_origin(origin, host))
            return
        await self._app(scope, receive, send)


def _hostname(address: str) -> str | None:
    try:
        return urlsplit(address).hostname
    except ValueError:
        return None


def _is_address(name: str) -> bool:
    try:
        ipaddress.ip_address(name)
    except ValueError:
        return False
    return True


def _unknown_host(host: str) -> dict[str, object]:
    return {
        "code": "HOST_UNKNOWN",
        "message": f"this server does not accept the host name '{host[:80]}'",
        "remedy": "Open it by its address or its own name, or set server.host to this name.",
        "context": {"host": host[:80]},
        "language": "en",
    }


def _cross_origin(origin: str | None, host: str) -> dict[str, object]:
    shown = (origin or "")[:80]
    return {
        "code": "ORIGIN_REJECTED",
        "message": f"a page from '{shown}' may not do this at '{host[:80]}'",
        "remedy": "Open the dashboard of this server itself, at its own address.",
        "context": {"origin": shown, "host": host[:80]},
        "language": "en",
    }


async def reject(
    scope: Scope,
    receive: Receive,
    send: Send,
    *,
    status: int,
    body: dict[str, object],
    headers: dict[str, str] | None = None,
) -> None:
    """Send this error; a WebSocket is rejected before it is accepted, with an HTTP response."""
    response = JSONResponse(body, status_code=status, headers=headers)
    if scope["type"] == "http":
        await response(scope, receive, send)
        return
    await receive()  # the client's websocket.connect
    if "websocket.http.response" not in scope.get("extensions", {}):
        await send({"type": "websocket.close", "code": 1008, "reason": str(body["code"])})
        return
    await send({"type": "websocket.http.response.start", "status": status, "headers": response.raw_headers})
    await send({"type": "websocket.http.response.body", "body": response.body})
