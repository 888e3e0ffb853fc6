"""Connection to one viewer: short buffers, so that no old image waits in them, and aborted when it stalls.

An ASGI application cannot reach its socket. uvicorn lets the protocol class be chosen, and passes a state to
each application: through both, the streams get the connection as `scope["state"]`. Under another server the
streams work as well, with longer buffers.
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

from server.security.tls.handshake import HandshakeTimeoutLoop

STATE_KEY = "coaxial_line"
# Maximum unsent bytes in the kernel: with more, a slow viewer sees images that are seconds old.
UNSENT_BYTES = 16_384
DRAIN_STEP_S = 0.004
# A slow connection is closed too, when one message needs this multiple of the timeout.
TOTAL_TIMEOUT_FACTOR = 5
RESET_ON_CLOSE = struct.pack("ii", 1, 0)
# The largest message that a client may send: a camera message of the 3-D scene.
MAX_CLIENT_MESSAGE_BYTES = 65_536


def _set_event() -> asyncio.Event:
    event = asyncio.Event()
    event.set()
    return event


@dataclass(slots=True)
class Connection:
    """The connection to one client.

    Attributes:
        is_endless: whether its response never ends by itself, so that a closing server need not wait for it.
        is_writable: set while the write buffer is empty; maintained by the protocol.
    """

    transport: asyncio.Transport
    is_endless: bool = False
    is_writable: asyncio.Event = field(default_factory=_set_event)

    @property
    def unsent_bytes(self) -> int:
        """Bytes in the write buffers of this process."""
        below = below_tls(self.transport)
        buffered_bytes = self.transport.get_write_buffer_size()
        # Encrypted bytes lie in the transport below, where TLS does not count them itself.
        return buffered_bytes if below is None else buffered_bytes + below.get_write_buffer_size()

    async def drained(self, *, timeout_s: float) -> None:
        """Wait until the write buffer is empty: only then is the next message chosen.

        The server's own send returns as soon as a message is in its buffer, where it would grow old.

        Raises:
            TimeoutError: nothing was sent for this long, or the whole needs several times as long.
        """
        async with asyncio.timeout(timeout_s * TOTAL_TIMEOUT_FACTOR):
            while (unsent := self._unsent()) > 0:
                if self.is_writable.is_set():
                    # A protocol that does not report an empty buffer.
                    await asyncio.sleep(DRAIN_STEP_S)
                    continue
                try:
                    async with asyncio.timeout(timeout_s):
                        await self.is_writable.wait()
                except TimeoutError:
                    if self._unsent() >= unsent:
                        raise

    def _unsent(self) -> int:
        return 0 if self.transport.is_closing() else self.unsent_bytes

    def abort(self) -> None:
        """Close now; unsent data is discarded, here and in the kernel."""
        raw = cast("socket.socket | None", self.transport.get_extra_info("socket"))
        if raw is not None and not self.transport.is_closing():
            # Without SO_LINGER the kernel would keep megabytes for minutes for a client that reads nothing.
            raw.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, RESET_ON_CLOSE)
        self.transport.abort()


def below_tls(transport: asyncio.Transport) -> asyncio.Transport | None:
    """Return the transport of encrypted bytes below a TLS transport; None without TLS."""
    below = getattr(getattr(transport, "_ssl_protocol", None), "_transport", None)
    return below if isinstance(below, asyncio.Transport) else None


def connection_of(scope: MutableMapping[str, Any]) -> Connection | None:
    """Return the connection of a request or socket; None under a server that does not provide it."""
    connection = scope.get("state", {}).get(STATE_KEY)
    return connection if isinstance(connection, Connection) else None


def abort_connection(scope: MutableMapping[str, Any]) -> None:
    """Abort the connection of a request or socket, where the server allows it."""
    connection = connection_of(scope)
    if connection is not None:
        connection.abort()


class ViewerHttpProtocol(H11Protocol):
    """uvicorn's HTTP protocol, with short buffers and the connection in the state of each request.

    Attributes:
        request_within_s: maximum time from connecting to the complete head of the first request, and for the
            head of a later one: each connection needs a file descriptor, and when those run out nobody else
            can connect.
    """

    request_within_s = 10.0
    _head_due: asyncio.TimerHandle | None = None

    def connection_made(self, transport: asyncio.Transport) -> None:
        """Shorten the buffers, and store the connection."""
        super().connection_made(transport)
        self._connection = Connection(transport)
        self._head_due = self.loop.call_later(self.request_within_s, self._end_without_request)
        self.app_state = {**self.app_state, STATE_KEY: self._connection}
        # Not 0: under TLS an empty buffer would count as full.
        transport.set_write_buffer_limits(high=1, low=0)
        raw = cast("socket.socket | None", transport.get_extra_info("socket"))
        if raw is not None and hasattr(socket, "TCP_NOTSENT_LOWAT"):
            raw.setsockopt(socket.IPPROTO_TCP, socket.TCP_NOTSENT_LOWAT, UNSENT_BYTES)

    def data_received(self, data: bytes) -> None:
        """Handle data; the head of a request must be complete in time from its first byte on."""
        if self._head_due is None and self._awaits_head():
            self._head_due = self.loop.call_later(self.request_within_s, self._end_without_request)
        super().data_received(data)
        if self._head_due is not None and not self._awaits_head():
            self._head_due.cancel()
            self._head_due = None

    def pause_writing(self) -> None:
        """Mark the connection as not writable."""
        super().pause_writing()
        self._connection.is_writable.clear()

    def resume_writing(self) -> None:
        """Mark the connection as writable."""
        super().resume_writing()
        self._connection.is_writable.set()

    def connection_lost(self, exc: Exception | None) -> None:
        """Wake whoever waits for this connection."""
        if self._head_due is not None:
            self._head_due.cancel()
        self._connection.is_writable.set()
        super().connection_lost(exc)

    def _awaits_head(self) -> bool:
        # A WebSocket has taken over the connection: its protocol is another.
        if self._connection.transport.get_protocol() is not self:
            return False
        cycle = cast("RequestResponseCycle | None", self.cycle)
        return cycle is None or cycle.response_complete

    def _end_without_request(self) -> None:
        if self._awaits_head():
            self._connection.abort()

    def shutdown(self) -> None:
        """Abort endless responses, let others finish."""
        if self._connection.is_endless:
            self._connection.abort()
        else:
            super().shutdown()


class ViewerWebSocketProtocol(WebSocketsSansIOProtocol):
    """uvicorn's WebSocket protocol, which also maintains `is_writable`."""

    def pause_writing(self) -> None:
        """Mark the connection as not writable."""
        super().pause_writing()
        self._set_writable(free=False)

    def resume_writing(self) -> None:
        """Mark the connection as writable."""
        super().resume_writing()
        self._set_writable(free=True)

    def connection_lost(self, exc: Exception | None) -> None:
        """Wake whoever waits for this connection."""
        super().connection_lost(exc)
        self._set_writable(free=True)

    def _set_writable(self, *, free: bool) -> None:
        connection = connection_of({"state": self.app_state})
        if connection is not None and free:
            connection.is_writable.set()
        elif connection is not None:
            connection.is_writable.clear()


def uvicorn_config(app: ASGIApp, *, host: str, port: int) -> uvicorn.Config:
    """Return the server's configuration: one worker, short buffers, no compression of JPEG."""
    return uvicorn.Config(
        app,
        host=host,
        port=port,
        loop=f"{HandshakeTimeoutLoop.__module__}:{HandshakeTimeoutLoop.__name__}",
        http=ViewerHttpProtocol,
        ws=ViewerWebSocketProtocol,
        ws_max_size=MAX_CLIENT_MESSAGE_BYTES,
        ws_per_message_deflate=False,
        proxy_headers=False,
        server_header=False,
        access_log=False,
        log_config=None,
        timeout_graceful_shutdown=2,
    )
