"""One claimed occurrence of a marker: fitted, scored, and accepted or not."""

from dataclasses import dataclass, replace
from math import sqrt

import numpy as np

from tracker.camera import CameraModel
from tracker.edges import Edgels, Gradient, GreyImage
from tracker.geometry import Array, Camera, Marker, Rigid
from tracker.marker import (
    ActiveEdges,
    Agreement,
    MarkerModel,
    ScoreSettings,
    contradiction_of,
    explanation_of,
    model_agreement,
    target_coverage_ratio,
)
from tracker.pose.corners import measured_corners_px
from tracker.pose.refinement import Fit, projected_edges, refined_pose
from tracker.pose.sighting import FoundBy, Seen, Sighting, Unseen, UnseenReason

# Before the fit, corners may be off by a pixel or two and edges therefore out of reach.
WORTH_FITTING_COVERAGE = 0.3
# The fit must end where it began: a candidate that has to be dragged over half its side is another thing.
MOST_DRAG_SIDE_RATIO = 0.5


@dataclass(frozen=True, slots=True, kw_only=True)
class Occurrence:
    """A marker laid on the edges of an image.

    Attributes:
        fit: the pose.
        corners_px: (4, 2), of the black square at that pose, through the lens.
        seen_corners_px: (4, 2), as the sides next to each show them.
        agreement: how well the edges agree.
        active: the model's edges that were laid on the image.
        points_px: (n, 2), where they are at that pose; `normals_px` (n, 2) their unit normals.
    """

    fit: Fit
    corners_px: Array
    seen_corners_px: Array
    agreement: Agreement
    active: ActiveEdges
    points_px: Array
    normals_px: Array


def side_px_of(corners_px: Array) -> float:
    """Root of the area inside four corners (4, 2), in px."""
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
    """The model fitted to the edges around a pose; None when too few of its edges are near."""
    corners = camera.px_from_camera(start.move_points(model.corners_mm))
    side = side_px_of(corners)
    active = model.level_for(side)
    projected = projected_edges(camera, start, active)
    if projected is None:
        return None
    first = model_agreement(gradient, active, *projected, side_px=max(side, first_reach_px * 30.0))
    if first.model_coverage_ratio < WORTH_FITTING_COVERAGE:
        return None
    fit = refined_pose(
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
    fitted = camera.px_from_camera(fit.camera_from_marker.move_points(model.corners_mm))
    if float(np.abs(fitted - corners).max()) > max(MOST_DRAG_SIDE_RATIO * side, 2.0 * first_reach_px):
        return None
    projected = projected_edges(camera, fit.camera_from_marker, active)
    if projected is None:
        return None
    agreement = model_agreement(
        gradient, active, *projected, side_px=side_px_of(fitted), shift_px=fit.shift_px
    )
    return Occurrence(
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


def with_target(
    camera: CameraModel, model: MarkerModel, gradient: Gradient, edgels: Edgels, found: Occurrence
) -> Occurrence:
    """The same with its target coverage, which asks which edges are there that the model has not."""
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


def _explained_corners_px(
    image: GreyImage, model: MarkerModel, found: Occurrence, window: Array
) -> Array | None:
    """Corners (4, 2) where blur, uneven light or a cover make of the model what is seen; None if they do not.

    `window` is the left top pixel (2,) of the image.
    """
    explanation = explanation_of(
        image, model.square, found.corners_px - window, side_px=side_px_of(found.corners_px)
    )
    if explanation is None or not explanation.explains:
        return None
    return explanation.corners_px + window


def judged(
    found: Occurrence | None,
    settings: ScoreSettings,
    *,
    model: MarkerModel,
    image: GreyImage,
    gradient: Gradient,
    found_by: FoundBy,
) -> Sighting:
    """Seen if both scores are accepted and nothing inside contradicts, else the reason why not.

    `image` is the window (h, w) that the gradient was taken of.
    """
    if found is None:
        return Unseen(reason=UnseenReason.NO_CANDIDATE)
    agreement = found.agreement
    score, target = agreement.score_ratio(settings), agreement.target_score_ratio(settings)
    if (
        score < settings.accept_score_ratio
        or agreement.inner_coverage_ratio < settings.accept_inner_coverage_ratio
    ):
        return Unseen(reason=UnseenReason.SCORE_TOO_LOW, best_score_ratio=score)
    if target < settings.accept_target_score_ratio:
        return Unseen(reason=UnseenReason.TARGET_SCORE_TOO_LOW, best_score_ratio=score)
    # Bent paper lies beside its flat pose. Another shape contradicts wherever its corners are taken to be.
    window = np.array([gradient.left_px, gradient.top_px], dtype=np.float64)
    plain = not all(
        contradiction_of(image, model.square, corners - window, side_px=side_px_of(corners)).is_other_shape
        for corners in (found.corners_px, found.seen_corners_px)
    )
    corners = found.seen_corners_px if plain else _explained_corners_px(image, model, found, window)
    if corners is None:
        return Unseen(reason=UnseenReason.SHAPE_DIFFERS, best_score_ratio=score)
    return Seen(
        camera_from_marker=found.fit.camera_from_marker,
        pose_covariance=found.fit.covariance,
        corners_px=corners,
        score_ratio=score,
        target_score_ratio=target,
        model_coverage_ratio=agreement.model_coverage_ratio,
        target_coverage_ratio=agreement.target_coverage_ratio,
        fit_error_px2=agreement.fit_error_px2,
        found_by=found_by,
        lead_sd2=found.fit.lead_sd2,
    )
