"""Accept or reject a fitted occurrence by its edges, its pixels, and photometric verification.

An occurrence that the photometric model of illumination and occlusion fits only approximately is accepted in
a search only where it is large and nearly unoccluded, otherwise only in tracking. All false squares that pass
are small or half occluded, while bent paper, the usual cause of an approximate fit, is mostly large in the
image.
"""

from dataclasses import dataclass, replace

import numpy as np

from tracker.camera import CameraModel
from tracker.edges import Gradient, GreyImage
from tracker.geometry import Array, Camera, Marker, Rigid
from tracker.marker import (
    MarkerModel,
    ScoreSettings,
    matches_under_saturation,
    photometric_fit_of,
    shape_mismatch_of,
)
from tracker.photometric import OccludedAt
from tracker.pose.occurrence import Occurrence, corners_px_at, side_px_of
from tracker.pose.photometric_refinement import ImageContext, refine_photometrically
from tracker.pose.planar import flipped_pose, pose_from_corners
from tracker.pose.pose_ambiguity import flip_covariance
from tracker.pose.sighting import FoundBy, Seen, Sighting, Unseen, UnseenReason

# In scenes without a marker other squares reach a correlation of 0.86 under even illumination, and once in
# hundreds of images 0.9 to 0.93 where they are small or wide. The marker itself has 0.97. An occurrence below
# these limits is verified photometrically.
PLAIN_SIDES_PX, PLAIN_CORRELATION = (20.0, 24.0, 30.0, 40.0), (0.95, 0.92, 0.92, 0.95)
# Weak edges are verified photometrically only above this correlation before the fit.
MIN_VERIFICATION_CORRELATION = 0.45
# Beyond this error of the edges, the photometric refinement does not converge from their pose.
MAX_EDGE_ERROR_PX = 0.6
# On bent paper a part of the shape may be displaced. A search accepts that only where the occurrence is large
# and nearly complete; tracking accepts lower correlations if no shape mismatch is found.
WIDE_PX, FULL_COVERAGE_RATIO, KNOWN_CORRELATION = 36.0, 0.85, 0.85
NEAR_CORRELATION, NEAR_INNER_CORRELATION = 0.93, 0.9
# Under saturation, a track is accepted if it has hardly moved and has no edges other than the model's.
SATURATED_TARGET_COVERAGE_RATIO, SATURATED_MOVE_PX, SATURATED_MOVE_SIDE_RATIO = 0.9, 3.0, 0.1


@dataclass(frozen=True, slots=True, kw_only=True)
class OccurrenceContext:
    """Image, model and settings that an occurrence is verified with.

    Attributes:
        camera: the camera model.
        model: the marker model.
        pixels: the whole image with its noise and the textures.
        window: region of the image (h, w) of `gradient`.
        gradient: image gradient of the window.
        settings: acceptance thresholds.
        expected: predicted pose; None in a search.
    """

    camera: CameraModel
    model: MarkerModel
    pixels: ImageContext
    window: GreyImage
    gradient: Gradient
    settings: ScoreSettings
    expected: Rigid[Camera, Marker] | None

    @property
    def found_by(self) -> FoundBy:
        """Return "search" without a predicted pose, else "track"."""
        return "search" if self.expected is None else "track"

    @property
    def corner_px(self) -> Array:
        """Return the top left pixel (2,) of the window."""
        return np.array([self.gradient.left_px, self.gradient.top_px], dtype=np.float64)


def verify_occurrence(scene: OccurrenceContext, found: Occurrence) -> Sighting:
    """Return `Seen` with the photometrically refined pose if the occurrence is the marker, else `Unseen`.

    The tests run in order of their cost: the edges; then the correlation of the inside, assuming even
    illumination; then the photometric model with blur, shadows, highlights and occlusion.
    """
    settings, agreement = scene.settings, found.agreement
    score, target = agreement.score_ratio(settings), agreement.target_score_ratio(settings)
    minimum, min_inner = settings.accept_score_ratio, settings.accept_inner_coverage_ratio
    inner = agreement.inner_coverage_ratio
    weak = score < minimum or inner < min_inner
    reason = UnseenReason.SCORE_TOO_LOW if weak else UnseenReason.SHAPE_DIFFERS
    unseen = Unseen(reason=reason, best_score_ratio=score)
    share = settings.verified_threshold_ratio
    if score < share * minimum or inner < share * min_inner:
        return unseen
    if target < settings.accept_target_score_ratio:
        return unseen if weak else replace(unseen, reason=UnseenReason.TARGET_SCORE_TOO_LOW)
    plain, maximum = _plain_correlation(scene, found)
    if weak and maximum < MIN_VERIFICATION_CORRELATION:
        return unseen
    by_edges = Seen(
        camera_from_marker=found.fit.camera_from_marker,
        pose_covariance=found.fit.covariance,
        corners_px=found.seen_corners_px,
        score_ratio=score,
        target_score_ratio=target,
        model_coverage_ratio=agreement.model_coverage_ratio,
        target_coverage_ratio=agreement.target_coverage_ratio,
        fit_error_px2=agreement.fit_error_px2,
        found_by=scene.found_by,
        delta_chi2=found.fit.delta_chi2,
    )
    occluded_at: OccludedAt | None = None
    if weak or plain < _min_plain(found.corners_px):
        explained = _photometrically_verified(scene, found, by_edges, plain=0.0 if weak else plain)
        if explained is None:
            return unseen
        by_edges, occluded_at = explained
    return refine_photometrically(
        scene.camera,
        scene.model,
        scene.pixels,
        by_edges,
        expected=scene.expected,
        occluded_at=occluded_at,
    )


