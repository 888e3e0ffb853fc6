"""How much may be sent in a body, and how long it may take: nobody fills the memory, or holds lines for ever.

What is sent as a file has limits of its own, and goes to the disk as it comes (`uploads.py`).
"""

import asyncio
from typing import Final

from starlette.types import ASGIApp, Message, Receive, Scope, Send

from tracker.errors import NavigationError

SIGN_IN: Final = "/api/session"
MOST_TO_SIGN_IN_BYTES, MOST_BYTES = 16 * 2**10, 4 * 2**20
SIGN_IN_WITHIN_S = 20.0
UPLOADS = frozenset(
    {
        "/api/cases/archive",
        "/api/ct",
        "/api/markers",
        "/api/plan/import",
        "/api/surface",
        "/api/camera/collection/images",
    }
)


class BodyTooLarge(NavigationError):
    """More was sent than is taken."""


class BodyTooSlow(NavigationError):
    """It did not come in time."""


class LimitedBodies:
    """ASGI middleware: the body of a request ends with a refusal where it is too long, or takes too long.

    Only who signs in is asked to hurry: nobody else gets so far without a session.
    """

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass on, with an eye on what is received."""
        if scope["type"] != "http" or scope["path"] in UPLOADS:
            await self._app(scope, receive, send)
            return
        signs_in = scope["path"] == SIGN_IN
        body = _Body(receive, most_bytes=MOST_TO_SIGN_IN_BYTES if signs_in else MOST_BYTES)
        announced = dict(scope["headers"]).get(b"content-length", b"0")
        body.announced_bytes = int(announced) if announced.isdigit() else 0
        if signs_in:
            body.until_s = asyncio.get_running_loop().time() + SIGN_IN_WITHIN_S
        await self._app(scope, body.receive, send)


class _Body:
    """What comes of one body."""

    def __init__(self, receive: Receive, *, most_bytes: int) -> None:
        self._receive = receive
        self._most_bytes = most_bytes
        self._taken_bytes = 0
        self.announced_bytes = 0
        self.until_s: float | None = None

    async def receive(self) -> Message:
        """The next piece.

        Raises:
            BodyTooLarge, BodyTooSlow: there is no more of it.
        """
        self._refuse_above(self.announced_bytes)
        try:
            async with asyncio.timeout_at(self.until_s):
                message = await self._receive()
        except TimeoutError:
            raise BodyTooSlow(
                "BODY_TOO_SLOW",
                f"the request was not whole after {SIGN_IN_WITHIN_S:g} s",
                "Send it again over a line that stands.",
                {"allowed_s": SIGN_IN_WITHIN_S},
            ) from None
        self._taken_bytes += len(message.get("body", b""))
        self._refuse_above(self._taken_bytes)
        if not message.get("more_body", False):
            # From here on it is waited for the client to go, which is in no hurry.
            self.until_s = None
        return message

    def _refuse_above(self, size_bytes: int) -> None:
        if size_bytes > self._most_bytes:
            size, allowed = size_bytes / 1024, self._most_bytes / 1024
            raise BodyTooLarge(
                "BODY_TOO_LARGE",
                f"the request has {size:.0f} kB or more, allowed are {allowed:g} kB",
                "Send less at once; files go to the addresses that take files.",
                {"size_bytes": size_bytes, "allowed_bytes": self._most_bytes},
            )
