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
# The 3-D scene is one page with its scripts, workers and WebAssembly written into it.
SCENE_POLICY = PAGE_POLICY | {
    "script-src": "'self' 'unsafe-inline' 'wasm-unsafe-eval' blob: data:",
    "worker-src": "'self' blob: data:",
}
ALWAYS = {
    "X-Content-Type-Options": "nosniff",
    "Referrer-Policy": "no-referrer",
    "Cross-Origin-Opener-Policy": "same-origin",
    "Cross-Origin-Resource-Policy": "same-origin",
    "Permissions-Policy": "camera=(), microphone=(), geolocation=()",
}


def policy_for(*, path: str, host: str) -> str:
    """The Content-Security-Policy of an answer."""
    is_scene = path == "/scene" or path.startswith("/scene/")
    # Older Safaris do not count a WebSocket of the same host as 'self'.
    sockets = f" ws://{host} wss://{host}" if HOST_SHAPE.fullmatch(host) else ""
    connect = f"'self'{sockets} blob: data:" if is_scene else f"'self'{sockets}"
    policy = (SCENE_POLICY if is_scene else PAGE_POLICY) | {"connect-src": connect}
    return "; ".join(f"{name} {value}" for name, value in policy.items())


class SecurityHeaders:
    """ASGI middleware: adds them to every answer; what an answer has set itself stays."""

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
                headers.setdefault("Content-Security-Policy", policy_for(path=scope["path"], host=host))
                for name, value in ALWAYS.items():
                    headers.setdefault(name, value)
            await send(message)

        await self._app(scope, receive, send_with_headers)
