"""Pictures of an instant by size: encoded once for all viewers, and only on demand.

The finished picture is scaled, so that figures and image belong to one instant; small print is unreadable at
a quarter of the width, the main figures stay readable.
"""

import asyncio
import time
from collections.abc import Callable
from concurrent.futures import ThreadPoolExecutor

import cv2
import numpy as np
import numpy.typing as npt
import structlog

from server.live import Instant
from server.overlay import draw_overlay, encode_jpeg
from server.stream.scaling.sizes import PictureSize
from server.texts import Language
from tracker.navigation import NavigationSnapshot
from tracker.navigation.alarms import AlarmSnapshot

# A viewer counts as present for this long after the last request.
REQUESTED_WITHIN_S = 1.0
# A higher JPEG quality for small pictures: fine strokes of the overlay suffer first, and the bytes are few.
BETTER_WHEN_SMALL = 10
BEST_QUALITY = 95

_log = structlog.get_logger(__name__)


class PictureCache:
    """Encodes in its own thread, beside the event loop and away from the tracker. For one event loop."""

    def __init__(
        self, *, quality: int, language: Language = "en", clock: Callable[[], float] = time.monotonic
    ) -> None:
        self._quality = quality
        self._language: Language = language
        self._clock = clock
        self._requested_at_s = -float("inf")
        self._full_requested_at_s = -float("inf")
        self._made: dict[PictureSize, tuple[int, asyncio.Future[bytes]]] = {}
        self._thread = ThreadPoolExecutor(1, thread_name_prefix="pictures")
        self.encoded = dict.fromkeys(PictureSize, 0)
        """How many pictures were made here, by size."""

    def encode(self, drawn: npt.NDArray[np.uint8]) -> bytes:
        """Return the JPEG of the full picture. Any thread."""
        return encode_jpeg(drawn, self._quality)

    def draw(
        self, image: npt.NDArray[np.uint8], snapshot: NavigationSnapshot, alarms: AlarmSnapshot
    ) -> npt.NDArray[np.uint8]:
        """Return a new image with the overlay. Any thread."""
        return draw_overlay(image, snapshot, alarms, language=self._language)

    def is_watched(self) -> bool:
        """Return whether there is a viewer; then the overlay is drawn with each image. Any thread."""
        return self._clock() - self._requested_at_s <= REQUESTED_WITHIN_S

    def is_watched_in_full(self) -> bool:
        """Return whether there is a viewer of the full size, made with each image. Any thread."""
        return self._clock() - self._full_requested_at_s <= REQUESTED_WITHIN_S

    async def of(self, instant: Instant, size: PictureSize) -> bytes:
        """Return the JPEG of an instant in this size; empty without a picture."""
        self._requested_at_s = self._clock()
        if size is PictureSize.FULL:
            self._full_requested_at_s = self._requested_at_s
            if instant.jpeg:
                return instant.jpeg
        if not instant.has_picture:
            return b""
        sequence, making = self._made.get(size, (-1, None))
        if making is None or sequence != instant.sequence:
            making = asyncio.get_running_loop().run_in_executor(self._thread, self._make, instant, size)
            if instant.sequence > sequence:
                self._made[size] = (instant.sequence, making)
        # A disconnecting viewer must not cancel the picture of the others.
        return await asyncio.shield(making)

    def close(self) -> None:
        """Stop encoding."""
        self._thread.shutdown(wait=False, cancel_futures=True)

    def _make(self, instant: Instant, size: PictureSize) -> bytes:
        try:
            content = self._encoded(self._drawn(instant), size)
        except Exception:  # noqa: BLE001  logged here, and the page says that there is no picture
            _log.exception("a picture could not be drawn or encoded", size=size)
            return b""
        self.encoded[size] += 1
        return content

    def _encoded(self, drawn: npt.NDArray[np.uint8], size: PictureSize) -> bytes:
        if size is PictureSize.FULL:
            return self.encode(drawn)
        height, width = drawn.shape[:2]
        wanted = (max(1, round(width * size.scale_ratio)), max(1, round(height * size.scale_ratio)))
        small = cv2.resize(drawn, wanted, interpolation=cv2.INTER_AREA)
        quality = max(self._quality, min(self._quality + BETTER_WHEN_SMALL, BEST_QUALITY))
        return encode_jpeg(np.asarray(small, np.uint8), quality)

    def _drawn(self, instant: Instant) -> npt.NDArray[np.uint8]:
        if instant.drawn is not None:
            return instant.drawn
        if not instant.jpeg and instant.image is not None and instant.snapshot is not None:
            return self.draw(instant.image, instant.snapshot, instant.alarms)
        return _decoded(instant.jpeg)


def _decoded(jpeg: bytes) -> npt.NDArray[np.uint8]:
    decoded = cv2.imdecode(np.frombuffer(jpeg, np.uint8), cv2.IMREAD_COLOR)
    return np.asarray(decoded, np.uint8)
