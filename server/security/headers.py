"""The headers that tell a browser what this server's pages may do."""

import re

from starlette.datastructures import Headers, MutableHeaders
from starlette.types import ASGIApp, Message, Receive, Scope, Send

HOST_SHAPE = re.compile(r"[A-Za-z0-9.\-]+(:\d+)?|\[[0-9A-Fa-f:]+\](:\d+)?")

# Nothing from outside, no script written into a page. Styles may be: the page's components set them.
# A browser loads nothing that is not named here, so "no address outside the server" holds for it too.
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
# Of the one page that sends its device's camera.
CAMERA_PAGE_PERMISSIONS = "camera=(self), microphone=(), geolocation=()"
# Once by TLS, by TLS for a year: nobody on the way turns it back. Not for other servers of this name.
UNDER_TLS = {"Strict-Transport-Security": "max-age=31536000"}


def page_policy(host: str, *, scripts: tuple[str, ...] = ()) -> str:
    """The Content-Security-Policy of an answer that was asked for at this `Host`.

    `scripts`: sources of scripts beside the server's own files, such as `'sha256-...'`.
    """
    # Older Safaris do not count a WebSocket of the same host as 'self'.
    sockets = f" ws://{host} wss://{host}" if HOST_SHAPE.fullmatch(host) else ""
    policy = PAGE_POLICY | {"connect-src": f"'self'{sockets}"}
    policy["script-src"] = " ".join((policy["script-src"], *scripts))
    return "; ".join(f"{name} {value}" for name, value in policy.items())


class SecurityHeaders:
    """ASGI middleware: adds them to every answer.

    What an answer has set itself stays: the 3-D scene has scripts written into its page, and a policy of its
    own; the page's files have their own lifetimes.
    """

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass on, with the headers added to the start of the answer."""
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
