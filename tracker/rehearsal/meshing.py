"""Isosurface of a sampled implicit function by surface nets, vectorised over all cells."""

import numpy as np
import numpy.typing as npt

from tracker.geometry import Array

CORNERS = np.array([[i >> 2 & 1, i >> 1 & 1, i & 1] for i in range(8)])
EDGES = np.array(
    [(a, b) for a in range(8) for b in range(a + 1, 8) if np.abs(CORNERS[a] - CORNERS[b]).sum() == 1]
)


def surface_net(
    values: npt.NDArray[np.float32], *, origin_mm: tuple[float, float, float], step_mm: float
) -> tuple[Array, npt.NDArray[np.int64]]:
    """Return vertices (n, 3) and faces (m, 3), outward winding, of the zero level of `values` (i, j, k).

    Each cell that the surface crosses gives one vertex, the mean of the crossings on its edges; each grid
    edge that it crosses gives two triangles between its four cells. Closed if no outermost value is negative.
    """
    inside = values < 0.0
    cells = tuple(n - 1 for n in values.shape)
    count = np.zeros(cells, dtype=np.int8)
    for i, j, k in CORNERS:
        count += inside[i : i + cells[0], j : j + cells[1], k : k + cells[2]]
    crossed = np.argwhere((count > 0) & (count < 8))
    number = np.full(cells, -1, dtype=np.int64)
    number[tuple(crossed.T)] = np.arange(len(crossed))
    vertices = (crossed + _mean_crossings(values, crossed)) * step_mm + np.asarray(origin_mm)
    quads = np.concatenate([_quads(inside, number, axis) for axis in range(3)])
    return vertices, _triangles(vertices, quads)


def _mean_crossings(values: npt.NDArray[np.float32], crossed: npt.NDArray[np.int64]) -> Array:
    """Return the mean edge crossing of each cell, in cells from its first corner (n, 3)."""
    at = crossed[:, None, :] + CORNERS
    v = values[at[..., 0], at[..., 1], at[..., 2]].astype(np.float64)
    a, b = v[:, EDGES[:, 0]], v[:, EDGES[:, 1]]
    crossing = (a < 0.0) != (b < 0.0)
    ratio = np.where(crossing, a / np.where(crossing, a - b, 1.0), 0.0)[..., None]
    points = CORNERS[EDGES[:, 0]] * (1.0 - ratio) + CORNERS[EDGES[:, 1]] * ratio
    return np.asarray((points * crossing[..., None]).sum(1) / crossing.sum(1)[:, None], dtype=np.float64)


def _quads(inside: npt.NDArray[np.bool_], number: npt.NDArray[np.int64], axis: int) -> npt.NDArray[np.int64]:
    """Return the four cells (n, 4) around each crossed edge along `axis`, counter-clockwise from outside."""
    first = np.moveaxis(inside, axis, 0)
    cells = np.moveaxis(number, axis, 0)
    lower, upper = first[:-1, 1:-1, 1:-1], first[1:, 1:-1, 1:-1]
    i, j, k = np.nonzero(lower != upper)
    j, k = j + 1, k + 1
    quads = np.stack([cells[i, j - 1, k - 1], cells[i, j, k - 1], cells[i, j, k], cells[i, j - 1, k]], axis=1)
    # moveaxis keeps the order of the other two axes, which mirrors the middle one.
    outward = lower[i, j - 1, k - 1] != (axis == 1)
    quads[~outward] = quads[~outward, ::-1]
    return quads


def _triangles(vertices: Array, quads: npt.NDArray[np.int64]) -> npt.NDArray[np.int64]:
    """Split each quad along its shorter diagonal."""
    corner = vertices[quads]
    shorter = np.linalg.norm(corner[:, 0] - corner[:, 2], axis=1) <= np.linalg.norm(
        corner[:, 1] - corner[:, 3], axis=1
    )
    turned = np.where(shorter[:, None], quads, np.roll(quads, -1, axis=1))
    return np.concatenate([turned[:, [0, 1, 2]], turned[:, [0, 2, 3]]])
