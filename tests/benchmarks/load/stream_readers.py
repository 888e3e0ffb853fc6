"""Low-cost stream readers of a viewer: end of each image, and its age.

Pure: bytes and times go in, images come out. Pictures are counted and thrown away.
"""

import re
from dataclasses import dataclass, field

CAPTURED = re.compile(rb'"captured_at_s":([0-9.e+-]+)')
SCALE = re.compile(rb'"shown_scale_ratio":([0-9.]+)')
BOUNDARY = b"--coaxial\r\n"
# Stored prefix of each message; it contains the fields that are parsed.
HEAD_BYTES = 4096
SHORT, MEDIUM = 126, 127


@dataclass(slots=True)
class ReceivedImages:
    """Images that a viewer received.

    Attributes:
        ages_ms: of each image, from its grab to its last byte in the viewer's hands.
        scales: size of each picture by its ratio, None where no picture belongs to it.
        total_bytes: all that was read.
    """

    ages_ms: list[float] = field(default_factory=list)
    scales: list[float | None] = field(default_factory=list)
    total_bytes: int = 0

    def add_image(self, head: bytes, *, now_s: float) -> None:
        """Count a complete image; `head` is the beginning of its message."""
        captured = CAPTURED.search(head)
        if captured is None:
            return
        scale = SCALE.search(head)
        self.ages_ms.append((now_s - float(captured[1])) * 1e3)
        self.scales.append(None if scale is None else float(scale[1]))


class Frames:
    """Reader of WebSocket messages of a server: unmasked, each in one frame."""

    def __init__(self, received: ReceivedImages) -> None:
        self._received = received
        self._head = bytearray()
        self._left = 0
        self._stored = bytearray()
        self._is_message = False

    def read(self, data: memoryview, *, now_s: float) -> int:
        """Return how many messages ended in these bytes."""
        ended = 0
        self._received.total_bytes += len(data)
        while len(data):
            if self._left == 0:
                data = self._read_head(data)
                continue
            part, data = data[: self._left], data[self._left :]
            self._left -= len(part)
            if len(self._stored) < HEAD_BYTES:
                self._stored += part[: HEAD_BYTES - len(self._stored)]
            if self._left == 0 and self._is_message:
                self._received.add_image(bytes(self._stored), now_s=now_s)
                ended += 1
        return ended

    def _read_head(self, data: memoryview) -> memoryview:
        self._head += data[:1]
        if len(self._head) >= 2:
            short = self._head[1] & 0x7F
            wanted = 2 + {SHORT: 2, MEDIUM: 8}.get(short, 0)
            if len(self._head) == wanted:
                self._left = short if wanted == 2 else int.from_bytes(self._head[2:], "big")
                self._is_message = self._head[0] & 0x0F in (1, 2)
                self._head.clear()
                self._stored.clear()
        return data[1:]


class Parts:
    """Reader of an MJPEG stream: a part ends at the next boundary."""

    def __init__(self, received: ReceivedImages) -> None:
        self._received = received
        self._tail = b""
        self._stored = bytearray()

    def read(self, data: memoryview, *, now_s: float) -> int:
        """Return how many pictures ended in these bytes."""
        self._received.total_bytes += len(data)
        rest = self._tail + bytes(data)
        ended = 0
        while (at := rest.find(BOUNDARY)) >= 0:
            self._keep(rest[:at])
            self._received.add_image(bytes(self._stored), now_s=now_s)
            self._stored.clear()
            rest = rest[at + len(BOUNDARY) :]
            ended += 1
        self._tail = rest[-(len(BOUNDARY) - 1) :]
        self._keep(rest[: len(rest) - len(self._tail)])
        return ended

    def _keep(self, part: bytes) -> None:
        if len(self._stored) < HEAD_BYTES:
            self._stored += part[: HEAD_BYTES - len(self._stored)]
