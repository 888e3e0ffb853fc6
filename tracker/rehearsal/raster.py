"""Vectorised triangle rasterisation with a depth buffer."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.geometry import Array

Image32 = npt.NDArray[np.float32]
BOX_SIDES_PX = (6, 12, 24, 48, 96, 192, 384)
BATCH_SAMPLES = 4_000_000


@dataclass(frozen=True, slots=True, kw_only=True)
class RasterSamples:
    """The nearest triangle of each covered pixel.

    Attributes:
        pixel: (n,) flat index of the pixel.
        face: (n,) index of the triangle.
        weights: (n, 3) of its corners, corrected for perspective.
        depth_mm: (n,) along the optical axis.
    """

    pixel: npt.NDArray[np.int64]
    face: npt.NDArray[np.int64]
    weights: Image32
    depth_mm: Image32

    def of_corners(self, values: npt.NDArray[np.float32], faces: npt.NDArray[np.int64]) -> Image32:
        """Interpolate vertex values (v, c) to the covered pixels (n, c)."""
        corners = faces[self.face]
        out = values[corners[:, 0]] * self.weights[:, :1]
        out += values[corners[:, 1]] * self.weights[:, 1:2]
        out += values[corners[:, 2]] * self.weights[:, 2:]
        return np.asarray(out, dtype=np.float32)


def rasterise(
    px: Array, depth_mm: Array, faces: npt.NDArray[np.int64], *, width: int, height: int
) -> RasterSamples:
    """Rasterise triangles to (height, width) pixels; pixel centres at whole numbers.

    `px` (v, 2) and `depth_mm` (v,) are the projected vertices. Back faces are culled:
    front faces are clockwise in an image whose y points down.
    """
    corner = px[faces].astype(np.float32)
    a, b, c = corner[:, 0], corner[:, 1], corner[:, 2]
    area = (b[:, 0] - a[:, 0]) * (c[:, 1] - a[:, 1]) - (b[:, 1] - a[:, 1]) * (c[:, 0] - a[:, 0])
    low = np.floor(corner.min(axis=1)).astype(np.int64)
    high = np.ceil(corner.max(axis=1)).astype(np.int64)
    seen = (area < -1e-6) & (high >= 0).all(axis=1) & (low < [width, height]).all(axis=1)
    side = (high - low).max(axis=1) + 1
    inverse = (1.0 / depth_mm[faces]).astype(np.float32)
    parts = []
    smallest = 0
    for box in BOX_SIDES_PX:
        chosen = np.flatnonzero(seen & (side > smallest) & (side <= box))
        smallest = box
        batch = max(1, BATCH_SAMPLES // box**2)
        for start in range(0, len(chosen), batch):
            some = chosen[start : start + batch]
            parts.append(_samples(corner[some], inverse[some], low[some], some, box, width, height))
    return _nearest(parts)


_Part = tuple[npt.NDArray[np.int64], npt.NDArray[np.int64], Image32]


def _samples(
    corner: Image32,
    inverse: Image32,
    low: npt.NDArray[np.int64],
    face: npt.NDArray[np.int64],
    box: int,
    width: int,
    height: int,
) -> _Part:
    """Return pixels, faces and perspective-correct corner weights inside these triangles."""
    step = np.arange(box)
    x = low[:, :1, None] + step[None, None, :]
    y = low[:, 1:, None] + step[None, :, None]
    fx, fy = (x - low[:, :1, None]).astype(np.float32), (y - low[:, 1:, None]).astype(np.float32)
    at = corner - low[:, None, :].astype(np.float32)
    edge = []
    for i, j in ((1, 2), (2, 0), (0, 1)):
        ax, ay = at[:, i, 0, None, None], at[:, i, 1, None, None]
        bx, by = at[:, j, 0, None, None], at[:, j, 1, None, None]
        edge.append((by - ay) * (fx - ax) - (bx - ax) * (fy - ay))
    inside = (edge[0] >= 0) & (edge[1] >= 0) & (edge[2] >= 0)
    inside &= (x >= 0) & (x < width) & (y >= 0) & (y < height)
    triangle, row, column = np.nonzero(inside)
    weights = np.stack([e[triangle, row, column] for e in edge], axis=1)
    weights /= np.maximum(weights.sum(axis=1, keepdims=True), 1e-12)
    pixel = (low[triangle, 1] + row) * width + low[triangle, 0] + column
    return pixel, face[triangle], weights * inverse[triangle]


def _nearest(parts: list[_Part]) -> RasterSamples:
    if not parts:
        parts = [(np.zeros(0, np.int64), np.zeros(0, np.int64), np.zeros((0, 3), np.float32))]
    pixel = np.concatenate([part[0] for part in parts])
    face = np.concatenate([part[1] for part in parts])
    over_depth = np.concatenate([part[2] for part in parts])
    nearness = over_depth.sum(axis=1)
    order = np.lexsort((-nearness, pixel))
    pixel_in_order = pixel[order]
    first = np.ones(len(order), dtype=bool)
    first[1:] = pixel_in_order[1:] != pixel_in_order[:-1]
    chosen = order[first]
    near = np.asarray(nearness[chosen], dtype=np.float32)
    return RasterSamples(
        pixel=pixel[chosen],
        face=face[chosen],
        weights=np.asarray(over_depth[chosen] / near[:, None], dtype=np.float32),
        depth_mm=1.0 / near,
    )
