"""The picture of an instant in each size: encoded once for all who watch, and only when somebody does."""

import asyncio
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

import cv2
import numpy as np
import numpy.typing as npt
import structlog

from server.live import Instant
from server.overlay import encode_jpeg
from server.stream.fitting.sizes import Size

# For so long after the last question somebody counts as watching in full size.
ASKED_WITHIN_S = 1.0
# Fine strokes of the burned-in figures suffer first in a small picture, and its bytes are few.
BETTER_WHEN_SMALL = 10
BEST_QUALITY = 95

_log = structlog.get_logger(__name__)


class Pictures:
    """Made in a thread of its own, beside the event loop and away from the tracker. For one event loop."""

    def __init__(self, *, quality: int, clock: Callable[[], float] = time.monotonic) -> None:
        self._quality = quality
        self._clock = clock
        self._asked_full_at_s = -float("inf")
        self._made: dict[Size, tuple[int, asyncio.Future[bytes]]] = {}
        self._thread = ThreadPoolExecutor(1, thread_name_prefix="pictures")
        self.encoded = dict.fromkeys(Size, 0)
        """How many pictures were made here, by size."""

    def encode(self, drawn: npt.NDArray[np.uint8]) -> bytes:
        """The full picture. Any thread."""
        return encode_jpeg(drawn, self._quality)

    def wants_full(self) -> bool:
        """Whether somebody watches in full size; then its picture had better be there already. Any thread."""
        return self._clock() - self._asked_full_at_s <= ASKED_WITHIN_S

    async def of(self, instant: Instant, size: Size) -> bytes:
        """The JPEG of this instant in this size; empty where it has no picture."""
        if size is Size.FULL:
            self._asked_full_at_s = self._clock()
            if instant.jpeg:
                return instant.jpeg
        if instant.drawn is None and not instant.jpeg:
            return b""
        sequence, making = self._made.get(size, (-1, None))
        if making is None or sequence != instant.sequence:
            making = asyncio.get_running_loop().run_in_executor(self._thread, self._make, instant, size)
            if instant.sequence > sequence:
                self._made[size] = (instant.sequence, making)
        # One viewer that goes must not take the picture from the others.
        return await asyncio.shield(making)

    def close(self) -> None:
        """Make no more."""
        self._thread.shutdown(wait=False, cancel_futures=True)

    def _make(self, instant: Instant, size: Size) -> bytes:
        try:
            content = self._encoded(_drawn(instant), size)
        except Exception:  # noqa: BLE001  logged here, and the page says that there is no picture
            _log.exception("a picture could not be encoded", size=size)
            return b""
        self.encoded[size] += 1
        return content

    def _encoded(self, drawn: npt.NDArray[np.uint8], size: Size) -> bytes:
        if size is Size.FULL:
            return self.encode(drawn)
        height, width = drawn.shape[:2]
        wanted = (max(1, round(width * size.scale_ratio)), max(1, round(height * size.scale_ratio)))
        small = cv2.resize(drawn, wanted, interpolation=cv2.INTER_AREA)
        quality = max(self._quality, min(self._quality + BETTER_WHEN_SMALL, BEST_QUALITY))
        return encode_jpeg(np.asarray(small, np.uint8), quality)


def _drawn(instant: Instant) -> npt.NDArray[np.uint8]:
    if instant.drawn is not None:
        return instant.drawn
    decoded = cv2.imdecode(np.frombuffer(instant.jpeg, np.uint8), cv2.IMREAD_COLOR)
    return np.asarray(decoded, np.uint8)
