"""Where the four corners of the black square are in the image."""

from math import dist

from tracker.edges import Gradient
from tracker.geometry import Array
from tracker.marker import ActiveEdges, edge_crossings
from tracker.marker.kernels import shift_corners

# The part of each side, next to a corner, whose edgels say where that corner is: near enough that bent paper
# is straight there, long enough to average over.
NEAR_SIDE_RATIO = 0.35
# Farther than this from where the pose has it, something else than the marker's own edge was met.
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
