"""Photometric (direct) refinement of a pose from edges.

The edge fit uses only the position of a gradient peak, the photometric fit its whole profile. The pose from
edges is therefore refined on all pixels, with blur, camera response and illumination. Where the photometric
model does not fit, the pose from edges is returned. It takes 1 to 3 ms.

The photometric cost selects among all fits. Edges of a motion-blurred marker lie at either end of the motion
and often fit the wrong planar solution; a distance limit without half of the motion blur would reject the
right one, and the stated sd would be half a degree for a tip error of decimetres (7 of 41 hard scenes of
camera B). Where the best fit converges elsewhere with large residuals, the pose from edges is returned with
the
covariance of a mixture of both: with an occlusion along one side the edges are wrong and the pixels right.
`tests/tracker/test_limits.py` tests that no error exceeds ten stated standard deviations.

Occluded pixels have zero weight: a round finger resembles a shadow, and if it occludes a third of the marker
(cover30, camera A) the tip error would be 1.37 mm instead of 0.37 mm.
"""

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from tracker.camera import CameraModel
from tracker.edges import GreyImage
from tracker.geometry import Array, Camera, Marker, Rigid
from tracker.marker import MarkerModel
from tracker.photometric import MIN_INLIER_RATIO, OccludedAt, RefinedPose, Textures, refine_poses
from tracker.pose.occurrence import corners_px_at, side_px_of
from tracker.pose.planar import flipped_pose
from tracker.pose.pose_ambiguity import (
    DECIDED_COST,
    PosePrediction,
    delta_chi2_to_next,
    flip_covariance,
    is_nearer_in_rotation,
    mahalanobis_squared,
    mixture_covariance,
)
from tracker.pose.sighting import Seen

# Edges determine a pose to a fraction of a pixel, so a photometric fit that converges farther away is wrong.
MAX_APART_PX, MAX_APART_SIDE_RATIO = 1.2, 0.04
MIN_CONTRAST_GREY = 4.0
# With larger residuals, in units of the noise and of the contrast, or fewer inlier pixels, the pose from
# edges is more accurate. An inlier ratio of 0.6 would accept a wrong tilt in interlaced images.
MAX_RESIDUAL_NOISES, MAX_RESIDUAL_CONTRAST_RATIO, MIN_ACCEPTED_INLIER_RATIO = 2.2, 0.055, 0.72
# Model errors are correlated with the pose, so residuals contain only a part of them. The variance is
# increased by this factor times the residual variance that is not image noise (as from compression), at least
# a ratio of the contrast. Measured on rendered scenes with ground truth.
UNMODELLED_FACTOR, UNMODELLED_CONTRAST_RATIO = 0.6, 0.02
# The delta chi-square assumes independent pixel errors; with model errors about half of it remains.
COST_RATIO = 0.5
# The noise estimate is accurate to a fifth. Residuals beyond that are not noise.
MAX_NOISE_RATIO = 1.2
# Where edges and previous images favour the same solution by this delta chi-square, the flipped one is not
# refined. Edges alone may be wrong, because motion blur displaces them.
CLEAR_DELTA_CHI2 = 100.0


@dataclass(frozen=True, slots=True, kw_only=True)
class ImageContext:
    """The whole image with its noise and the textures, for the photometric refinement.

    Attributes:
        image: grey image (h, w).
        noise_grey: standard deviation of its noise.
        textures: marker textures by name.
    """

    image: GreyImage
    noise_grey: float
    textures: Mapping[str, Textures]


