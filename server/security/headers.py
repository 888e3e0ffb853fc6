"""Security headers of all answers."""

import re

from starlette.datastructures import Headers, MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

HOST_SHAPE = re.compile(r"[A-Za-z0-9.\-]+(:\d+)?|\[[0-9A-Fa-f:]+\](:\d+)?")

# No external sources and no inline scripts. Inline styles are needed by the page's components. A browser
# loads nothing that is not named here.
PAGE_POLICY = {
    "default-src": "'self'",
    "script-src": "'self'",
    "style-src": "'self' 'unsafe-inline'",
    "img-src": "'self' blob: data:",
    "font-src": "'self' data:",
    "media-src": "'self' blob:",
    "worker-src": "'self' blob:",
    "frame-src": "'self'",
    "frame-ancestors": "'self'",
    "object-src": "'none'",
    "base-uri": "'none'",
    "form-action": "'self'",
}
ALWAYS = {
    "Cache-Control": "no-store",
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Permissions-Policy": "camera=(), microphone=(), geolocation=()",
}
# For the page that sends its device's camera.
CAMERA_PAGE_PERMISSIONS = "camera=(self), microphone=(), geolocation=()"
# HSTS for a year: prevents a downgrade. Not for other servers of this name.
UNDER_TLS = {"Strict-Transport-Security": "max-age=31536000"}


def page_policy(host: str, *, scripts: tuple[str, ...] = ()) -> str:
    """Return the Content-Security-Policy of an answer for this `Host`.

    `scripts`: script sources beside the server's own files, such as `'sha256-...'`.
    """
    # Older Safari versions do not count a WebSocket of the same host as 'self'.
    sockets = f" ws://{host} wss://{host}" if HOST_SHAPE.fullmatch(host) else ""
    policy = PAGE_POLICY | {"connect-src": f"'self'{sockets}"}
    policy["script-src"] = " ".join((policy["script-src"], *scripts))
    return "; ".join(f"{name} {value}" for name, value in policy.items())


class SecurityHeaders:
    """ASGI middleware: adds security headers to every answer.

    Headers that an answer has set itself stay: the 3-D scene has inline scripts and a policy of its own, and
    the page's files have their own cache lifetimes.
    """

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass on, and add the headers to the start of the answer."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        host = Headers(scope=scope).get("host", "")

        async def send_with_headers(message: Message) -> None:
            if message["type"] == "http.response.start":
                headers = MutableHeaders(scope=message)
                headers.setdefault("Content-Security-Policy", page_policy(host))
                for name, value in (ALWAYS | (UNDER_TLS if scope.get("scheme") == "https" else {})).items():
                    headers.setdefault(name, value)
            await send(message)

        await self._app(scope, receive, send_with_headers)
