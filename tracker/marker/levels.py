"""An image at falling sizes: outlines are looked for, and at, where they are some tens of pixels wide."""

from dataclasses import dataclass
from functools import cached_property

import cv2
import numpy as np

from tracker.edges import GreyImage
from tracker.outlines import Quads
from tracker.regions import even_image, noise_grey

# An image over a megapixel is first looked at at half its size.
MAX_PIXELS_AT_ONCE = 1_000_000
MIN_LEVEL_PX = 12
WINDOW_PX = 21
# An outline is looked at closely at the level where it is no wider than this: a cell is a pixel or two.
CLOSER_SIDE_PX = 32.0


@dataclass(frozen=True, kw_only=True)
class Level:
    """The image at a half, a quarter of its size, or as it is.

    Attributes:
        image: (h, w).
        scale: how many pixels of the whole image one of its pixels is wide.
        noise_grey: sd of its noise.
    """

    image: GreyImage
    scale: int
    noise_grey: float

    @cached_property
    def soft(self) -> GreyImage:
        """The image in even light and a little soft: for a peek."""
        even = even_image(self.image, window_px=WINDOW_PX, noise_grey=self.noise_grey)
        return np.asarray(cv2.blur(even, (3, 3)), dtype=np.uint8)

    def full_px(self, quads: Quads) -> Quads:
        """Points of this level in px of the whole image."""
        return np.asarray(quads * np.float32(self.scale) + np.float32(0.5 * (self.scale - 1)), np.float32)

    def own_px(self, quads: Quads) -> Quads:
        """Points of the whole image in px of this level."""
        return np.asarray((quads - np.float32(0.5 * (self.scale - 1))) / np.float32(self.scale), np.float32)


class Levels:
    """The image at falling sizes, each made when it is asked for."""

    def __init__(self, first: Level) -> None:
        self._made = [first]

    def __getitem__(self, k: int) -> Level:
        while len(self._made) <= k:
            self._made.append(halved(self._made[-1]))
        return self._made[k]

    def for_side(self, side_px: float) -> int:
        """At which level a side of so many px of the whole image is looked at closely."""
        k, least = 0, 2 * MIN_LEVEL_PX
        while side_px > CLOSER_SIDE_PX * self[k].scale and min(self[k].image.shape) >= least:
            k += 1
        return k


def first_level(image: GreyImage) -> Level:
    """The image at the size at which it is looked at first."""
    level = Level(image=image, scale=1, noise_grey=0.0)
    if image.size > MAX_PIXELS_AT_ONCE:
        return halved(level)
    return Level(image=image, scale=1, noise_grey=noise_grey(image))


def halved(level: Level) -> Level:
    """The same at half the size: a pixel is the mean of four."""
    height, width = level.image.shape
    even = level.image[: height // 2 * 2, : width // 2 * 2]
    half = np.asarray(cv2.resize(even, None, fx=0.5, fy=0.5, interpolation=cv2.INTER_AREA), dtype=np.uint8)
    return Level(image=half, scale=2 * level.scale, noise_grey=noise_grey(half))


def softened(level: Level) -> Level:
    """The same with each pixel the mean of nine: a third of the noise."""
    soft = np.asarray(cv2.blur(level.image, (3, 3)), dtype=np.uint8)
    return Level(image=soft, scale=level.scale, noise_grey=noise_grey(soft))