def refine_photometrically(
    camera: CameraModel,
    model: MarkerModel,
    pixels: ImageContext,
    seen: Seen,
    *,
    expected: Rigid[Camera, Marker] | None = None,
    occluded_at: OccludedAt | None = None,
) -> Seen:
    """Return the sighting refined on all pixels of the marker, or unchanged where the model does not fit.

    `expected` is the predicted pose; `occluded_at` marks pixels with zero weight.
    """
    side_px = side_px_of(seen.corners_px)
    starts = [seen.camera_from_marker]
    other = flipped_pose(seen.camera_from_marker)
    if not _is_clear(seen, other, expected):
        starts.append(other)
    fits = refine_poses(
        pixels.image,
        camera.lens,
        pixels.textures[model.name],
        starts,
        side_mm=model.side_mm,
        side_px=side_px,
        noise_grey=pixels.noise_grey,
        occluded_at=occluded_at,
        known=expected.illumination if isinstance(expected, PosePrediction) else None,
    )
    if not fits:
        return seen
    # Correlated residuals, for example from motion blur that deviates from the model, reduce the information.
    ratio = COST_RATIO / max(one.variance_inflation for one in fits)
    costs = [ratio * one.robust_chi2 + mahalanobis_squared(one.camera_from_marker, expected) for one in fits]
    first, *others = np.argsort(costs, kind="stable")
    # Test the best fit alone: if it just fails, a worse fit must not replace it.
    if not _is_exact(fits[first], pixels.noise_grey):
        return seen
    if not _is_near(camera, model, fits[first], seen.camera_from_marker):
        return _mixture_of_both(seen, fits[first])
    pose, covariance = fits[first].camera_from_marker, _with_unmodelled_error(fits[first], pixels.noise_grey)
    for k in others:
        delta_chi2 = float(costs[k] - costs[first])
        covariance = covariance + flip_covariance(
            pose, fits[k].camera_from_marker, delta_chi2=delta_chi2, expected=expected
        )
    lead = seen.delta_chi2
    if len(starts) > 1:
        lead = delta_chi2_to_next(costs, [one.camera_from_marker for one in fits], int(first))
    if (other := fits[first].alternative) is not None:
        delta_chi2 = COST_RATIO * fits[first].alternative_delta_chi2
        covariance = covariance + mixture_covariance(pose, other, delta_chi2=delta_chi2)
        lead = min(lead, max(delta_chi2, 0.0))
    return replace(
        seen,
        camera_from_marker=pose,
        pose_covariance=covariance,
        delta_chi2=lead,
        systematic_residual_ratio=_unexplained(fits[first], pixels.noise_grey),
        illumination=fits[first].illumination,
    )


def _is_clear(seen: Seen, other: Rigid[Camera, Marker], expected: Rigid[Camera, Marker] | None) -> bool:
    """Return whether edges and previous images resolve the ambiguity, so that the flip is not refined."""
    # An infinite difference is no evidence: both fits may have converged to the same solution.
    if not isinstance(expected, PosePrediction) or not CLEAR_DELTA_CHI2 <= seen.delta_chi2 < np.inf:
        return False
    was_sure = expected.delta_chi2 >= DECIDED_COST
    return was_sure and not is_nearer_in_rotation(expected, other, seen.camera_from_marker)


def _mixture_of_both(seen: Seen, by_pixels: RefinedPose) -> Seen:
    """Return the mixture of both poses where pixels contradict edges: an occluded side can bias either."""
    mixture = mixture_covariance(seen.camera_from_marker, by_pixels.camera_from_marker, delta_chi2=0.0)
    if by_pixels.inlier_ratio < MIN_INLIER_RATIO:
        return replace(seen, pose_covariance=seen.pose_covariance + mixture, delta_chi2=0.0)
    return replace(
        seen,
        camera_from_marker=by_pixels.camera_from_marker,
        pose_covariance=by_pixels.covariance + mixture,
        delta_chi2=0.0,
        illumination=by_pixels.illumination,
    )


def _is_exact(one: RefinedPose, noise_grey: float) -> bool:
    left = max(MAX_RESIDUAL_NOISES * noise_grey, MAX_RESIDUAL_CONTRAST_RATIO * one.contrast_grey)
    return (
        one.contrast_grey > MIN_CONTRAST_GREY
        and one.residual_sd_grey < left
        and one.inlier_ratio > MIN_ACCEPTED_INLIER_RATIO
    )


def _unexplained(one: RefinedPose, noise_grey: float) -> float:
    """Return the share of the residual variance that is not image noise, 0..1."""
    left, noise = one.residual_sd_grey**2, (MAX_NOISE_RATIO * noise_grey) ** 2
    return (left - noise) / left if left > noise else 0.0


def _with_unmodelled_error(one: RefinedPose, noise_grey: float) -> Array:
    """Return the covariance (6, 6) increased by the model errors that the residuals do not contain."""
    left = one.residual_sd_grey**2
    untold = max((UNMODELLED_CONTRAST_RATIO * one.contrast_grey) ** 2, left - noise_grey**2)
    return (1.0 + UNMODELLED_FACTOR * untold / max(left, untold)) * one.covariance


def _is_near(camera: CameraModel, model: MarkerModel, one: RefinedPose, found: Rigid[Camera, Marker]) -> bool:
    """Return whether a fit lies near the pose from edges, with half of the motion blur as tolerance."""
    here, there = (corners_px_at(camera, model, pose) for pose in (found, one.camera_from_marker))
    reach = max(MAX_APART_PX, MAX_APART_SIDE_RATIO * side_px_of(here)) + 0.5 * one.motion_blur_px
    return float(np.abs(there - here).max()) < reach
