"""The line to one viewer: short buffers, so that no old image waits in them, and cut when it is stalled.

An ASGI application cannot reach its socket. uvicorn lets the protocol class be chosen, and hands each
application a state of its own: through both, the line comes to the streams as `scope["state"]`. Under
another server the streams work as well, with longer buffers.
"""

import asyncio
import socket
import struct
from collections.abc import MutableMapping
from dataclasses import dataclass, field
from typing import Any, cast

import uvicorn
from starlette.types import ASGIApp
from uvicorn.protocols.http.h11_impl import H11Protocol, RequestResponseCycle
from uvicorn.protocols.websockets.websockets_sansio_impl import WebSocketsSansIOProtocol

from server.security.tls.handshake import ImpatientLoop

STATE_KEY = "coaxial_line"
# What may lie unsent in the kernel: with more, a slow viewer sees images that are seconds old.
UNSENT_BYTES = 16_384
DRAIN_STEP_S = 0.004
# A line that takes little is let go as well, when one message needs so many times the patience.
PATIENCES = 5
RESET_ON_CLOSE = struct.pack("ii", 1, 0)
# The largest message that anybody may send up: a camera message of the 3-D scene.
LARGEST_UPWARD_BYTES = 65_536


def _set_event() -> asyncio.Event:
    event = asyncio.Event()
    event.set()
    return event


@dataclass(slots=True)
class Line:
    """The connection to one client.

    Attributes:
        is_endless: its answer never ends by itself, so a closing server need not wait for it.
        is_free: set while nothing waits to be handed to the kernel; the protocol tells.
    """

    transport: asyncio.Transport
    is_endless: bool = False
    is_free: asyncio.Event = field(default_factory=_set_event)

    @property
    def unsent_bytes(self) -> int:
        """What this process still holds of what was sent."""
        below = below_tls(self.transport)
        held = self.transport.get_write_buffer_size()
        # What TLS has sealed lies below it, where it does not count it itself.
        return held if below is None else held + below.get_write_buffer_size()

    async def drained(self, *, patience_s: float) -> None:
        """Wait until everything was handed to the kernel: the next message is chosen only then.

        A server's own sending returns as soon as a message lies in its buffer, where it would grow old.

        Raises:
            TimeoutError: the line took nothing at all for this long, or needs several times as long for all.
        """
        async with asyncio.timeout(patience_s * PATIENCES):
            while (unsent := self._unsent()) > 0:
                if self.is_free.is_set():
                    # A protocol that does not tell when it has sent.
                    await asyncio.sleep(DRAIN_STEP_S)
                    continue
                try:
                    async with asyncio.timeout(patience_s):
                        await self.is_free.wait()
                except TimeoutError:
                    if self._unsent() >= unsent:
                        raise

    def _unsent(self) -> int:
        return 0 if self.transport.is_closing() else self.unsent_bytes

    def cut(self) -> None:
        """End it now; what was not sent is thrown away, here and in the kernel."""
        raw = cast("socket.socket | None", self.transport.get_extra_info("socket"))
        if raw is not None and not self.transport.is_closing():
            # Closed quietly, the kernel would keep megabytes for minutes for somebody who takes nothing.
            raw.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, RESET_ON_CLOSE)
        self.transport.abort()


def below_tls(transport: asyncio.Transport) -> asyncio.Transport | None:
    """The transport of sealed bytes under a transport of TLS; None where there is none."""
    below = getattr(getattr(transport, "_ssl_protocol", None), "_transport", None)
    return below if isinstance(below, asyncio.Transport) else None


def line_of(scope: MutableMapping[str, Any]) -> Line | None:
    """The line of a request or a socket, None under a server that does not give it."""
    line = scope.get("state", {}).get(STATE_KEY)
    return line if isinstance(line, Line) else None


def cut_line(scope: MutableMapping[str, Any]) -> None:
    """End the connection of a request or a socket now, where the server lets us."""
    line = line_of(scope)
    if line is not None:
        line.cut()


