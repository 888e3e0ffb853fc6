"""Drain the request body before an early response.

Many clients read the response only after they have sent the whole body. If the connection is closed before,
they see a broken pipe instead of the error. uvicorn closes it early for `Connection: close`.
"""

import asyncio

from starlette.types import ASGIApp, Message, Receive, Scope, Send

# After this time the response is sent although the body is incomplete, and the connection is closed.
DRAIN_TIMEOUT_S = 20.0


class BodyDrainMiddleware:
    """ASGI middleware: delay the response until the request body is read, at most `DRAIN_TIMEOUT_S`."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Run the application; discard the rest of the body before the response starts."""
        if scope["type"] != "http" or not _has_body(scope):
            await self._app(scope, receive, send)
            return
        body = _Body(receive)

        async def answer(message: Message) -> None:
            if message["type"] == "http.response.start" and not _closes_connection(message):
                await body.drain()
            await send(message)

        await self._app(scope, body.receive, answer)


class _Body:
    """The body of one request, with a flag for its end."""

    def __init__(self, receive: Receive) -> None:
        self._receive = receive
        self._ended = False

    async def receive(self) -> Message:
        message = await self._receive()
        if message["type"] == "http.disconnect" or not message.get("more_body", False):
            self._ended = True
        return message

    async def drain(self) -> None:
        try:
            async with asyncio.timeout(DRAIN_TIMEOUT_S):
                while not self._ended:
                    await self.receive()
        except TimeoutError:
            self._ended = True


def _closes_connection(message: Message) -> bool:
    """Return whether the response closes the connection."""
    return (b"connection", b"close") in [(key.lower(), value) for key, value in message.get("headers", ())]


def _has_body(scope: Scope) -> bool:
    """Return whether the client sends a body at once; with `Expect` it waits for the response."""
    headers = dict(scope["headers"])
    announced = headers.get(b"content-length", b"0") != b"0" or b"transfer-encoding" in headers
    return announced and b"expect" not in headers
