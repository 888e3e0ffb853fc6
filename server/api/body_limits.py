"""Limits on the size and the duration of request bodies, against exhaustion of memory and connections.

Uploads have their own size limits and are streamed to the disk (`uploads.py`). They may take as long as they
need, as long as data keep arriving.
"""

import asyncio
from dataclasses import dataclass
from typing import Final

from starlette.types import ASGIApp, Message, Receive, Scope, Send

from tracker.errors import NavigationError

SIGN_IN: Final = "/api/session"
MAX_TO_SIGN_IN_BYTES, MAX_BYTES = 16 * 2**10, 4 * 2**20
SIGN_IN_WITHIN_S = 20.0
FASTER = "Send it again over a faster connection."
# 13 kbit/s: a slower client blocks a connection.
PIECE_BYTES, PIECE_WITHIN_S = 32 * 2**10, 20.0
UPLOADS = frozenset(
    {
        "/api/cases/archive",
        "/api/ct",
        "/api/labels",
        "/api/markers",
        "/api/plan/import",
        "/api/surface",
        "/api/camera/collection/images",
    }
)


class BodyTooLarge(NavigationError):
    """The body exceeds the permitted size."""


class BodyTooSlow(NavigationError):
    """The body was not received in time."""


class BodyLimitMiddleware:
    """ASGI middleware: reject a request body that is too large or too slow.

    The body of a login must arrive within `SIGN_IN_WITHIN_S`, because it is accepted without a session. All
    other bodies, including uploads, must deliver `PIECE_BYTES` in each `PIECE_WITHIN_S`.
    """

    def __init__(self, app: ASGIApp) -> None:
        self._app = app

    async def __call__(self, scope: Scope, receive: Receive, send: Send) -> None:
        """Run the application with a limited `receive`."""
        if scope["type"] != "http":
            await self._app(scope, receive, send)
            return
        path = scope["path"]
        signs_in = path == SIGN_IN
        body = _Body(
            receive,
            max_bytes=None if path in UPLOADS else MAX_TO_SIGN_IN_BYTES if signs_in else MAX_BYTES,
            timeout=ReceiveTimeout.total(SIGN_IN_WITHIN_S)
            if signs_in
            else ReceiveTimeout.per_piece(PIECE_WITHIN_S),
        )
        announced = dict(scope["headers"]).get(b"content-length", b"0")
        body.announced_bytes = int(announced) if announced.isdigit() else 0
        await self._app(scope, body.receive, send)


@dataclass(slots=True, kw_only=True)
class ReceiveTimeout:
    """Remaining time to receive a body; only time spent in `receive` counts.

    Attributes:
        limit_s: Initial time, restored after each piece.
        piece_bytes: Size of a piece that restores the time; None never restores it.
        left_s: Remaining time.
        received_bytes: Bytes received since the time was last restored.
    """

    limit_s: float
    piece_bytes: int | None
    left_s: float
    received_bytes: int = 0

    @classmethod
    def total(cls, limit_s: float) -> "ReceiveTimeout":
        """Return a timeout for the whole body."""
        return cls(limit_s=limit_s, piece_bytes=None, left_s=limit_s)

    @classmethod
    def per_piece(cls, limit_s: float) -> "ReceiveTimeout":
        """Return a timeout for each `PIECE_BYTES` of the body."""
        return cls(limit_s=limit_s, piece_bytes=PIECE_BYTES, left_s=limit_s)

    def spend(self, waited_s: float, received_bytes: int) -> None:
        """Record a wait and the bytes that arrived."""
        self.left_s -= waited_s
        self.received_bytes += received_bytes
        if self.piece_bytes is not None and self.received_bytes >= self.piece_bytes:
            self.left_s, self.received_bytes = self.limit_s, 0

    def rejection(self, taken_bytes: int) -> BodyTooSlow:
        """Return the error for an expired timeout."""
        if self.piece_bytes is None:
            return BodyTooSlow(
                "BODY_TOO_SLOW",
                f"the request was not complete after {self.limit_s:g} s",
                FASTER,
                {"allowed_s": self.limit_s, "taken_bytes": taken_bytes},
            )
        taken_kb, last_kb, min_kb = (
            size / 1024 for size in (taken_bytes, self.received_bytes, self.piece_bytes)
        )
        return BodyTooSlow(
            "BODY_TOO_SLOW",
            f"{taken_kb:.1f} kB of the request arrived, the last {last_kb:.1f} kB in {self.limit_s:g} s; "
            f"the minimum is {min_kb:g} kB in this time",
            FASTER,
            {
                "allowed_s": self.limit_s,
                "taken_bytes": taken_bytes,
                "taken_kb": taken_kb,
                "last_kb": last_kb,
                "min_kb": min_kb,
            },
        )


class _Body:
    """The body of one request, with its limits."""

    def __init__(self, receive: Receive, *, max_bytes: int | None, timeout: ReceiveTimeout) -> None:
        self._receive = receive
        self._max_bytes = max_bytes
        self._timeout = timeout
        self._taken_bytes = 0
        self._is_complete = False
        self.announced_bytes = 0

    async def receive(self) -> Message:
        """Receive the next part of the body.

        Raises:
            BodyTooLarge, BodyTooSlow: a limit is exceeded.
        """
        if self._is_complete:
            # The body is complete; further calls wait for the disconnect, without a limit.
            return await self._receive()
        self._reject_above(self.announced_bytes)
        loop = asyncio.get_running_loop()
        began_s = loop.time()
        try:
            async with asyncio.timeout(self._timeout.left_s):
                message = await self._receive()
        except TimeoutError:
            raise self._timeout.rejection(self._taken_bytes) from None
        received_bytes = len(message.get("body", b""))
        self._timeout.spend(loop.time() - began_s, received_bytes)
        self._taken_bytes += received_bytes
        self._reject_above(self._taken_bytes)
        self._is_complete = not message.get("more_body", False)
        return message

    def _reject_above(self, size_bytes: int) -> None:
        if self._max_bytes is not None and size_bytes > self._max_bytes:
            size, allowed = size_bytes / 1024, self._max_bytes / 1024
            raise BodyTooLarge(
                "BODY_TOO_LARGE",
                f"the request has at least {size:.0f} kB, the maximum is {allowed:g} kB",
                "Send less data per request; send files to the upload addresses.",
                {
                    "size_bytes": size_bytes,
                    "allowed_bytes": self._max_bytes,
                    "size_kb": size,
                    "allowed_kb": allowed,
                },
            )
