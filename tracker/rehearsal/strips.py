"""Stacked rectangular strips along an oblique object, processed as one picture."""

from dataclasses import dataclass
from typing import TypeVar

import cv2
import numpy as np
import numpy.typing as npt

from tracker.geometry import Array
from tracker.rehearsal.lens import MARGIN_NODES, NODE_PX, Box, RayGrid

Image32 = npt.NDArray[np.float32]
Value = TypeVar("Value", np.uint8, np.float32)

STRIP_PX = 48


@dataclass(frozen=True, slots=True, kw_only=True)
class Strips:
    """Rectangles of equal size, stacked vertically.

    Attributes:
        places: x and y of each; multiples of 4.
        width: of each, a multiple of 4.
        height: of each, a multiple of 4.
    """

    places: tuple[tuple[int, int], ...]
    width: int
    height: int

    @classmethod
    def of_box(cls, box: Box) -> "Strips":
        """Return a single rectangle."""
        x, y, width, height = box
        return cls(places=((x, y),), width=width, height=height)

    def grown(self, px: int) -> "Strips":
        """Return the strips with a margin on each side."""
        return Strips(
            places=tuple((x - px, y - px) for x, y in self.places),
            width=self.width + 2 * px,
            height=self.height + 2 * px,
        )

    def inner(self, stacked: npt.NDArray[Value], px: int) -> npt.NDArray[Value]:
        """Crop the margin of stacked, grown strips."""
        if px == 0:
            return stacked
        whole = stacked.reshape(len(self.places), self.height + 2 * px, self.width + 2 * px, -1)
        return whole[:, px:-px, px:-px].reshape(-1, self.width, whole.shape[3])

    def taken_from(self, image: npt.NDArray[Value], beyond: float = 0.0) -> npt.NDArray[Value]:
        """Gather the image (h, w) or (h, w, channels) in the strips; `beyond` outside its borders."""
        if len(self.places) == 1:
            x, y = self.places[0]
            if 0 <= x <= image.shape[1] - self.width and 0 <= y <= image.shape[0] - self.height:
                return image[y : y + self.height, x : x + self.width]
        shape = (len(self.places), self.height, self.width, *image.shape[2:])
        out = np.full(shape, beyond, dtype=image.dtype)
        for (x, y), one in zip(self.places, out, strict=True):
            part = image[max(y, 0) : y + self.height, max(x, 0) : x + self.width]
            top, left = max(-y, 0), max(-x, 0)
            one[top : top + part.shape[0], left : left + part.shape[1]] = part
        return out.reshape(-1, *shape[2:])

    def put_into(self, image: npt.NDArray[Value], stacked: npt.NDArray[Value]) -> None:
        """Scatter the stacked strips into an image, clipped to it."""
        for number, (x, y) in enumerate(self.places):
            part = image[y : y + self.height, x : x + self.width]
            first = number * self.height
            part[:] = stacked[first : first + part.shape[0], : part.shape[1]]

    def nodes(self, rays: RayGrid) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64]]:
        """Return rows (n, r, 1) and columns (n, 1, c) of the nodes of each strip, with a margin of one.

        Beyond the grid of rays there are those at its border once more.
        """
        first = np.array(self.places)[:, ::-1] // NODE_PX + (MARGIN_NODES - 1)
        row = first[:, :1] + np.arange(self.height // NODE_PX + 2)
        column = first[:, 1:] + np.arange(self.width // NODE_PX + 2)
        last_row, last_column = rays.squares.shape[0] - 1, rays.squares.shape[1] - 1
        return np.clip(row, 0, last_row)[:, :, None], np.clip(column, 0, last_column)[:, None, :]

    def from_nodes(self, nodes: Image32) -> Image32:
        """Interpolate node values (n, r, c, channels) to the pixels, stacked."""
        count, rows, columns, channels = nodes.shape
        size = (columns * NODE_PX, count * rows * NODE_PX)
        wide = cv2.resize(nodes.reshape(-1, columns, channels), size, interpolation=cv2.INTER_LINEAR)
        apart = wide.reshape(count, rows * NODE_PX, columns * NODE_PX, channels)
        inside = apart[:, NODE_PX:-NODE_PX, NODE_PX:-NODE_PX]
        return np.asarray(inside.reshape(-1, self.width, channels), dtype=np.float32)


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
    start = np.floor(left / NODE_PX).astype(int) * NODE_PX
    wide = int(np.ceil((right - start).max() / NODE_PX)) * NODE_PX
    return Strips(places=tuple(zip(start.tolist(), tops.tolist(), strict=True)), width=wide, height=STRIP_PX)
