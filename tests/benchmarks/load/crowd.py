"""Viewers of a running server, in a process of their own: read, count, throw away.

python -m tests.benchmarks.load.crowd --port N --seconds S --view 6 --mjpeg 2 --live 2
python -m tests.benchmarks.load.crowd --port N --seconds S --thin

Writes one JSON object: what each viewer got.
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

from tests.benchmarks.load.reading import Frames, Got, Parts

READ_BYTES = 1 << 18
NICE = 10
# As little as a thin line holds: with the usual megabytes a picture would wait in the viewer's own kernel.
THIN_BUFFER_BYTES = 16_384
THIN_BYTES_PER_S = 125_000.0
GRANT = b'{"next": true}'
# A text message in one frame, masked with zeros, as a client has to mask it.
GRANT_FRAME = bytes([0x81, 0x80 | len(GRANT), 0, 0, 0, 0]) + GRANT
UPGRADE = (
    "Connection: Upgrade\r\nUpgrade: websocket\r\nSec-WebSocket-Version: 13\r\n"
    "Sec-WebSocket-Key: AAAAAAAAAAAAAAAAAAAAAA==\r\n"
)
PATHS = {"view": "/ws/view", "live": "/ws/live", "mjpeg": "/video/main.mjpg"}


@dataclass(slots=True)
class Viewer(asyncio.BufferedProtocol):
    """One viewer; a view asks for the next image as soon as it has one.

    Attributes:
        kind: view, live or mjpeg.
        bytes_per_s: what its line carries; None for all that comes.
        got: what came.
    """

    kind: str
    bytes_per_s: float | None = None
    got: Got = field(default_factory=Got)
    is_open: bool = False
    _owed_s: float = 0.0
    _buffer: bytearray = field(default_factory=lambda: bytearray(READ_BYTES), repr=False)
    _answer: bytes = b""
    _reader: Frames | Parts | None = None
    _transport: asyncio.Transport | None = None

    def connection_made(self, transport: asyncio.BaseTransport) -> None:
        """Ask to watch."""
        self._transport = cast("asyncio.Transport", transport)
        head = f"GET {PATHS[self.kind]} HTTP/1.1\r\nHost: 127.0.0.1\r\n"
        upgrade = "" if self.kind == "mjpeg" else UPGRADE
        self._transport.write(f"{head}{upgrade}\r\n".encode())

    def get_buffer(self, _sizehint: int) -> bytearray:
        """Where the next bytes go."""
        return self._buffer

    def buffer_updated(self, nbytes: int) -> None:
        """Count what came, and ask for more."""
        data, now_s = memoryview(self._buffer)[:nbytes], time.monotonic()
        self._hold_back(nbytes)
        if self._reader is None:
            self._answer += bytes(data)
            head, ended, rest = self._answer.partition(b"\r\n\r\n")
            if not ended:
                return
            self.is_open = head.split(b" ", 2)[1] in (b"101", b"200")
            self._reader = Parts(self.got) if self.kind == "mjpeg" else Frames(self.got)
            self._grant()
            data = memoryview(rest)
        if self._reader.read(data, now_s=now_s):
            self._grant()

    def connection_lost(self, exc: Exception | None) -> None:
        """The server let it go."""
        del exc
        self.is_open = False

    def _grant(self) -> None:
        if self.kind == "view" and self._transport is not None:
            self._transport.write(GRANT_FRAME)

    def _hold_back(self, nbytes: int) -> None:
        if self.bytes_per_s is None or self._transport is None:
            return
        loop = asyncio.get_running_loop()
        self._owed_s = max(self._owed_s, loop.time()) + nbytes / self.bytes_per_s
        self._transport.pause_reading()
        loop.call_at(self._owed_s, self._read_on)

    def _read_on(self) -> None:
        if self._transport is not None and not self._transport.is_closing():
            self._transport.resume_reading()


async def watch(port: int, viewers: list[Viewer], *, settling_s: float, seconds: float) -> None:
    """Connect all, let them settle, and have them count for so long."""
    loop = asyncio.get_running_loop()
    for viewer in viewers:
        line = socket.socket()
        if viewer.bytes_per_s is not None:
            line.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, THIN_BUFFER_BYTES)
        line.setblocking(False)
        await loop.sock_connect(line, ("127.0.0.1", port))
        await loop.create_connection(partial(_itself, viewer), sock=line)
    await asyncio.sleep(settling_s)
    for viewer in viewers:
        viewer.got.ages_ms.clear()
        viewer.got.scales.clear()
        viewer.got.total_bytes = 0
    await asyncio.sleep(seconds)


def _itself(viewer: Viewer) -> Viewer:
    return viewer


def main() -> None:
    """Watch, and say what came."""
    parser = argparse.ArgumentParser()
    parser.add_argument("--port", type=int, required=True)
    parser.add_argument("--settling", type=float, default=0.0)
    parser.add_argument("--seconds", type=float, required=True)
    for kind in PATHS:
        parser.add_argument(f"--{kind}", type=int, default=0)
    parser.add_argument("--thin", action="store_true")
    given = parser.parse_args()
    # Viewers are other machines; here they share this one, and must not take it from the server.
    with contextlib.suppress(OSError):
        os.nice(NICE)
    viewers = [Viewer(kind) for kind in PATHS for _ in range(getattr(given, kind))]
    if given.thin:
        viewers.append(Viewer("view", bytes_per_s=THIN_BYTES_PER_S))
    asyncio.run(watch(given.port, viewers, settling_s=given.settling, seconds=given.seconds))
    told = [
        {"kind": one.kind, "is_open": one.is_open, "seconds": given.seconds, **asdict(one.got)}
        for one in viewers
    ]
    json.dump(told, sys.stdout)


if __name__ == "__main__":
    main()
