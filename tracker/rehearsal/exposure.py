"""Composition of one image: static scenery with its noise, and moving layers over it.

Only what moves is drawn for each image, which halves the cost of an image and takes a sixth for a
calibration board. Both markers have fresh noise in each image, because the tracker measures them; the drill
marker's edges are within 0.006 px of the truth.
"""

import cv2
import numpy as np
import numpy.typing as npt

from tracker.rehearsal.lens import Box, Pixels
from tracker.rehearsal.point_spread import PointSpread
from tracker.rehearsal.sensor import BANK_MARGIN, COARSE_GAIN, STILL_SHIFT_PX, Sensor
from tracker.rehearsal.strips import Strips

Image8 = npt.NDArray[np.uint8]
Image16 = npt.NDArray[np.int16]

BAND_PX = 96
HALF_COVERAGE = 127


class Exposure:
    """An image that starts as the static scenery.

    The noise of the static scenery is one field, shifted in each band of rows by a random offset of the
    time: the probability of two equal images is 1/64 to the power of the number of bands. Moving layers and
    refreshed parts have fresh noise.

    Attributes:
        image: (h, w, 3), BGR, as the sensor records it; mutable.
    """

    image: Image8

    def __init__(self, sensor: Sensor, lit: Image8, still_noise: Image8, at_s: float) -> None:
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
        for top, (down, across) in zip(tops, shifts.tolist(), strict=True):
            band = self.image[top : top + BAND_PX]
            noise = still_noise[top + down : top + down + len(band), across : across + width]
            np.add(lit[top : top + BAND_PX], noise, out=band)

    def refresh(self, box: Box) -> None:
        """Apply fresh noise to a part of the static scenery."""
        x, y, width, height = box
        if self._sensor.is_noisy:
            lit = self._lit[y : y + height, x : x + width]
            part = self.image[y : y + height, x : x + width]
            cv2.add(lit, self._noise(lit[..., 1], x, y), dst=part, dtype=cv2.CV_8U)

    def dim(self, box: Box, light: Image8) -> None:
        """Multiply a part of the image by an illumination (h, w); 255 is full."""
        x, y, width, height = box
        part = self.image[y : y + height, x : x + width]
        left = light[: part.shape[0], : part.shape[1]]
        cv2.multiply(part, cv2.merge([left] * 3), dst=part, scale=1.0 / 255.0)

    def lay_over(
        self, strips: Strips, layer: Image8, spread: PointSpread | None, *, margin_px: int = 0
    ) -> None:
        """Blend a moving layer over a part of the image.

        Args:
            strips: the part.
            layer: sharp, premultiplied, stacked: (h, w, 4) BGR and coverage, or (h, w, 2) grey and coverage.
            spread: its point spread function; None leaves it sharp.
            margin_px: margin of the layer around the strips; the kernel radius if there are several strips.
        """
        soft = strips.inner(layer if spread is None else spread.of(layer), margin_px)
        if soft.shape[2] == 2:
            grey, coverage = cv2.split(soft)
            gain = strips.taken_from(self._sensor.gain)
            levels = cv2.multiply(grey, gain, scale=self._flicker, dtype=cv2.CV_8U)
            colour = cv2.merge([levels] * 3)
        else:
            coverage = cv2.extractChannel(soft, 3)
            bgr = cv2.cvtColor(soft, cv2.COLOR_BGRA2BGR)
            coarse = cv2.merge([strips.taken_from(self._sensor.coarse_gain)] * 3)
            colour = cv2.multiply(bgr, coarse, scale=self._flicker / COARSE_GAIN)
            levels = cv2.extractChannel(colour, 1)
        uncovered = cv2.merge([255 - coverage] * 3)
        out = cv2.multiply(strips.taken_from(self.image), uncovered, scale=1.0 / 255.0)
        out = cv2.add(out, colour)
        if self._sensor.is_noisy:
            # The transparent part already has its noise.
            _, where = cv2.threshold(coverage, HALF_COVERAGE, 255, cv2.THRESH_BINARY)
            x, y = strips.places[0]
            out = cv2.add(out, self._noise(levels, max(x, 0), y, where), dtype=cv2.CV_8U)
        strips.put_into(self.image, np.asarray(out, dtype=np.uint8))

    def _noise(self, levels: Pixels, x: int, y: int, where: Pixels | None = None) -> Image16:
        """Return fresh noise for a part of the image, scaled by its grey or green."""
        row, column = self._bank_at
        return self._sensor.noise(levels, row + y, column + x, where)
