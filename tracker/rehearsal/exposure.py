"""Composition of one image: static scenery with its noise, and moving layers over it.

Only moving objects are drawn for each image, which halves the time per image, and takes a sixth of it for a
calibration board. Both markers have independent noise in each image, because the tracker measures them; the
drill marker's edges are within 0.006 px of the ground truth.
"""

import cv2
import numpy as np
import numpy.typing as npt

from tracker.rehearsal.layer_kernels import composite
from tracker.rehearsal.lens import Box
from tracker.rehearsal.point_spread import PointSpread
from tracker.rehearsal.sensor import BANK_MARGIN, STILL_SHIFT_PX, Sensor
from tracker.rehearsal.strips import Strips

Image8 = npt.NDArray[np.uint8]

BAND_PX = 96


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
            row, column = self._bank_at
            noise = self._sensor.noise(lit[..., 1], row + y, column + x)
            cv2.add(lit, noise, dst=part, dtype=cv2.CV_8U)

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
        soft = layer if spread is None else spread.of(layer)
        light = (self._sensor.gain, self._flicker)
        noise = self._sensor.noise_table(*self._bank_at)
        composite(self.image, strips.places, soft, margin_px, light, noise)
