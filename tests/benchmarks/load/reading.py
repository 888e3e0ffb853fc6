"""What a viewer reads off its line, as cheaply as it can be: where an image ends, and how old it is then.

Pure: bytes and times go in, images come out. Pictures are counted and thrown away.
"""

import re
from dataclasses import dataclass, field

CAPTURED = re.compile(rb'"captured_at_s":([0-9.e+-]+)')
SCALE = re.compile(rb'"shown_scale_ratio":([0-9.]+)')
BOUNDARY = b"--coaxial\r\n"
# Of each message so much is kept: what is looked for stands in it.
HEAD_BYTES = 4096
SHORT, MEDIUM = 126, 127


@dataclass(slots=True)
class Got:
    """What came.

    Attributes:
        ages_ms: of each image, from its grab to its last byte in the viewer's hands.
        scales: size of each picture by its ratio, None where no picture belongs to it.
        total_bytes: all that was read.
    """

    ages_ms: list[float] = field(default_factory=list)
    scales: list[float | None] = field(default_factory=list)
    total_bytes: int = 0

    def took(self, head: bytes, *, now_s: float) -> None:
        """An image is whole; `head` is the beginning of what came with it."""
        captured = CAPTURED.search(head)
        if captured is None:
            return
        scale = SCALE.search(head)
        self.ages_ms.append((now_s - float(captured[1])) * 1e3)
        self.scales.append(None if scale is None else float(scale[1]))


class Frames:
    """WebSocket messages of a server: unmasked, each in one frame."""

    def __init__(self, got: Got) -> None:
        self._got = got
        self._head = bytearray()
        self._left = 0
        self._kept = bytearray()
        self._is_message = False

    def read(self, data: memoryview, *, now_s: float) -> int:
        """How many messages ended in these bytes."""
        ended = 0
        self._got.total_bytes += len(data)
        while len(data):
            if self._left == 0:
                data = self._read_head(data)
                continue
            part, data = data[: self._left], data[self._left :]
            self._left -= len(part)
            if len(self._kept) < HEAD_BYTES:
                self._kept += part[: HEAD_BYTES - len(self._kept)]
            if self._left == 0 and self._is_message:
                self._got.took(bytes(self._kept), now_s=now_s)
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
                self._kept.clear()
        return data[1:]


class Parts:
    """Pictures of an MJPEG stream: each ends where the next one's boundary comes."""

    def __init__(self, got: Got) -> None:
        self._got = got
        self._tail = b""
        self._kept = bytearray()

    def read(self, data: memoryview, *, now_s: float) -> int:
        """How many pictures ended in these bytes."""
        self._got.total_bytes += len(data)
        rest = self._tail + bytes(data)
        ended = 0
        while (at := rest.find(BOUNDARY)) >= 0:
            self._keep(rest[:at])
            self._got.took(bytes(self._kept), now_s=now_s)
            self._kept.clear()
            rest = rest[at + len(BOUNDARY) :]
            ended += 1
        self._tail = rest[-(len(BOUNDARY) - 1) :]
        self._keep(rest[: len(rest) - len(self._tail)])
        return ended

    def _keep(self, part: bytes) -> None:
        if len(self._kept) < HEAD_BYTES:
            self._kept += part[: HEAD_BYTES - len(self._kept)]
