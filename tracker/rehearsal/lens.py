"""Undistorted rays on a coarse pixel grid."""

import math
from typing import Any, TypeVar

import cv2
import numpy as np
import numpy.typing as npt

from tracker.camera import CameraModel
from tracker.geometry import Array

Image32 = npt.NDArray[np.float32]
# Return types of OpenCV's functions.
Pixels = npt.NDArray[np.integer[Any] | np.floating[Any]]
Value = TypeVar("Value", np.uint8, np.float32)

# Linear interpolation between nodes 4 px apart has errors under 0.003 px for the lenses and planes rendered
# here.
NODE_PX = 4
MARGIN_NODES = 4


Box = tuple[int, int, int, int]  # x, y, width, height in px, all multiples of 4


class RayGrid:
    """Viewing rays at nodes in the centres of blocks of 4x4 px, with a margin beyond the image.

    Attributes:
        nodes: (rows, columns, 3) float32, rays (x/z, y/z, 1) of the nodes; the block of the node at row and
            column `MARGIN_NODES` starts at the top-left pixel of the image.
    """

    def __init__(self, camera: CameraModel) -> None:
        width, height = camera.size_wh_px
        self.columns = -(-width // NODE_PX)
        self.rows = -(-height // NODE_PX)
        first = (NODE_PX - 1) / 2.0
        u = first + NODE_PX * np.arange(-MARGIN_NODES, self.columns + MARGIN_NODES)
        v = first + NODE_PX * np.arange(-MARGIN_NODES, self.rows + MARGIN_NODES)
        uu, vv = np.meshgrid(u, v)
        rays = camera.normalised_from_px(np.stack([uu.ravel(), vv.ravel()], axis=1)).reshape(*uu.shape, 2)
        self.nodes: Image32 = np.dstack([rays, np.ones(uu.shape)]).astype(np.float32)

    def block(self, x: int, y: int, width: int, height: int) -> Image32:
        """Return the nodes (height/4 + 2, width/4 + 2, 3) of a pixel rectangle with a margin of one node.

        All four numbers are multiples of 4, and the rectangle lies within the image rounded up to blocks.
        """
        row, column = y // NODE_PX + MARGIN_NODES - 1, x // NODE_PX + MARGIN_NODES - 1
        return self.nodes[row : row + height // NODE_PX + 2, column : column + width // NODE_PX + 2]

    def box_around(self, px: Array, margin_px: int) -> Box | None:
        """Return the bounding rectangle of whole blocks around points (n, 2), None if outside the image."""
        if len(px) == 0:
            return None
        (left, top), (right, bottom) = px.min(axis=0).tolist(), px.max(axis=0).tolist()
        first_column = max(math.floor((left - margin_px) / NODE_PX), 0)
        first_row = max(math.floor((top - margin_px) / NODE_PX), 0)
        columns = min(math.ceil((right + margin_px) / NODE_PX), self.columns) - first_column
        rows = min(math.ceil((bottom + margin_px) / NODE_PX), self.rows) - first_row
        if columns <= 0 or rows <= 0:
            return None
        return first_column * NODE_PX, first_row * NODE_PX, columns * NODE_PX, rows * NODE_PX


def resized(image: Image32, width: int, height: int) -> Image32:
    """Return the image at another size: area average to shrink, linear to enlarge."""
    way = cv2.INTER_AREA if width < image.shape[1] else cv2.INTER_LINEAR
    return np.asarray(cv2.resize(image, (width, height), interpolation=way), dtype=np.float32)


def spread(nodes: Image32, samples: int) -> Image32:
    """Interpolate the node values of a block with its margin to `samples` values per pixel side."""
    finer = NODE_PX * samples
    rows, columns = nodes.shape[0] * finer, nodes.shape[1] * finer
    wide = cv2.resize(np.ascontiguousarray(nodes), (columns, rows), interpolation=cv2.INTER_LINEAR)
    return np.asarray(wide[finer:-finer, finer:-finer], dtype=np.float32)


def looked_up(
    image: npt.NDArray[Value], column: Pixels, row: Pixels, beyond: float = 0.0
) -> npt.NDArray[Value]:
    """Sample the image linearly at these positions (h, w); `beyond` is returned outside it."""
    out = cv2.remap(image, column, row, cv2.INTER_LINEAR, borderValue=beyond)
    return np.asarray(out, dtype=image.dtype)
