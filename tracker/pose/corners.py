"""Measure the four corners of the black square in the image."""

from math import dist

from tracker.edges import Gradient
from tracker.geometry import Array
from tracker.marker import ActiveEdges, edge_crossings
from tracker.marker.score_kernels import shift_corners

# Part of each side, next to a corner, whose edgels locate the corner: short enough to be straight on bent
# paper, long enough to average noise.
NEAR_SIDE_RATIO = 0.35
# Beyond this distance from the projected edge, an edgel belongs to something else.
MAX_OFF_PX, MAX_OFF_SIDE_RATIO = 1.5, 0.04


def measured_corners_px(
    gradient: Gradient,
    active: ActiveEdges,
    points_px: Array,
    normals_px: Array,
    *,
    corners_px: Array,
    contrast: float,
) -> Array:
    """Return corners (4, 2), top-left, top-right, bottom-right, bottom-left, measured on the adjacent sides.

    The pose assumes a flat square with unshifted edges, but bent paper and the camera response displace the
    corners in the image. A corner with too few edgels next to it (occluded, or outside the image) is returned
    at its projected position.

    Args:
        gradient: gradient of the image around the marker.
        active: the model's active edges.
        points_px: (n, 2), the active edges projected at the pose.
        normals_px: (n, 2), their unit normals, dark to bright.
        corners_px: (4, 2), the corners projected at the pose.
        contrast: gradient magnitude of an unoccluded edge of this occurrence.
    """
    half = active.half_mm
    c = corners_px.tolist()
    side_px = (dist(c[0], c[1]) + dist(c[1], c[2]) + dist(c[2], c[3])) / 3.0
    reach = MAX_OFF_PX + MAX_OFF_SIDE_RATIO * side_px
    offset, response = edge_crossings(gradient, points_px, normals_px, reach_px=reach)
    usable = active.sides & (response > 0.5 * contrast * active.strength_ratio)
    out = corners_px.copy()
    shift_corners(
        active.points_mm,
        active.normals,
        normals_px,
        usable,
        offset,
        half,
        2.0 * half * NEAR_SIDE_RATIO,
        reach,
        out,
    )
    return out
