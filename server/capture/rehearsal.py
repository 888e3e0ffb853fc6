"""The rehearsal theatre as a source: rendered when due, so that its hand moves in real time."""

import threading
import time
from typing import Protocol

import numpy as np
import numpy.typing as npt

from server.capture.shot import Shot
from server.errors import CaptureError


class Renderer(Protocol):
    """Draws the theatre at a time of its own clock."""

    def image_at(self, at_s: float) -> npt.NDArray[np.uint8]:
        """The image (h, w, 3), BGR."""


class RehearsalSource:
    """Images of a theatre in software.

    Image `number` always shows the theatre at `number / rate_hz` seconds of its own clock, so that the truth
    of an image follows from its number. A machine too slow for the rate leaves numbers out (they count as
    skipped); the hand keeps its speed.
    """

    def __init__(
        self,
        renderer: Renderer,
        *,
        rate_hz: float,
        stop: threading.Event,
        fast: bool = False,
        first_number: int = 0,
        last_number: int | None = None,
    ) -> None:
        self.name = "rehearsal"
        self.waits_for_taker = fast
        self.stalls = False
        self.defect: CaptureError | None = None
        self._renderer = renderer
        self._rate_hz = rate_hz
        self._stop = stop
        self._fast = fast
        self._number = first_number
        self._last_number = last_number
        self._epoch_s = 0.0

    def open(self) -> None:
        """The next image is due now."""
        self._epoch_s = time.monotonic() - self._number / self._rate_hz

    def read(self) -> Shot | None:
        """The next image when it is due."""
        if self._last_number is not None and self._number > self._last_number:
            return None
        if not self._fast:
            self._number = max(self._number, int((time.monotonic() - self._epoch_s) * self._rate_hz))
            self._stop.wait(max(0.0, self._epoch_s + self._number / self._rate_hz - time.monotonic()))
        # The grab is the instant that is shown, not the end of its rendering.
        captured_at_s = time.monotonic()
        at_s = self._number / self._rate_hz
        shot = Shot(
            image=self._renderer.image_at(at_s),
            number=self._number,
            captured_at_s=captured_at_s,
            source_time_s=at_s,
        )
        self._number += 1
        return shot

    def close(self) -> None:
        """Nothing is held open."""
