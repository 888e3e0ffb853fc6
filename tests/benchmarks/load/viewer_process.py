"""Viewers of a running server in a separate process: they read, count and discard.

python -m tests.benchmarks.load.viewer_process --port N --seconds S --view 6 --mjpeg 2 --live 2
python -m tests.benchmarks.load.viewer_process --port N --seconds S --slow

Writes one JSON object: what each viewer received.
"""

import argparse
import asyncio
import contextlib
import json
import os
import socket
import sys
import time
from dataclasses import asdict, dataclass, field
from functools import partial
from typing import cast

from tests.benchmarks.load.stream_readers import Frames, Parts, ReceivedImages

READ_BYTES = 1 << 18
NICE = 10
# A slow connection buffers little: with the usual megabytes a picture would wait in the viewer's kernel.
SLOW_BUFFER_BYTES = 16_384
SLOW_BYTES_PER_S = 125_000.0
CREDIT = b'{"next": true}'
# A text message in one frame, masked with zeros, as a client has to mask it.
CREDIT_FRAME = bytes([0x81, 0x80 | len(CREDIT), 0, 0, 0, 0]) + CREDIT
UPGRADE = (
    "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
    "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n"
)
PATHS = {"view": "/ws/view", "live": "/ws/live", "mjpeg": "/video/main.mjpg"}


@dataclass(slots=True)
class Viewer(asyncio.BufferedProtocol):
    """One viewer; a view sends credit for the next image as soon as it has one.

    Attributes:
        kind: view, live or mjpeg.
        bytes_per_s: bandwidth of its connection; None for no limit.
        received: the images.
    """

    kind: str
    bytes_per_s: float | None = None
    received: ReceivedImages = field(default_factory=ReceivedImages)
    is_open: bool = False
    _resume_at_s: float = 0.0
    _buffer: bytearray = field(default_factory=lambda: bytearray(READ_BYTES), repr=False)
    _answer: bytes = b""
    _reader: Frames | Parts | None = None
    _transport: asyncio.Transport | None = None

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Send the request."""
        self._transport = cast("asyncio.Transport", transport)
        head = f"GET {PATHS[self.kind]} HTTP/1.1\r\nHost: 127.0.0.1\r\n"
        upgrade = "" if self.kind == "mjpeg" else UPGRADE
        self._transport.write(f"{head}{upgrade}\r\n".encode())

    def get_buffer(self, sizehint: int) -> bytearray:  # noqa: ARG002  the base has it
        """Return the receive buffer."""
        return self._buffer

    def buffer_updated(self, nbytes: int) -> None:
        """Count the received bytes, and send credit after each image."""
        data, now_s = memoryview(self._buffer)[:nbytes], time.monotonic()
        self._throttle(nbytes)
        if self._reader is None:
            self._answer += bytes(data)
            head, ended, rest = self._answer.partition(b"\r\n\r\n")
            if not ended:
                return
            self.is_open = head.split(b" ", 2)[1] in (b"101", b"200")
            self._reader = Parts(self.received) if self.kind == "mjpeg" else Frames(self.received)
            self._send_credit()
            data = memoryview(rest)
        if self._reader.read(data, now_s=now_s):
            self._send_credit()

    def connection_lost(self, exc: Exception | None) -> None:
        """Mark the connection as closed by the server."""
        del exc
        self.is_open = False

    def _send_credit(self) -> None:
        if self.kind == "view" and self._transport is not None:
            self._transport.write(CREDIT_FRAME)

    def _throttle(self, nbytes: int) -> None:
        if self.bytes_per_s is None or self._transport is None:
            return
        loop = asyncio.get_running_loop()
        self._resume_at_s = max(self._resume_at_s, loop.time()) + nbytes / self.bytes_per_s
        self._transport.pause_reading()
        loop.call_at(self._resume_at_s, self._resume)

    def _resume(self) -> None:
        if self._transport is not None and not self._transport.is_closing():
            self._transport.resume_reading()


async def watch(port: int, viewers: list[Viewer], *, settling_s: float, seconds: float) -> None:
    """Connect all viewers, let them settle, and count for this long."""
    loop = asyncio.get_running_loop()
    for viewer in viewers:
        line = socket.socket()
        if viewer.bytes_per_s is not None:
            line.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, SLOW_BUFFER_BYTES)
        line.setblocking(False)
        await loop.sock_connect(line, ("127.0.0.1", port))
        await loop.create_connection(partial(_itself, viewer), sock=line)
    await asyncio.sleep(settling_s)
    for viewer in viewers:
        viewer.received.ages_ms.clear()
        viewer.received.scales.clear()
        viewer.received.total_bytes = 0
    await asyncio.sleep(seconds)


def _itself(viewer: Viewer) -> Viewer:
    return viewer


def main() -> None:
    """Run the viewers, and print what they received."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--port", type=int, required=True)
    parser.add_argument("--settling", type=float, default=0.0)
    parser.add_argument("--seconds", type=float, required=True)
    for kind in PATHS:
        parser.add_argument(f"--{kind}", type=int, default=0)
    parser.add_argument("--slow", action="store_true")
    given = parser.parse_args()
    # Real viewers run on other machines: a lower priority keeps these from slowing the server.
    with contextlib.suppress(OSError):
        os.nice(NICE)
    viewers = [Viewer(kind) for kind in PATHS for _ in range(getattr(given, kind))]
    if given.slow:
        viewers.append(Viewer("view", bytes_per_s=SLOW_BYTES_PER_S))
    asyncio.run(watch(given.port, viewers, settling_s=given.settling, seconds=given.seconds))
    reported = [
        {"kind": one.kind, "is_open": one.is_open, "seconds": given.seconds, **asdict(one.received)}
        for one in viewers
    ]
    json.dump(reported, sys.stdout)


if __name__ == "__main__":
    main()
