"""The line to one viewer: short buffers, so that no old image waits in them, and cut when it is stalled.

An ASGI application cannot reach its socket. uvicorn lets the protocol class be chosen, and hands each
application a state of its own: through both, the line comes to the streams as `scope["state"]`. Under
another server the streams work as well, with longer buffers.
"""

import asyncio
import socket
from collections.abc import MutableMapping
from dataclasses import dataclass
from typing import Any, cast

import uvicorn
from starlette.types import ASGIApp
from uvicorn.protocols.http.h11_impl import H11Protocol

STATE_KEY = "coaxial_line"
# What may lie unsent in the kernel: with more, a slow viewer sees images that are seconds old.
UNSENT_BYTES = 16_384
DRAIN_STEP_S = 0.004
# The largest message that anybody may send up: a camera message of the 3-D scene.
LARGEST_UPWARD_BYTES = 65_536


@dataclass(slots=True)
class Line:
    """The connection to one client.

    Attributes:
        is_endless: its answer never ends by itself, so a closing server need not wait for it.
    """

    transport: asyncio.Transport
    is_endless: bool = False

    @property
    def unsent_bytes(self) -> int:
        """What this process still holds of what was sent."""
        below = below_tls(self.transport)
        held = self.transport.get_write_buffer_size()
        # What TLS has sealed lies below it, where it does not count it itself.
        return held if below is None else held + below.get_write_buffer_size()

    async def drained(self) -> None:
        """Wait until everything was handed to the kernel: the next message is chosen only then.

        A server's own sending returns as soon as a message lies in its buffer, where it would grow old.
        """
        while self.unsent_bytes > 0 and not self.transport.is_closing():
            await asyncio.sleep(DRAIN_STEP_S)

    def cut(self) -> None:
        """End it now; what was not sent is thrown away."""
        self.transport.abort()


def below_tls(transport: asyncio.Transport) -> asyncio.Transport | None:
    """The transport of sealed bytes under a transport of TLS; None where there is none."""
    below = getattr(getattr(transport, "_ssl_protocol", None), "_transport", None)
    return below if isinstance(below, asyncio.Transport) else None


def line_of(scope: MutableMapping[str, Any]) -> Line | None:
    """The line of a request or a socket, None under a server that does not give it."""
    line = scope.get("state", {}).get(STATE_KEY)
    return line if isinstance(line, Line) else None


class ViewerProtocol(H11Protocol):
    """uvicorn's HTTP protocol, with short buffers and its line in the state of each request.

    Attributes:
        request_within_s: a connection that has not sent its first request by then is cut: each holds a file
            of the process, and when those run out nobody else is let in.
    """

    request_within_s = 10.0

    def connection_made(self, transport: asyncio.Transport) -> None:  # type: ignore[override]  # as its base
        """Shorten the buffers, and remember the line."""
        super().connection_made(transport)
        self._line = Line(transport)
        self.loop.call_later(self.request_within_s, self._end_without_request)
        self.app_state = {**self.app_state, STATE_KEY: self._line}
        # Not 0: where TLS lies between, an empty buffer would count as a full one.
        transport.set_write_buffer_limits(high=1, low=0)
        raw = cast("socket.socket | None", transport.get_extra_info("socket"))
        if raw is not None and hasattr(socket, "TCP_NOTSENT_LOWAT"):
            raw.setsockopt(socket.IPPROTO_TCP, socket.TCP_NOTSENT_LOWAT, UNSENT_BYTES)

    def _end_without_request(self) -> None:
        # A WebSocket has taken the line over: its protocol is another.
        if cast("object | None", self.cycle) is None and self._line.transport.get_protocol() is self:
            self._line.cut()

    def shutdown(self) -> None:
        """End endless answers at once, let others finish."""
        if self._line.is_endless:
            self._line.cut()
        else:
            super().shutdown()


def uvicorn_config(app: ASGIApp, *, host: str, port: int) -> uvicorn.Config:
    """How this application is served: one worker, short buffers, nothing compressed that is JPEG already."""
    return uvicorn.Config(
        app,
        host=host,
        port=port,
        http=ViewerProtocol,
        ws="websockets-sansio",
        ws_max_size=LARGEST_UPWARD_BYTES,
        ws_per_message_deflate=False,
        proxy_headers=False,
        server_header=False,
        access_log=False,
        log_config=None,
        timeout_graceful_shutdown=2,
    )