def _min_plain(corners_px: Array) -> float:
    """Return the correlation required under even illumination for a square with these corners (4, 2)."""
    return float(np.interp(side_px_of(corners_px), PLAIN_SIDES_PX, PLAIN_CORRELATION))


def _plain_correlation(scene: OccurrenceContext, found: Occurrence) -> tuple[float, float]:
    """Return the correlation under even illumination, once as -1 on a shape mismatch, once regardless."""
    correlation, maximum = -1.0, -1.0
    # Bent paper deviates from its flat pose, while another shape mismatches at both sets of corners.
    for corners in (found.corners_px, found.seen_corners_px):
        look = shape_mismatch_of(
            scene.window, scene.model.square, corners - scene.corner_px, side_px=side_px_of(corners)
        )
        maximum = max(maximum, look.correlation)
        if not look.is_other_shape:
            correlation = max(correlation, look.correlation)
        if correlation >= _min_plain(corners):
            break
    return correlation, maximum


def _photometrically_verified(
    scene: OccurrenceContext, found: Occurrence, seen: Seen, *, plain: float
) -> tuple[Seen, OccludedAt | None] | None:
    """Return the sighting if the photometric model fits, or fits approximately and the correlation is high.

    Also returns the occlusion of the marker where it is known. The sighting is None where it is rejected.
    """
    fit = photometric_fit_of(
        scene.window,
        scene.model.square,
        found.corners_px - scene.corner_px,
        side_px=side_px_of(found.corners_px),
    )
    if (fit is None or not fit.is_accepted) and _is_saturated_track(scene, found):
        return seen, None
    if fit is None or fit.is_rotation_ambiguous:
        return None
    if fit.is_accepted or (fit.is_accepted_when_tracked and _is_where_expected(scene, found)):
        moved = _moved(scene, found, seen, fit.corners_px + scene.corner_px)
        moved = replace(moved, is_noise_corrected=fit.noise_corrected is not None)
        return moved, fit.occludes if fit.is_occluded else None
    if plain <= 0.0:
        return None
    correlation, inner = fit.correlation, fit.inner_correlation
    if scene.expected is not None:
        return (seen, None) if min(correlation, inner) >= KNOWN_CORRELATION else None
    wide = side_px_of(seen.corners_px) > WIDE_PX and seen.model_coverage_ratio > FULL_COVERAGE_RATIO
    # Bent paper needs no highlights, and a model with highlights can mask another shape.
    is_bent = wide and not fit.has_highlights
    return (
        (seen, None)
        if is_bent and correlation >= NEAR_CORRELATION and inner >= NEAR_INNER_CORRELATION
        else None
    )


def _is_saturated_track(scene: OccurrenceContext, found: Occurrence) -> bool:
    """Return whether the occurrence is at its predicted pose and matches the model under saturation."""
    enough = found.agreement.target_coverage_ratio >= SATURATED_TARGET_COVERAGE_RATIO
    if not (enough and _is_where_expected(scene, found)):
        return False
    corners = found.corners_px - scene.corner_px
    return matches_under_saturation(
        scene.window, scene.model.square, corners, side_px=side_px_of(found.corners_px)
    )


def _is_where_expected(scene: OccurrenceContext, found: Occurrence) -> bool:
    if scene.expected is None:
        return False
    expected = corners_px_at(scene.camera, scene.model, scene.expected)
    off = float(np.abs(found.corners_px - expected).max())
    return off <= max(SATURATED_MOVE_PX, SATURATED_MOVE_SIDE_RATIO * side_px_of(found.corners_px))


def _moved(scene: OccurrenceContext, found: Occurrence, seen: Seen, corners_px: Array) -> Seen:
    """Return the sighting with corners (4, 2) from the pixels, and their pose where the edges deviate."""
    seen = replace(seen, corners_px=corners_px)
    moved = float(np.abs(corners_px - found.corners_px).max())
    if moved <= MAX_EDGE_ERROR_PX:
        return seen
    pose = pose_from_corners(scene.camera, corners_px, side_mm=scene.model.side_mm)
    if pose is None:
        return seen
    before = found.fit.camera_from_marker.rotation
    both = (pose, flipped_pose(pose))
    nearer, farther = sorted(both, key=lambda one: -float(np.sum(one.rotation * before)))
    # With that error the edges cannot resolve the planar pose ambiguity.
    spread = flip_covariance(nearer, farther, delta_chi2=0.0, expected=scene.expected)
    return replace(
        seen,
        camera_from_marker=nearer,
        pose_covariance=found.fit.covariance * (1.0 + (moved / MAX_EDGE_ERROR_PX) ** 2) + spread,
        delta_chi2=0.0,
    )
