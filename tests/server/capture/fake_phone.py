"""Synthetic phone messages, and an in-process inbox."""

from dataclasses import replace

import cv2
import numpy as np

from server.capture.phone import Focus, PhoneCamera, PhoneImage, PhoneUpdate
from server.live import ImageClock

CAMERA = PhoneCamera(
    label="back",
    size_wh_px=(160, 90),
    rate_hz=30.0,
    focus=Focus.LOCKED,
    focus_mm=400,
    zoom_percent=100,
)


def jpeg_of(grey: int, size_wh_px: tuple[int, int] = (160, 90)) -> bytes:
    """A picture with this brightness."""
    width, height = size_wh_px
    return cv2.imencode(".jpg", np.full((height, width, 3), grey, np.uint8))[1].tobytes()


def image(number: int, captured_at_s: float = 1.0, **changes: object) -> PhoneImage:
    """An image with its number as brightness."""
    made = PhoneImage(
        jpeg=jpeg_of(number % 256),
        number=number,
        captured_at_s=captured_at_s,
        clock=ImageClock.BROWSER,
        camera=CAMERA,
    )
    return replace(made, **changes)  # pyrefly: ignore[bad-argument-type]  # any of its fields


class Script:
    """An inbox that returns the given entries and then ends the wait.

    Attributes:
        entries: that arrive later; None is a timeout.
        now_s: advances by the duration of each timeout.

    """

    def __init__(self, before: PhoneUpdate | None, entries: list[PhoneUpdate | None]) -> None:
        self.before = before
        self.entries = entries
        self.now_s = 0.0
        self._sequence = 0 if before is None else 1
        self._last = before

    def clock(self) -> float:
        return self.now_s

    def newest(self) -> tuple[int, PhoneUpdate] | None:
        return None if self.before is None else (self._sequence, self.before)

    def next_after(self, sequence: int, timeout_s: float) -> tuple[int, PhoneUpdate] | None:
        if sequence < self._sequence and self._last is not None:
            return self._sequence, self._last
        entry = self.entries.pop(0) if self.entries else None
        if entry is None:
            self.now_s += timeout_s
            return None
        self._sequence += 1
        self._last = entry
        return self._sequence, entry
