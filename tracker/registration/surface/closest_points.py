"""Closest points on the surface of the bone, with a k-d tree built once."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import scipy

from tracker.geometry import Array
from tracker.plan import Surface

# Triangles are subdivided to pieces of this length, so that few candidates contain the nearest point.
MAX_EDGE_MM = 3.0
MAX_PIECES = 400_000
CANDIDATES, MORE = 20, 8
# Radius of the smoothed normals: narrower bumps of a mesh must not constrain the fit.
SMOOTH_MM = 3.0


@dataclass(frozen=True, slots=True, kw_only=True)
class ClosestPoints:
    """For each of n points: closest point (n, 3), its outward unit normal (n, 3), the triangle (n,)."""

    points_mm: Array
    normals: Array
    triangles: npt.NDArray[np.int64]


class ClosestPointQuery:
    """Find exact closest points on a surface. Immutable; built once per surface."""

    def __init__(self, surface: Surface) -> None:
        corners = surface.vertices_mm[surface.faces]
        across = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        areas = np.linalg.norm(across, axis=1)
        whole = areas > 1e-9
        self._corners = corners[whole]
        self._normals = across[whole] / areas[whole, None]
        pieces, owners = _pieces(self._corners)
        self._owners = owners
        middles = pieces.mean(axis=1)
        self._tree = scipy.spatial.KDTree(middles)
        self._reach_mm = float(np.linalg.norm(pieces - middles[:, None], axis=2).max())
        sides = np.cross(pieces[:, 1] - pieces[:, 0], pieces[:, 2] - pieces[:, 0])
        self._piece_areas = 0.5 * np.linalg.norm(sides, axis=1)

    def at(self, points_mm: Array) -> ClosestPoints:
        """Return the closest point of each of n points (n, 3)."""
        found = np.empty_like(points_mm)
        owner = np.zeros(len(points_mm), dtype=np.int64)
        open_rows = np.arange(len(points_mm))
        count = CANDIDATES
        while len(open_rows):
            count = min(count, len(self._owners))
            distances, pieces = self._tree.query(points_mm[open_rows], k=count)
            distances, pieces = distances.reshape(-1, count), pieces.reshape(-1, count)
            triangles, queries = self._owners[pieces], points_mm[open_rows]
            near = closest_points_on_triangles(queries[:, None], self._corners[triangles])
            off = np.linalg.norm(near - queries[:, None], axis=2)
            best, rows = np.argmin(off, axis=1), np.arange(len(queries))
            found[open_rows], owner[open_rows] = near[rows, best], triangles[rows, best]
            # Lower bound for an unvisited piece: distance of its centre minus its radius.
            unsure = distances[:, -1] - self._reach_mm < off[rows, best]
            open_rows = open_rows[unsure] if count < len(self._owners) else open_rows[:0]
            count *= MORE
        return ClosestPoints(points_mm=found, normals=self._normals[owner], triangles=owner)

    def smooth_normals(self, points_mm: Array) -> Array:
        """Return the mean outward normal (n, 3) within a few mm of points (n, 3) on the surface.

        Shorter than 1 on a curved surface.
        """
        found = np.empty_like(points_mm)
        for row, pieces in enumerate(self._tree.query_ball_point(points_mm, SMOOTH_MM)):
            chosen = pieces or [int(self._tree.query(points_mm[row])[1])]
            weights = self._piece_areas[chosen]
            found[row] = weights @ self._normals[self._owners[chosen]] / weights.sum()
        return found


def closest_points_on_triangles(points: Array, corners: Array) -> Array:
    """Return the closest point (..., 3) on triangles (..., 3, 3) to points (..., 3) (Ericson 2005, 5.1.5)."""
    a, b, c = corners[..., 0, :], corners[..., 1, :], corners[..., 2, :]
    ab, ac = b - a, c - a
    d1, d2 = _dot(ab, points - a), _dot(ac, points - a)
    d3, d4 = _dot(ab, points - b), _dot(ac, points - b)
    d5, d6 = _dot(ab, points - c), _dot(ac, points - c)
    va, vb, vc = d3 * d6 - d5 * d4, d5 * d2 - d1 * d6, d1 * d4 - d3 * d2
    with np.errstate(divide="ignore", invalid="ignore"):
        inside_v, inside_w = vb / (va + vb + vc), vc / (va + vb + vc)
        on_ab, on_ac = d1 / (d1 - d3), d2 / (d2 - d6)
        on_bc = (d4 - d3) / ((d4 - d3) + (d5 - d6))
    zero, one = np.zeros_like(d1), np.ones_like(d1)
    cases = [
        (d1 <= 0) & (d2 <= 0),
        (d3 >= 0) & (d4 <= d3),
        (d6 >= 0) & (d5 <= d6),
        (vc <= 0) & (d1 >= 0) & (d3 <= 0),
        (vb <= 0) & (d2 >= 0) & (d6 <= 0),
        (va <= 0) & (d4 >= d3) & (d5 >= d6),
    ]
    v = np.select(cases, [zero, one, zero, on_ab, zero, one - on_bc], inside_v)
    w = np.select(cases, [zero, zero, one, zero, on_ac, on_bc], inside_w)
    return np.asarray(a + v[..., None] * ab + w[..., None] * ac)


def _dot(a: Array, b: Array) -> Array:
    return np.asarray((a * b).sum(axis=-1))


def _pieces(corners: Array) -> tuple[Array, npt.NDArray[np.int64]]:
    """Subdivide triangles until no edge is long; return the pieces and the index of their triangle."""
    pieces, owners = corners, np.arange(len(corners))
    while len(pieces) < MAX_PIECES:
        edges = np.linalg.norm(pieces - np.roll(pieces, -1, axis=1), axis=2)
        long = edges.max(axis=1) > MAX_EDGE_MM
        if not long.any():
            break
        a, b, c = pieces[long, 0], pieces[long, 1], pieces[long, 2]
        ab, bc, ca = (a + b) / 2, (b + c) / 2, (c + a) / 2
        four = [np.stack(three, axis=1) for three in ((a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca))]
        pieces = np.concatenate([pieces[~long], *four])
        owners = np.concatenate([owners[~long], *[owners[long]] * 4])
    return pieces, owners
