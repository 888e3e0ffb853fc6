"""Where the four corners of the black square are in the image."""

import numpy as np

from tracker.edges import Gradient
from tracker.geometry import Array
from tracker.marker import ActiveEdges, edge_crossings

# The part of each side, next to a corner, whose edgels say where that corner is: near enough that bent paper
# is straight there, long enough to average over.
NEAR_SIDE_RATIO = 0.35
LEAST_EDGELS = 4
# Farther than this from where the pose has it, something else than the marker's own edge was met.
MOST_OFF_PX, MOST_OFF_SIDE_RATIO = 1.5, 0.04


def measured_corners_px(
    gradient: Gradient,
    active: ActiveEdges,
    points_px: Array,
    normals_px: Array,
    *,
    corners_px: Array,
    contrast: float,
) -> Array:
    """Corners (4, 2), top-left, top-right, bottom-right, bottom-left, as the sides next to each show them.

    A pose is that of a flat square with true edges; paper bends, and a camera's response shifts edges: what
    is seen lies beside it. Where too few edgels are seen next to a corner (it is covered, or not in the
    image) it stays where the pose has it.

    Args:
        gradient: of the image around the marker.
        active: the model's active edges.
        points_px: (n, 2), the active edges at the pose.
        normals_px: (n, 2), their unit normals, dark to bright.
        corners_px: (4, 2), at the pose.
        contrast: gradient of a free edge of this occurrence.
    """
    half = float(np.abs(active.points_mm).max())
    side_px = float(np.linalg.norm(np.diff(corners_px, axis=0), axis=1).mean())
    reach = MOST_OFF_PX + MOST_OFF_SIDE_RATIO * side_px
    offset, response = edge_crossings(gradient, points_px, normals_px, reach_px=reach)
    seen = ~active.inner & active.straight & (response > 0.5 * contrast * active.strength_ratio)
    plane = np.array([[-1.0, 1.0], [1.0, 1.0], [1.0, -1.0], [-1.0, -1.0]]) * half
    across = np.abs(active.normals)
    out = corners_px.copy()
    for k, (x_mm, y_mm) in enumerate(plane):
        along = 2.0 * half * NEAR_SIDE_RATIO
        near_upright = seen & (np.abs(active.points_mm[:, 0] - x_mm) < 0.2 * half) & (across[:, 0] > 0.9)
        near_level = seen & (np.abs(active.points_mm[:, 1] - y_mm) < 0.2 * half) & (across[:, 1] > 0.9)
        near_upright &= np.abs(active.points_mm[:, 1] - y_mm) < along
        near_level &= np.abs(active.points_mm[:, 0] - x_mm) < along
        moved = _moved(
            [
                _side(offset, normals_px, near_upright, active.points_mm[:, 1] - y_mm),
                _side(offset, normals_px, near_level, active.points_mm[:, 0] - x_mm),
            ]
        )
        if moved is not None and float(np.linalg.norm(moved)) <= reach:
            out[k] += moved
    return out


def _side(
    offset: Array, normals_px: Array, chosen: np.ndarray, along_mm: Array
) -> tuple[float, Array] | None:
    """How far a side is off at its corner, and its normal (2,) there; None when too little of it is seen."""
    if int(chosen.sum()) < LEAST_EDGELS:
        return None
    o, t = offset[chosen], along_mm[chosen]
    middle = float(np.median(o))
    kept = np.abs(o - middle) <= 3.0 * max(float(np.median(np.abs(o - middle))), 0.05)
    if int(kept.sum()) < LEAST_EDGELS:
        return None
    o, t = o[kept], t[kept]
    basis = np.stack([np.ones_like(t), t], axis=1)
    off = float(np.linalg.lstsq(basis, o, rcond=None)[0][0])
    normal = normals_px[chosen].mean(axis=0)
    return off, normal / float(np.linalg.norm(normal))


def _moved(sides: list[tuple[float, Array] | None]) -> Array | None:
    """The displacement (2,) of a corner that puts it on both of its sides."""
    upright, level = sides
    if upright is None or level is None:
        return None
    normals = np.stack([upright[1], level[1]])
    if abs(float(np.linalg.det(normals))) < 0.2:
        return None
    return np.asarray(np.linalg.solve(normals, np.array([upright[0], level[0]])))
