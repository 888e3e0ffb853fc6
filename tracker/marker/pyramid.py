"""Image pyramid: quads are searched and refined where they are some tens of pixels wide."""

from dataclasses import dataclass
from functools import cached_property

import cv2
import numpy as np

from tracker.edges import GreyImage
from tracker.quads import Quads
from tracker.regions import noise_grey, normalise_illumination

# Larger images are searched at half size first.
MAX_PIXELS_AT_ONCE = 1_000_000
MIN_LEVEL_PX = 12
WINDOW_PX = 21
# A quad is refined at the level where it is no wider than this: a cell is a pixel or two.
REFINEMENT_SIDE_PX = 32.0


@dataclass(frozen=True, kw_only=True)
class PyramidLevel:
    """One level of the pyramid.

    Attributes:
        image: (h, w).
        scale: width of its pixel in pixels of the full image.
        noise_grey: sd of its noise.
    """

    image: GreyImage
    scale: int
    noise_grey: float

    @cached_property
    def soft(self) -> GreyImage:
        """The illumination-normalised and smoothed image for the coarse match."""
        even = normalise_illumination(self.image, window_px=WINDOW_PX, noise_grey=self.noise_grey)
        return np.asarray(cv2.blur(even, (3, 3)), dtype=np.uint8)

    def image_from_level(self, quads: Quads) -> Quads:
        """Convert points of this level to px of the full image."""
        return np.asarray(quads * np.float32(self.scale) + np.float32(0.5 * (self.scale - 1)), np.float32)

    def level_from_image(self, quads: Quads) -> Quads:
        """Convert points of the full image to px of this level."""
        return np.asarray((quads - np.float32(0.5 * (self.scale - 1))) / np.float32(self.scale), np.float32)


class ImagePyramid:
    """Pyramid levels, computed on demand."""

    def __init__(self, first: PyramidLevel) -> None:
        self._made = [first]

    def __getitem__(self, k: int) -> PyramidLevel:
        while len(self._made) <= k:
            self._made.append(halved(self._made[-1]))
        return self._made[k]

    def for_side(self, side_px: float) -> int:
        """Return the level at which a side of this size in px of the full image is refined."""
        k, minimum = 0, 2 * MIN_LEVEL_PX
        while side_px > REFINEMENT_SIDE_PX * self[k].scale and min(self[k].image.shape) >= minimum:
            k += 1
        return k


def first_level(image: GreyImage) -> PyramidLevel:
    """Return the level at which the search starts."""
    level = PyramidLevel(image=image, scale=1, noise_grey=0.0)
    if image.size > MAX_PIXELS_AT_ONCE:
        return halved(level)
    return PyramidLevel(image=image, scale=1, noise_grey=noise_grey(image))


def halved(level: PyramidLevel) -> PyramidLevel:
    """Return the next level: each pixel is the mean of four."""
    height, width = level.image.shape
    even = level.image[: height // 2 * 2, : width // 2 * 2]
    half = np.asarray(cv2.resize(even, None, fx=0.5, fy=0.5, interpolation=cv2.INTER_AREA), dtype=np.uint8)
    return PyramidLevel(image=half, scale=2 * level.scale, noise_grey=noise_grey(half))


def softened(level: PyramidLevel) -> PyramidLevel:
    """Return the level smoothed by a 3 x 3 mean: a third of the noise."""
    soft = np.asarray(cv2.blur(level.image, (3, 3)), dtype=np.uint8)
    return PyramidLevel(image=soft, scale=level.scale, noise_grey=noise_grey(soft))
