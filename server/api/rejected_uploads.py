"""A refusal before the end of an upload: what is still coming is taken off the line first.

Many clients read the answer only when they have sent everything; to them a line that is cut before is a
broken pipe, and why it was refused is lost. The web server cuts it where the
client said `Connection: close`.
"""

import asyncio

from starlette.types import ASGIApp, Message, Receive, Scope, Send

# Who has not sent the rest by then is answered all the same, and the line is cut.
LONGEST_S = 20.0


class RejectedUploads:
    """ASGI middleware: an answer begins when the body of its request is over, or after `LONGEST_S`."""

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass on; before the answer begins, throw away what is left of the body."""
        if scope["type"] != "http" or not _brings_body(scope):
            await self._app(scope, receive, send)
            return
        body = _Body(receive)

        async def answer(message: Message) -> None:
            if message["type"] == "http.response.start" and not _ends_line(message):
                await body.throw_away()
            await send(message)

        await self._app(scope, body.receive, answer)


class _Body:
    """The body of one request, which knows whether it is over."""

    def __init__(self, receive: Receive) -> None:
        self._receive = receive
        self._over = False

    async def receive(self) -> Message:
        message = await self._receive()
        if message["type"] == "http.disconnect" or not message.get("more_body", False):
            self._over = True
        return message

    async def throw_away(self) -> None:
        try:
            async with asyncio.timeout(LONGEST_S):
                while not self._over:
                    await self.receive()
        except TimeoutError:
            self._over = True


def _ends_line(message: Message) -> bool:
    """Whether nothing more shall be waited for."""
    return (b"connection", b"close") in [(key.lower(), value) for key, value in message.get("headers", ())]


def _brings_body(scope: Scope) -> bool:
    """Whether a body is announced that comes unasked; `Expect` waits for a word, and the refusal is one."""
    headers = dict(scope["headers"])
    announced = headers.get(b"content-length", b"0") != b"0" or b"transfer-encoding" in headers
    return announced and b"expect" not in headers