class ViewerProtocol(H11Protocol):
    """uvicorn's HTTP protocol, with short buffers and its line in the state of each request.

    Attributes:
        request_within_s: a connection that has not sent the head of its first request by then is cut, and so
            is one that needs longer than this for the head of a later one: each holds a file of the process,
            and when those run out nobody else is let in.
    """

    request_within_s = 10.0
    _head_due: asyncio.TimerHandle | None = None

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]  # as its base
        """Shorten the buffers, and remember the line."""
        super().connection_made(transport)
        self._line = Line(transport)
        self._head_due = self.loop.call_later(self.request_within_s, self._end_without_request)
        self.app_state = {**self.app_state, STATE_KEY: self._line}
        # Not 0: where TLS lies between, an empty buffer would count as a full one.
        transport.set_write_buffer_limits(high=1, low=0)
        raw = cast("socket.socket | None", transport.get_extra_info("socket"))
        if raw is not None and hasattr(socket, "TCP_NOTSENT_LOWAT"):
            raw.setsockopt(socket.IPPROTO_TCP, socket.TCP_NOTSENT_LOWAT, UNSENT_BYTES)

    def data_received(self, data: bytes) -> None:
        """Take what came; from the first byte of a request on, its head has to be whole in time."""
        if self._head_due is None and self._awaits_head():
            self._head_due = self.loop.call_later(self.request_within_s, self._end_without_request)
        super().data_received(data)
        if self._head_due is not None and not self._awaits_head():
            self._head_due.cancel()
            self._head_due = None

    def pause_writing(self) -> None:
        """Something waits to be sent."""
        super().pause_writing()
        self._line.is_free.clear()

    def resume_writing(self) -> None:
        """Everything was handed to the kernel."""
        super().resume_writing()
        self._line.is_free.set()

    def connection_lost(self, exc: Exception | None) -> None:
        """Nobody need wait for this line any more."""
        if self._head_due is not None:
            self._head_due.cancel()
        self._line.is_free.set()
        super().connection_lost(exc)

    def _awaits_head(self) -> bool:
        # A WebSocket has taken the line over: its protocol is another.
        if self._line.transport.get_protocol() is not self:
            return False
        cycle = cast("RequestResponseCycle | None", self.cycle)
        return cycle is None or cycle.response_complete

    def _end_without_request(self) -> None:
        if self._awaits_head():
            self._line.cut()

    def shutdown(self) -> None:
        """End endless answers at once, let others finish."""
        if self._line.is_endless:
            self._line.cut()
        else:
            super().shutdown()


class ViewerSocket(WebSocketsSansIOProtocol):
    """uvicorn's WebSocket protocol, which tells the line when everything was sent."""

    def pause_writing(self) -> None:
        """Something waits to be sent."""
        super().pause_writing()
        self._told_line(free=False)

    def resume_writing(self) -> None:
        """Everything was handed to the kernel."""
        super().resume_writing()
        self._told_line(free=True)

    def connection_lost(self, exc: Exception | None) -> None:
        """Nobody need wait for this line any more."""
        super().connection_lost(exc)
        self._told_line(free=True)

    def _told_line(self, *, free: bool) -> None:
        line = line_of({"state": self.app_state})
        if line is not None and free:
            line.is_free.set()
        elif line is not None:
            line.is_free.clear()


def uvicorn_config(app: ASGIApp, *, host: str, port: int) -> uvicorn.Config:
    """How this application is served: one worker, short buffers, nothing compressed that is JPEG already."""
    return uvicorn.Config(
        app,
        host=host,
        port=port,
        loop=f"{ImpatientLoop.__module__}:{ImpatientLoop.__name__}",
        http=ViewerProtocol,
        ws=ViewerSocket,
        ws_max_size=LARGEST_UPWARD_BYTES,
        ws_per_message_deflate=False,
        proxy_headers=False,
        server_header=False,
        access_log=False,
        log_config=None,
        timeout_graceful_shutdown=2,
    )
