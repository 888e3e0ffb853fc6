"""The OpenIGTLink server: its listening socket and its clients.

As for the viewers of the page, nothing is queued. A slow client skips images, and one that reads nothing for
two seconds is disconnected. Each client has its own task, so that no client delays another. Requests of
clients change nothing in this program.
"""

import asyncio
import contextlib
import socket
import struct
import time
from collections.abc import Callable, Iterable
from typing import cast

import structlog

from server.config import Config
from server.live import Instant, LiveHub
from server.openigtlink.contents import PROGRAM, InstantContents, contents_of, status_of_device
from server.openigtlink.feed import Feed
from server.openigtlink.requests import RequestReader, TooManyRequestsError
from server.openigtlink_wire import (
    ChecksumError,
    Message,
    OversizeError,
    Status,
    StatusCode,
    WireError,
    pack,
)

SEND_TIMEOUT_S = 2.0
# Send buffer of the kernel, small so that no old pose waits in it. The messages of an instant need 1 kB.
UNSENT_BYTES = 4096
READ_BYTES = 4096
RESET_ON_CLOSE = struct.pack("ii", 1, 0)
_log = structlog.get_logger(__name__)

Now = Callable[[], float]


class OpenIgtLinkServer:
    """Sends the newest instant to all clients. For one event loop.

    Args:
        hub: Source of the instants.
        config: The settings; `openigtlink`, `limits` and the language of `video` are used.
        clock: Monotonic clock.
        wall_clock: Unix time.
    """

    def __init__(
        self, hub: LiveHub, config: Config, *, clock: Now = time.monotonic, wall_clock: Now = time.time
    ) -> None:
        self._hub = hub
        self._config = config
        self._clock, self._wall_clock = clock, wall_clock
        self._clients: set[asyncio.Task[None]] = set()
        self._server: asyncio.Server | None = None
        self._newest: tuple[Instant, InstantContents] | None = None

    async def start(self, listener: socket.socket) -> None:
        """Accept clients on a listening socket."""
        self._server = await asyncio.start_server(self._connected, sock=listener, limit=READ_BYTES)

    async def stop(self) -> None:
        """Disconnect all clients and close the socket."""
        if self._server is None:
            return
        self._server.close()
        for client in self._clients:
            client.cancel()
        if self._clients:
            await asyncio.wait(self._clients)
        await self._server.wait_closed()

    async def _connected(self, reader: asyncio.StreamReader, writer: asyncio.StreamWriter) -> None:
        task = cast("asyncio.Task[None]", asyncio.current_task())
        client = _Client(self, reader, writer)
        if len(self._clients) >= self._config.openigtlink.max_clients:
            _log.warning("openigtlink_client_rejected", clients=len(self._clients))
            full = Status(
                code=StatusCode.BUSY,
                name="TOO_MANY_CLIENTS",
                text=f"TOO_MANY_CLIENTS: {len(self._clients)} clients are connected, the maximum",
            )
            await client.say_goodbye(full)
            return
        self._clients.add(task)
        _log.info("openigtlink_client_connected", clients=len(self._clients))
        try:
            await client.run()
        except asyncio.CancelledError:
            # asyncio reports a cancelled handler as a failure of its own.
            client.abort()
        finally:
            self._clients.discard(task)
            _log.info("openigtlink_client_gone", clients=len(self._clients), skipped_instants=client.skipped)

    @property
    def hub(self) -> LiveHub:
        """Source of the instants."""
        return self._hub

    @property
    def config(self) -> Config:
        """The settings."""
        return self._config

    def times(self) -> tuple[float, float]:
        """Return monotonic time, and Unix time minus monotonic time."""
        now_s = self._clock()
        return now_s, self._wall_clock() - now_s

    def contents(self, instant: Instant) -> InstantContents:
        """Return the messages of an instant, computed once for all clients."""
        if self._newest is None or self._newest[0] is not instant:
            made = contents_of(instant, self._config.openigtlink, language=self._config.video.language)
            self._newest = instant, made
        return self._newest[1]


