"""Reads the language of a request from its `Accept-Language` header."""

from starlette.datastructures import Headers
from starlette.types import ASGIApp, Receive, Scope, Send

from server.texts import set_requested_language


class LanguageMiddleware:
    """ASGI middleware: answers are written in the language that the request prefers."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Set the language of the context, and run the application."""
        if scope["type"] == "http":
            set_requested_language(Headers(scope=scope).get("accept-language", ""))
        await self._app(scope, receive, send)
