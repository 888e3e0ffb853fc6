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
from tracker.pose.planar import other_solution, pose_from_corners
from tracker.pose.refinement import Fit, projected_edges, refined_pose
from tracker.pose.sighting import FoundBy, Seen, Sighting, Unseen, UnseenReason

# Before the fit, corners may be off by a pixel or two and edges therefore out of reach.
WORTH_FITTING_COVERAGE = 0.3
# The fit must end where it began: a candidate that has to be dragged over half its side is another thing.
MOST_DRAG_SIDE_RATIO = 0.5
# In empty scenes other squares reach 0.86 in plain light, at any size above 18 px.
PLAIN_LIKENESS = 0.9
# Blur, glare and covers leave fewer edges than are asked for. With this part of that, pixels may still speak;
# not where nothing looks like the model before it is fitted.
WEAK_RATIO, WORTH_EXPLAINING = 0.6, 0.45
# Farther than this the pose by edges is not within reach of the fit to all pixels.
EDGES_OFF_PX = 0.6


@dataclass(frozen=True, slots=True, kw_only=True)
class Occurrence:
    """A marker laid on the edges of an image.

    Attributes:
        camera: that saw it.
        fit: the pose.
        corners_px: (4, 2), of the black square at that pose, through the lens.
        seen_corners_px: (4, 2), as the sides next to each show them.
        agreement: how well the edges agree.
        active: the model's edges that were laid on the image.
        points_px: (n, 2), where they are at that pose; `normals_px` (n, 2) their unit normals.
    """

    camera: CameraModel
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


def _corners_px_by_pixels(
    image: GreyImage, model: MarkerModel, found: Occurrence, window: Array, *, by_edges: bool
) -> Array | None:
    """Corners (4, 2) where the pixels are the model's; None where they are another shape's, or tell nothing.

    Plain light needs no explanation, nor do shapes that blur and bent paper make a little less alike, if they
    can be explained nearly. Where the edges are too weak (not `by_edges`), all must be explained. `window` is
    the left top pixel (2,) of the image.
    """
    side = side_px_of(found.corners_px)
    # Bent paper lies beside its flat pose. Another shape contradicts wherever its corners are taken to be.
    alike, most = -1.0, -1.0
    for corners in (found.corners_px, found.seen_corners_px):
        look = contradiction_of(image, model.square, corners - window, side_px=side_px_of(corners))
        most = max(most, look.likeness)
        if not look.is_other_shape:
            alike = max(alike, look.likeness)
        if by_edges and alike >= PLAIN_LIKENESS:
            return found.seen_corners_px
    if not by_edges and most < WORTH_EXPLAINING:
        return None
    explanation = explanation_of(image, model.square, found.corners_px - window, side_px=side)
    if explanation is None or explanation.is_turned:
        return None
    if explanation.explains:
        return explanation.corners_px + window
    return found.seen_corners_px if by_edges and alike > 0.0 and explanation.is_near else None


def _pose_at(found: Occurrence, model: MarkerModel, corners_px: Array) -> tuple[Rigid[Camera, Marker], Array]:
    """The pose by edges with its covariance (6, 6); where pixels say that they were off, that of the corners.

    The corners as edges show them are no such word: those of bent paper are off its flat pose.
    """
    fit = found.fit
    moved = float(np.abs(corners_px - found.corners_px).max())
    pose = None
    if corners_px is not found.seen_corners_px and moved > EDGES_OFF_PX:
        pose = pose_from_corners(found.camera, corners_px, side_mm=model.side_mm)
    if pose is None:
        return fit.camera_from_marker, fit.covariance
    before = fit.camera_from_marker.rotation
    poses = (pose, other_solution(pose))
    nearer = max(poses, key=lambda one: float(np.sum(one.rotation * before)))
    return nearer, fit.covariance * (1.0 + (moved / EDGES_OFF_PX) ** 2)


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
    weak = (
        score < settings.accept_score_ratio
        or agreement.inner_coverage_ratio < settings.accept_inner_coverage_ratio
    )
    hopeless = (
        score < WEAK_RATIO * settings.accept_score_ratio
        or agreement.inner_coverage_ratio < WEAK_RATIO * settings.accept_inner_coverage_ratio
    )
    if hopeless:
        return Unseen(reason=UnseenReason.SCORE_TOO_LOW, best_score_ratio=score)
    if target < settings.accept_target_score_ratio:
        reason = UnseenReason.SCORE_TOO_LOW if weak else UnseenReason.TARGET_SCORE_TOO_LOW
        return Unseen(reason=reason, best_score_ratio=score)
    window = np.array([gradient.left_px, gradient.top_px], dtype=np.float64)
    corners = _corners_px_by_pixels(image, model, found, window, by_edges=not weak)
    if corners is None:
        reason = UnseenReason.SCORE_TOO_LOW if weak else UnseenReason.SHAPE_DIFFERS
        return Unseen(reason=reason, best_score_ratio=score)
    pose, covariance = _pose_at(found, model, corners)
    return Seen(
        camera_from_marker=pose,
        pose_covariance=covariance,
        corners_px=corners,
        score_ratio=score,
        target_score_ratio=target,
        model_coverage_ratio=agreement.model_coverage_ratio,
        target_coverage_ratio=agreement.target_coverage_ratio,
        fit_error_px2=agreement.fit_error_px2,
        found_by=found_by,
    )
