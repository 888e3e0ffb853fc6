"""One occurrence of a marker model in the image: its region, the fit to its edges, its score and corners."""

from dataclasses import dataclass, replace
from math import ceil, dist, floor, sqrt

import numpy as np

from tracker.camera import CameraModel
from tracker.camera.projection_kernels import project_square
from tracker.edges import Edgels, Gradient
from tracker.geometry import Array, Camera, Marker, Rigid
from tracker.marker import (
    ActiveEdges,
    Agreement,
    MarkerModel,
    edge_crossings,
    model_agreement,
    target_coverage_ratio,
)
from tracker.marker.score_kernels import shift_corners
from tracker.pose.refinement import EdgeFit, fit_pose_to_edges, projected_edges

# Before the fit, corners may be wrong by a pixel or two, and some edges are then outside the search range.
MIN_FIT_COVERAGE = 0.3
# A candidate that moves by more than half its side during the fit is not the marker.
MAX_DRAG_SIDE_RATIO = 0.5
MARGIN_PX, MARGIN_SIDE_RATIO, MIN_PX = 8.0, 0.15, 24
# Left, top, right, bottom [px]; right and bottom are exclusive.
Window = tuple[int, int, int, int]
# Part of each side, next to a corner, whose edgels locate the corner: short enough to be straight on bent
# paper, long enough to average noise.
NEAR_SIDE_RATIO = 0.35
# Beyond this distance from the projected edge, an edgel belongs to something else.
MAX_OFF_PX, MAX_OFF_SIDE_RATIO = 1.5, 0.04


@dataclass(frozen=True, slots=True, kw_only=True)
class Occurrence:
    """A marker model fitted to the edges of an image.

    Attributes:
        camera: the camera model.
        fit: the fitted pose.
        corners_px: (4, 2), corners of the black square projected at that pose, with lens distortion.
        seen_corners_px: (4, 2), corners measured on the sides next to each corner.
        agreement: agreement of the model's edges with the image.
        active: the fitted active edges of the model.
        points_px: (n, 2), the active edges projected at that pose.
        normals_px: (n, 2), their unit normals.
    """

    camera: CameraModel
    fit: EdgeFit
    corners_px: Array
    seen_corners_px: Array
    agreement: Agreement
    active: ActiveEdges
    points_px: Array
    normals_px: Array


def corners_px_at(camera: CameraModel, model: MarkerModel, pose: Rigid[Camera, Marker]) -> Array:
    """Return the corners (4, 2) of the black square projected at a pose, with lens distortion."""
    seen = project_square(pose.rotation, pose.translation_mm, camera.lens, model.side_mm)
    return np.asarray(seen, dtype=np.float64)


def side_px_of(corners_px: Array) -> float:
    """Return the square root of the area of the quadrilateral (4, 2), in px."""
    (ax, ay), (bx, by), (cx, cy), (dx, dy) = corners_px.tolist()
    return sqrt(0.5 * abs((cx - ax) * (dy - by) - (cy - ay) * (dx - bx)))


def occurrence_near(
    camera: CameraModel,
    model: MarkerModel,
    gradient: Gradient,
    start: Rigid[Camera, Marker],
    *,
    first_reach_px: float,
    expected: Rigid[Camera, Marker] | None = None,
) -> Occurrence | None:
    """Return the model fitted to the edges around a pose; None when too few of its edges are found."""
    corners = corners_px_at(camera, model, start)
    side = side_px_of(corners)
    active = model.level_for(side)
    projected = projected_edges(camera, start, active)
    if projected is None:
        return None
    first = model_agreement(gradient, active, *projected, side_px=max(side, first_reach_px * 30.0))
    if first.model_coverage_ratio < MIN_FIT_COVERAGE:
        return None
    fit = fit_pose_to_edges(
        camera,
        gradient,
        active,
        start,
        contrast=first.contrast,
        side_px=side,
        first_reach_px=first_reach_px,
        expected=expected,
    )
    if fit is None:
        return None
    fitted = corners_px_at(camera, model, fit.camera_from_marker)
    if float(np.abs(fitted - corners).max()) > max(MAX_DRAG_SIDE_RATIO * side, 2.0 * first_reach_px):
        return None
    projected = projected_edges(camera, fit.camera_from_marker, active)
    if projected is None:
        return None
    agreement = model_agreement(
        gradient, active, *projected, side_px=side_px_of(fitted), shift_px=fit.shift_px
    )
    return Occurrence(
        camera=camera,
        fit=fit,
        corners_px=fitted,
        seen_corners_px=measured_corners_px(
            gradient,
            active,
            *projected,
            corners_px=fitted,
            contrast=agreement.contrast,
        ),
        agreement=agreement,
        active=active,
        points_px=projected[0],
        normals_px=projected[1],
    )


def with_target_coverage(
    camera: CameraModel, model: MarkerModel, gradient: Gradient, edgels: Edgels, found: Occurrence
) -> Occurrence:
    """Return the occurrence with its target coverage: the share of the image's edges that the model has."""
    side = side_px_of(found.corners_px)
    active = model.level_for(side)
    projected: tuple[Array, Array] | None = (found.points_px, found.normals_px)
    if active is not found.active:
        projected = projected_edges(camera, found.fit.camera_from_marker, active)
    if projected is None:
        return found
    ratio = target_coverage_ratio(
        edgels,
        gradient,
        *projected,
        corners_px=found.corners_px,
        side_px=side,
        contrast=found.agreement.contrast,
    )
    return replace(found, agreement=replace(found.agreement, target_coverage_ratio=ratio))


def window_around(corners_px: Array, *, reach_px: float, size_wh_px: tuple[int, int]) -> Window | None:
    """Return left, top, right, bottom (px) of the region that can contain a marker expected at these corners.

    Returns None where too little of it lies inside the image.
    """
    margin = reach_px + MARGIN_PX + MARGIN_SIDE_RATIO * side_px_of(corners_px)
    width, height = size_wh_px
    across, down = corners_px.T.tolist()
    left, top = max(floor(min(across) - margin), 0), max(floor(min(down) - margin), 0)
    right, bottom = min(ceil(max(across) + margin), width), min(ceil(max(down) + margin), height)
    if right - left < MIN_PX or bottom - top < MIN_PX:
        return None
    return left, top, right, bottom


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
