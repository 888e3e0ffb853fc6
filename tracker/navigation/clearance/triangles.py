"""Select and subdivide the triangles of a surface around a channel."""

import numpy as np

from tracker.geometry import Array
from tracker.navigation.clearance.voxels import Flags, Grid
from tracker.plan.surface import Surface

MAX_ROUNDS = 12


def triangles_near_grid(surface: Surface, grid: Grid) -> Array:
    """Return corners (m, 3, 3) in mm of the triangles whose bounding box meets that of the grid."""
    corners = surface.vertices_mm[surface.faces]
    return np.asarray(corners[_meets(corners, grid)])


def subdivide_triangles(corners: Array, longest_mm: float, grid: Grid) -> Array:
    """Subdivide triangles until no side is longer than a limit; drop pieces outside of the grid."""
    done = []
    for _ in range(MAX_ROUNDS):
        side = np.linalg.norm(corners - np.roll(corners, -1, axis=1), axis=2).max(axis=1)
        done.append(corners[side <= longest_mm])
        large = corners[side > longest_mm]
        if len(large) == 0:
            break
        a, b, c = large[:, 0], large[:, 1], large[:, 2]
        ab, bc, ca = 0.5 * (a + b), 0.5 * (b + c), 0.5 * (c + a)
        quarters = [(a, ab, ca), (ab, b, bc), (ca, bc, c), (ab, bc, ca)]
        corners = np.concatenate([np.stack(quarter, axis=1) for quarter in quarters])
        corners = corners[_meets(corners, grid)]
    return np.concatenate(done)


def _meets(corners: Array, grid: Grid) -> Flags:
    low = grid.origin_mm - 2.0 * grid.step_mm
    high = grid.origin_mm + (np.array(grid.shape) + 1.0) * grid.step_mm
    return np.asarray(((corners.max(axis=1) >= low) & (corners.min(axis=1) <= high)).all(axis=1))
