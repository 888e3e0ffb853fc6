"""Pictures of an instant by size: drawn and encoded once for all viewers, and only on demand.

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

from server.live import Instant, Problem
from server.overlay import OverlayContent, draw_overlay, encode_jpeg
from server.priority import lower_thread_priority
from server.stream.scaling.sizes import PictureSize
from server.texts import Language

# A higher JPEG quality for small pictures: fine strokes of the overlay suffer first, and the bytes are few.
BETTER_WHEN_SMALL = 10
BEST_QUALITY = 95

_log = structlog.get_logger(__name__)


class PictureCache:
    """Draws and encodes in its own thread, at lower priority than the figures. For one event loop."""

    def __init__(self, *, quality: int, language: Language = "en") -> None:
        self._quality = quality
        self._language: Language = language
        self._made: dict[tuple[PictureSize, OverlayContent], tuple[int, asyncio.Future[bytes]]] = {}
        self._thread = ThreadPoolExecutor(1, thread_name_prefix="pictures", initializer=lower_thread_priority)
        self.encoded = dict.fromkeys(PictureSize, 0)
        """Number of encoded pictures by size."""
        self.problem: Problem | None = None
        """Why the last picture failed; None if it did not. Any thread may read it."""
        self.observe_stage: Callable[[str, float], None] = lambda _stage, _spent_s: None
        """Called with the seconds of each stage, "overlay" and "encode", from the thread of the pictures."""
        self._drawn: dict[OverlayContent, tuple[int, npt.NDArray[np.uint8]]] = {}

    async def of(
        self, instant: Instant, size: PictureSize, content: OverlayContent = OverlayContent.FULL
    ) -> bytes:
        """Return the JPEG of an instant in this size; empty without a picture."""
        if size is PictureSize.FULL and instant.jpeg:
            return instant.jpeg
        if not instant.has_picture:
            return b""
        sequence, making = self._made.get((size, content), (-1, None))
        if making is None or sequence != instant.sequence:
            making = asyncio.get_running_loop().run_in_executor(
                self._thread, self._make, instant, size, content
            )
            if instant.sequence > sequence:
                self._made[size, content] = (instant.sequence, making)
        # A disconnecting viewer must not cancel the picture of the others.
        return await asyncio.shield(making)

    def close(self) -> None:
        """Stop encoding."""
        self._thread.shutdown(wait=False, cancel_futures=True)

    def _make(self, instant: Instant, size: PictureSize, content: OverlayContent) -> bytes:
        try:
            drawn = self._drawn_of(instant, content)
            started_s = time.monotonic()
            jpeg = self._encoded(drawn, size)
            self.observe_stage("encode", time.monotonic() - started_s)
        except Exception as error:  # noqa: BLE001  logged here, and reported on the page
            self._report(error, size)
            return b""
        self.problem = None
        self.encoded[size] += 1
        return jpeg

    def _drawn_of(self, instant: Instant, content: OverlayContent) -> npt.NDArray[np.uint8]:
        """Return the image with its overlay, which is drawn once for all sizes."""
        sequence, drawn = self._drawn.get(content, (-1, None))
        if drawn is not None and sequence == instant.sequence:
            return drawn
        if instant.image is not None and instant.snapshot is not None:
            started_s = time.monotonic()
            drawn = draw_overlay(
                instant.image, instant.snapshot, instant.alarms, language=self._language, content=content
            )
            self.observe_stage("overlay", time.monotonic() - started_s)
        else:
            drawn = _decoded(instant.jpeg)
        self._drawn[content] = instant.sequence, drawn
        return drawn

    def _encoded(self, drawn: npt.NDArray[np.uint8], size: PictureSize) -> bytes:
        if size is PictureSize.FULL:
            return encode_jpeg(drawn, self._quality)
        height, width = drawn.shape[:2]
        wanted = (max(1, round(width * size.scale_ratio)), max(1, round(height * size.scale_ratio)))
        small = cv2.resize(drawn, wanted, interpolation=cv2.INTER_AREA)
        quality = max(self._quality, min(self._quality + BETTER_WHEN_SMALL, BEST_QUALITY))
        return encode_jpeg(np.asarray(small, np.uint8), quality)

    def _report(self, error: Exception, size: PictureSize) -> None:
        """Log a failure once, and keep it for the page."""
        reason = f"{type(error).__name__}: {error}"
        problem = Problem(
            code="OVERLAY_FAILED",
            message=f"the overlay cannot be drawn: {reason}",
            remedy="Restart the program; if the error persists, send the server log to the maintainer.",
            context={"library_error": reason},
        )
        if problem != self.problem:
            _log.error("a picture could not be drawn or encoded", size=size, exc_info=error)
        self.problem = problem


def _decoded(jpeg: bytes) -> npt.NDArray[np.uint8]:
    decoded = cv2.imdecode(np.frombuffer(jpeg, np.uint8), cv2.IMREAD_COLOR)
    return np.asarray(decoded, np.uint8)
