"""Stacked rectangular strips along an oblique object, processed as one picture."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.geometry import Array
from tracker.rehearsal.lens import NODE_PX, Box, RayGrid

STRIP_PX = 48


@dataclass(frozen=True, slots=True, kw_only=True)
class Strips:
    """Rectangles of equal size, stacked vertically.

    Attributes:
        places: (n, 2) int64, x and y of each; multiples of 4.
        width: of each, a multiple of 4.
        height: of each, a multiple of 4.
    """

    places: npt.NDArray[np.int64]
    width: int
    height: int

    @classmethod
    def of_box(cls, box: Box) -> "Strips":
        """Return a single rectangle."""
        x, y, width, height = box
        return cls(places=np.array([[x, y]]), width=width, height=height)

    def grown(self, px: int) -> "Strips":
        """Return the strips with a margin on each side."""
        return Strips(places=self.places - px, width=self.width + 2 * px, height=self.height + 2 * px)

    def blank(self) -> npt.NDArray[np.uint8]:
        """Return a layer (n * h, w, 4) that shows nothing."""
        return np.zeros((len(self.places) * self.height, self.width, 4), dtype=np.uint8)


def strips_around(px: Array, margin_px: int, rays: RayGrid) -> Strips | None:
    """Return strips that cover an elongated object; None if it is outside the image.

    The last one may reach beyond the lower border of the image. Something that lies level gets wide strips.

    Args:
        px: (2, n, 2) of its two sides.
        margin_px: around it.
        rays: of the camera.
    """
    box = rays.box_around(px.reshape(-1, 2), margin_px)
    if box is None:
        return None
    x, y, width, height = box
    tops = np.arange(y, y + height, STRIP_PX)
    left, right = np.full(len(tops), float(x)), np.full(len(tops), float(x + width))
    steps = np.diff(px[..., 1], axis=1)
    if (steps > 0.0).all() or (steps < 0.0).all():
        # Where both sides are at the upper and lower end of each strip.
        ends = np.stack([tops - margin_px, tops + (STRIP_PX + margin_px)])
        ordered = px if steps[0, 0] > 0.0 else px[:, ::-1]
        at = np.stack([np.interp(ends, side[:, 1], side[:, 0]) for side in ordered])
        left, right = at.min(axis=(0, 1)) - margin_px, at.max(axis=(0, 1)) + margin_px
    start = np.floor(left / NODE_PX).astype(np.int64) * NODE_PX
    wide = int(np.ceil((right - start).max() / NODE_PX)) * NODE_PX
    return Strips(places=np.stack([start, tops], axis=1), width=wide, height=STRIP_PX)
