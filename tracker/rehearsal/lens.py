"""Rays through the image on a coarse grid, with the lens taken out once and for all."""

import math
from collections.abc import Sequence
from typing import TypeVar

import cv2
import numpy as np
import numpy.typing as npt

from tracker.camera import CameraModel
from tracker.geometry import Array

Image32 = npt.NDArray[np.float32]
Value = TypeVar("Value", np.uint8, np.float32)

# Between nodes 4 px apart a straight line is off by under 0.003 px for the lenses and planes rendered here.
NODE_PX = 4
MARGIN_NODES = 4
STRIP_PX = 128


Box = tuple[int, int, int, int]  # x, y, width, height in px, all multiples of 4


def nodes_of(box: Box, margin: int = MARGIN_NODES - 1) -> tuple[slice, slice]:
    """Rows and columns of a rectangle's nodes with one more all around, after a margin of the nodes."""
    x, y, width, height = box
    row, column = y // NODE_PX + margin, x // NODE_PX + margin
    return slice(row, row + height // NODE_PX + 2), slice(column, column + width // NODE_PX + 2)


class RayGrid:
    """Where each pixel looks: nodes in the middle of blocks of 4x4 px, some of them beyond the image.

    Attributes:
        nodes: (rows, columns, 3) float32, rays (x/z, y/z, 1) of the nodes; the block of the node at row and
            column `MARGIN_NODES` starts at the top-left pixel of the image.
        squares: (rows, columns) float32, squares of their lengths.
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
        self.squares: Image32 = (self.nodes**2).sum(axis=2)

    def block(self, x: int, y: int, width: int, height: int) -> Image32:
        """The nodes (height/4 + 2, width/4 + 2, 3) of a rectangle of pixels, and one more all around.

        All four numbers are multiples of 4, and the rectangle lies within the image rounded up to blocks.
        """
        return self.nodes[nodes_of((x, y, width, height))]

    def box_around(self, px: Array, margin_px: int) -> Box | None:
        """The rectangle of whole blocks around points (n, 2) inside the image, None if there is none."""
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

    def grown(self, box: Box, px: int) -> Box:
        """The rectangle with this much more on each side, rounded up to whole blocks, inside the image."""
        x, y, width, height = box
        more = -(-px // NODE_PX) * NODE_PX
        left, top = max(x - more, 0), max(y - more, 0)
        right = min(x + width + more, self.columns * NODE_PX)
        return left, top, right - left, min(y + height + more, self.rows * NODE_PX) - top

    def strips_around(self, px: Array, margin_px: int) -> list[Box]:
        """Rectangles that do not overlap, along something long and thin that may lie askew.

        Args:
            px: (2, n, 2) of its two sides.
            margin_px: around it.
        """
        points = px.reshape(-1, 2)
        whole = self.box_around(points, margin_px)
        if whole is None:
            return []
        way = 1 if whole[3] > whole[2] else 0
        margin = margin_px + float(np.abs(np.diff(px[..., way], axis=1)).max(initial=0.0))
        out = []
        for start in range(whole[way], whole[way] + whole[way + 2], STRIP_PX):
            end = min(start + STRIP_PX, whole[way] + whole[way + 2])
            beside = (points[:, way] > start - margin) & (points[:, way] < end + margin)
            box = self.box_around(points[beside], margin_px)
            if box is None:
                continue
            low, high = max(start, box[way]), min(end, box[way] + box[way + 2])
            if low < high:
                out.append((box[0], low, box[2], high - low) if way else (low, box[1], high - low, box[3]))
        return out


def box_around_all(boxes: Sequence[Box]) -> Box:
    """The rectangle around one or more."""
    x, y = min(box[0] for box in boxes), min(box[1] for box in boxes)
    right, bottom = max(box[0] + box[2] for box in boxes), max(box[1] + box[3] for box in boxes)
    return x, y, right - x, bottom - y


def resized(image: Image32, width: int, height: int) -> Image32:
    """The image at another size: averaged when it shrinks, linear when it grows."""
    way = cv2.INTER_AREA if width < image.shape[1] else cv2.INTER_LINEAR
    return np.asarray(cv2.resize(image, (width, height), interpolation=way), dtype=np.float32)


def spread(nodes: Image32, samples: int) -> Image32:
    """Values on the nodes of a block with its margin, as values on a grid of `samples` to a pixel's side."""
    finer = NODE_PX * samples
    rows, columns = nodes.shape[0] * finer, nodes.shape[1] * finer
    wide = cv2.resize(np.ascontiguousarray(nodes), (columns, rows), interpolation=cv2.INTER_LINEAR)
    return np.asarray(wide[finer:-finer, finer:-finer], dtype=np.float32)


def looked_up(image: npt.NDArray[Value], at: Image32, beyond: float = 0.0) -> npt.NDArray[Value]:
    """The image's values, linear between its pixels, at columns and rows (h, w, 2); another one beyond it."""
    out = cv2.remap(image, at, None, cv2.INTER_LINEAR, borderValue=beyond)  # type: ignore[call-overload]  # its stub lacks None, and an empty map gives nonsense
    return np.asarray(out, dtype=image.dtype)