class _Client:
    """One client, with a sending and a receiving task."""

    def __init__(
        self, server: OpenIgtLinkServer, reader: asyncio.StreamReader, writer: asyncio.StreamWriter
    ) -> None:
        self._server = server
        self._reader, self._writer = reader, writer
        self._settings = server.config.openigtlink
        self._feed = Feed(server.config.limits)
        self._requests = RequestReader()
        self._sequence = -1
        self._next_at_s = -float("inf")
        self.skipped = 0
        writer.transport.set_write_buffer_limits(high=0)
        raw = cast("socket.socket", writer.get_extra_info("socket"))
        if hasattr(socket, "TCP_NOTSENT_LOWAT"):
            raw.setsockopt(socket.IPPROTO_TCP, socket.TCP_NOTSENT_LOWAT, UNSENT_BYTES)

    async def run(self) -> None:
        """Serve the client until it disconnects, misbehaves or reads nothing."""
        sides = [asyncio.create_task(side) for side in (self._send_instants(), self._listen())]
        try:
            await asyncio.wait(sides, return_when=asyncio.FIRST_COMPLETED)
        finally:
            for side in sides:
                side.cancel()
            await asyncio.wait(sides)
        for side in sides:
            failure = None if side.cancelled() else side.exception()
            if isinstance(failure, TimeoutError):
                _log.info("openigtlink_client_stalled", blocked_s=SEND_TIMEOUT_S)
            elif failure is not None and not isinstance(failure, OSError):
                _log.error("openigtlink_client_failed", exc_info=failure)
        self.abort()

    async def say_goodbye(self, status: Status) -> None:
        """Send a last status and close."""
        now_s, unix_offset_s = self._server.times()
        content = status_of_device(PROGRAM, status).content
        last = Message(type="STATUS", device=PROGRAM, timestamp_s=now_s + unix_offset_s, content=content)
        with contextlib.suppress(OSError, TimeoutError):
            await self._write([last])
            self._writer.close()
            async with asyncio.timeout(SEND_TIMEOUT_S):
                await self._writer.wait_closed()

    def abort(self) -> None:
        """Close at once; unsent data are discarded, also in the kernel."""
        transport = self._writer.transport
        raw = cast("socket.socket | None", self._writer.get_extra_info("socket"))
        if raw is not None and not transport.is_closing():
            raw.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, RESET_ON_CLOSE)
        transport.abort()

    async def _send_instants(self) -> None:
        while True:
            instant = await self._next_instant()
            now_s, unix_offset_s = self._server.times()
            if instant is None:
                await self._write(self._feed.expired(now_s=now_s, unix_offset_s=unix_offset_s))
                continue
            if self._sequence >= 0:
                self.skipped += instant.sequence - self._sequence - 1
            self._sequence = instant.sequence
            self._next_at_s = now_s + 1.0 / self._settings.max_rate_hz
            contents = self._server.contents(instant)
            await self._write(self._feed.messages(contents, now_s=now_s, unix_offset_s=unix_offset_s))

    async def _next_instant(self) -> Instant | None:
        """Return the newest instant when the rate allows one; None if content expires before."""
        now_s, _ = self._server.times()
        expires_at_s = self._feed.expires_at_s
        if now_s < self._next_at_s:
            await asyncio.sleep(min(self._next_at_s, max(expires_at_s, now_s)) - now_s)
            now_s, _ = self._server.times()
        if now_s > expires_at_s:
            return None
        wait_s = None if expires_at_s == float("inf") else expires_at_s - now_s
        try:
            async with asyncio.timeout(wait_s):
                return await self._server.hub.next_after(self._sequence)
        except TimeoutError:
            return None

    async def _listen(self) -> None:
        while content := await self._reader.read(READ_BYTES):
            try:
                now_s, _ = self._server.times()
                for request in self._requests.feed(content, now_s=now_s):
                    await self._answer(request)
            except WireError as error:
                code, name = _rejection(error)
                await self.say_goodbye(Status(code=code, name=name, text=f"{name}: {error}"))
                return

    async def _answer(self, request: Message | ChecksumError) -> None:
        now_s, unix_offset_s = self._server.times()
        if isinstance(request, Message):
            await self._write(self._feed.answer(request, now_s=now_s, unix_offset_s=unix_offset_s))
            return
        status = Status(code=StatusCode.CHECKSUM_ERROR, name="CHECKSUM", text=f"CHECKSUM: {request}")
        content = status_of_device(PROGRAM, status).content
        at_s = now_s + unix_offset_s
        await self._write([Message(type="STATUS", device=PROGRAM, timestamp_s=at_s, content=content)])

    async def _write(self, messages: Iterable[Message]) -> None:
        """Send messages, and wait until the kernel has accepted them.

        Raises:
            TimeoutError: The client read nothing for two seconds.
            OSError: The client has disconnected.
        """
        version = self._settings.header_version
        content = b"".join(pack(message, version=version) for message in messages)
        if not content:
            return
        self._writer.write(content)
        async with asyncio.timeout(SEND_TIMEOUT_S):
            await self._writer.drain()


def _rejection(error: WireError) -> tuple[StatusCode, str]:
    if isinstance(error, OversizeError):
        return StatusCode.OVERFLOW, "TOO_LONG"
    if isinstance(error, TooManyRequestsError):
        return StatusCode.BUSY, "TOO_MANY_REQUESTS"
    return StatusCode.UNKNOWN_ERROR, "NO_OPENIGTLINK"
