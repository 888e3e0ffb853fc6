"""One occurrence of a marker model in the image: fitted to its edges and scored."""

from dataclasses import dataclass, replace
from math import sqrt

import numpy as np

from tracker.camera import CameraModel
from tracker.camera.projection_kernels import project_square
from tracker.edges import Edgels, Gradient
from tracker.geometry import Array, Camera, Marker, Rigid
from tracker.marker import (
    ActiveEdges,
    Agreement,
    MarkerModel,
    model_agreement,
    target_coverage_ratio,
)
from tracker.pose.corners import measured_corners_px
from tracker.pose.refinement import EdgeFit, fit_pose_to_edges, projected_edges

# Before the fit, corners may be wrong by a pixel or two, and some edges are then outside the search range.
MIN_FIT_COVERAGE = 0.3
# A candidate that moves by more than half its side during the fit is not the marker.
MAX_DRAG_SIDE_RATIO = 0.5


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
