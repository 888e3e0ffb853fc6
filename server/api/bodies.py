"""How much may be sent in a body, and how long it may take: nobody fills the memory, or holds lines for ever.

What is sent as a file has sizes of its own, and goes to the disk as it comes (`uploads.py`). It may take as
long as a thin line needs, as long as something comes.
"""

import asyncio
from dataclasses import dataclass
from typing import Final

from starlette.types import ASGIApp, Message, Receive, Scope, Send

from tracker.errors import NavigationError

SIGN_IN: Final = "/api/session"
MAX_TO_SIGN_IN_BYTES, MAX_BYTES = 16 * 2**10, 4 * 2**20
SIGN_IN_WITHIN_S = 20.0
# 13 kbit/s: whoever sends less holds a line, and means nothing else by it.
PIECE_BYTES, PIECE_WITHIN_S = 32 * 2**10, 20.0
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

    Who signs in must have sent all of it within `SIGN_IN_WITHIN_S`, because anybody gets so far without a
    session. All others, also those who send files, must go on sending: `PIECE_BYTES` in each
    `PIECE_WITHIN_S`.
    """

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Pass on, with an eye on what is received."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        path = scope["path"]
        signs_in = path == SIGN_IN
        body = _Body(
            receive,
            max_bytes=None if path in UPLOADS else MAX_TO_SIGN_IN_BYTES if signs_in else MAX_BYTES,
            patience=Patience.once(SIGN_IN_WITHIN_S) if signs_in else Patience.anew(PIECE_WITHIN_S),
        )
        announced = dict(scope["headers"]).get(b"content-length", b"0")
        body.announced_bytes = int(announced) if announced.isdigit() else 0
        await self._app(scope, body.receive, send)


@dataclass(slots=True, kw_only=True)
class Patience:
    """How long a body is still waited for; time in which nobody waits for it does not count.

    Attributes:
        whole_s: to begin with, and each time when it is had anew.
        piece_bytes: after so many bytes it is had anew; None never.
        left_s: now.
        came_bytes: since it was had anew.
    """

    whole_s: float
    piece_bytes: int | None
    left_s: float
    came_bytes: int = 0

    @classmethod
    def once(cls, whole_s: float) -> "Patience":
        """For the whole body."""
        return cls(whole_s=whole_s, piece_bytes=None, left_s=whole_s)

    @classmethod
    def anew(cls, whole_s: float) -> "Patience":
        """For each `PIECE_BYTES` of it."""
        return cls(whole_s=whole_s, piece_bytes=PIECE_BYTES, left_s=whole_s)

    def spend(self, waited_s: float, came_bytes: int) -> None:
        """So long it was waited, and so much came."""
        self.left_s -= waited_s
        self.came_bytes += came_bytes
        if self.piece_bytes is not None and self.came_bytes >= self.piece_bytes:
            self.left_s, self.came_bytes = self.whole_s, 0

    def rejection(self, taken_bytes: int) -> BodyTooSlow:
        """What is said when there is none left."""
        message = f"the request was not whole after {self.whole_s:g} s"
        if self.piece_bytes is not None:
            taken, last = taken_bytes / 1024, self.came_bytes / 1024
            message = (
                f"of the request {taken:.1f} kB came, the last {last:.1f} kB of them in {self.whole_s:g} s; "
                f"asked for are {self.piece_bytes / 1024:g} kB in that time"
            )
        context: dict[str, object] = {"allowed_s": self.whole_s, "taken_bytes": taken_bytes}
        return BodyTooSlow("BODY_TOO_SLOW", message, "Send it again over a line that stands.", context)


class _Body:
    """What comes of one body."""

    def __init__(self, receive: Receive, *, max_bytes: int | None, patience: Patience) -> None:
        self._receive = receive
        self._max_bytes = max_bytes
        self._patience = patience
        self._taken_bytes = 0
        self._is_whole = False
        self.announced_bytes = 0

    async def receive(self) -> Message:
        """The next piece.

        Raises:
            BodyTooLarge, BodyTooSlow: there is no more of it.
        """
        if self._is_whole:
            # From here on it is waited for the client to go, which is in no hurry.
            return await self._receive()
        self._reject_above(self.announced_bytes)
        loop = asyncio.get_running_loop()
        began_s = loop.time()
        try:
            async with asyncio.timeout(self._patience.left_s):
                message = await self._receive()
        except TimeoutError:
            raise self._patience.rejection(self._taken_bytes) from None
        came_bytes = len(message.get("body", b""))
        self._patience.spend(loop.time() - began_s, came_bytes)
        self._taken_bytes += came_bytes
        self._reject_above(self._taken_bytes)
        self._is_whole = not message.get("more_body", False)
        return message

    def _reject_above(self, size_bytes: int) -> None:
        if self._max_bytes is not None and size_bytes > self._max_bytes:
            size, allowed = size_bytes / 1024, self._max_bytes / 1024
            raise BodyTooLarge(
                "BODY_TOO_LARGE",
                f"the request has {size:.0f} kB or more, allowed are {allowed:g} kB",
                "Send less at once; files go to the addresses that take files.",
                {"size_bytes": size_bytes, "allowed_bytes": self._max_bytes},
            )
