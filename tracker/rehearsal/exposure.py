"""One image while it is made: the still scenery with its noise, and what moves laid over it."""

import cv2
import numpy as np
import numpy.typing as npt

from tracker.rehearsal.lens import Box
from tracker.rehearsal.point_spread import PointSpread
from tracker.rehearsal.sensor import BANK_MARGIN, STILL_SHIFT_PX, Pixels, Sensor, StillNoise

Image8 = npt.NDArray[np.uint8]

BAND_PX = 96
HALF_COVERED = 127


class Exposure:
    """An image that begins as the still scenery.

    The noise of what stands still is the same field again and again, in each band of rows moved and turned
    to its negative as the time has it: that two images are equal has a chance of 128 to the power of their
    bands. What is laid over it, and what is refreshed, has noise that was never there before.

    Attributes:
        image: (h, w, 3), BGR, as the sensor gives it; changes while it is drawn into.
    """

    image: Image8

    def __init__(self, sensor: Sensor, lit: Image8, still_noise: StillNoise, at_s: float) -> None:
        random = sensor.random_at(at_s)
        self._sensor = sensor
        self._lit = lit
        self._flicker = sensor.flicker_at(at_s)
        self._bank_at = (int(random.integers(BANK_MARGIN)), int(random.integers(BANK_MARGIN)))
        if not sensor.is_noisy:
            self.image = lit.copy()
            return
        self.image = np.empty_like(lit)
        height, width = lit.shape[:2]
        tops = range(0, height, BAND_PX)
        shifts = random.integers(0, STILL_SHIFT_PX, (len(tops), 2))
        negatives = random.integers(0, 2, len(tops))
        for top, (down, across), negative in zip(tops, shifts.tolist(), negatives.tolist(), strict=True):
            # A band at a time stays in the processor's cache.
            band = self.image[top : top + BAND_PX]
            at = np.s_[top + down : top + down + len(band), across : across + width]
            noise = (still_noise.above[at], still_noise.below[at])
            cv2.add(lit[top : top + BAND_PX], noise[negative], dst=band)
            cv2.subtract(band, noise[1 - negative], dst=band)

    def refresh(self, box: Box) -> None:
        """Give a part of the still scenery noise that is new in each image."""
        x, y, width, height = box
        if self._sensor.is_noisy:
            lit = self._lit[y : y + height, x : x + width]
            self._add_noise(lit, self.image[y : y + height, x : x + width], lit[..., 1], x, y)

    def dim(self, box: Box, light: Image8) -> None:
        """Leave only this much of the light (h, w) in a part of the image; 255 is all of it."""
        x, y, width, height = box
        part = self.image[y : y + height, x : x + width]
        left = light[: part.shape[0], : part.shape[1]]
        cv2.multiply(part, cv2.merge([left] * 3), dst=part, scale=1.0 / 255.0)

    def lay_over(
        self, box: Box, layer: Image8, spread: PointSpread | None, *, drawn: Box | None = None
    ) -> None:
        """Lay something that moves over a part of the image.

        Args:
            box: the part.
            layer: sharp and premultiplied: (h, w, 4) BGR and coverage, or (h, w, 2) grey and coverage.
            spread: what defocus and motion make of a point in it; None leaves it sharp.
            drawn: what the layer shows, where that is more than the part; whole pixels around it.
        """
        soft = layer if spread is None else spread.of(layer)
        x, y, width, height = box
        part = self.image[y : y + height, x : x + width]
        left, top = (0, 0) if drawn is None else (x - drawn[0], y - drawn[1])
        soft = soft[top : top + part.shape[0], left : left + part.shape[1]]
        gain = self._sensor.gain[y : y + height, x : x + width]
        if soft.shape[2] == 2:
            grey, coverage = cv2.split(soft)
            levels = cv2.multiply(grey, gain, scale=self._flicker, dtype=cv2.CV_8U)
            colour = cv2.merge([levels] * 3)
        else:
            coverage = cv2.extractChannel(soft, 3)
            bgr = cv2.cvtColor(soft, cv2.COLOR_BGRA2BGR)
            colour = cv2.multiply(bgr, cv2.merge([gain] * 3), scale=self._flicker, dtype=cv2.CV_8U)
            levels = cv2.extractChannel(colour, 1)
        behind = cv2.multiply(part, cv2.merge([255 - coverage] * 3), scale=1.0 / 255.0)
        both = cv2.add(behind, colour)
        if self._sensor.is_noisy:
            # What shows through has its noise already.
            _, where = cv2.threshold(coverage, HALF_COVERED, 255, cv2.THRESH_BINARY)
            self._add_noise(both, part, levels, x, y, where)
        else:
            part[:] = both

    def _add_noise(
        self, clean: Pixels, out: Pixels, levels: Pixels, x: int, y: int, where: Pixels | None = None
    ) -> None:
        """Write a part of the image with noise for its grey or green."""
        row, column = self._bank_at
        noise = self._sensor.noise(levels, row + y, column + x, where)
        cv2.add(clean, noise, dst=out, dtype=cv2.CV_8U)
