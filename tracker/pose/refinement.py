"""Edge-based pose refinement with covariance.

The distances of all active edges along their normals are minimised, including lens distortion and one shift
common to all edges, because camera response and ink shift every edge equally. A fit of the four corners would
use a tenth of the information in the pixels. Both planar solutions are refined, and the flipped pose of the
accepted one is always tried. It takes 1 ms per image.

Without the error that does not average out along a side (`SIDE_BIAS_PX`), the stated 95 % ellipsoid contains
the tip of a marker 27 px wide in only a third of the images. In exchange, the covariance of large markers is
larger than necessary.
"""

from dataclasses import dataclass, replace

import numpy as np

from tracker.camera import CameraModel
from tracker.edges import Gradient
from tracker.geometry import Array, Camera, Marker, Rigid
from tracker.geometry.geometry_kernels import NO_BAND, RIDGE, pose_rows
from tracker.marker import ActiveEdges, reach_px
from tracker.marker.score import MIN_RESPONSE_RATIO
from tracker.pose.pose_ambiguity import DECIDED_COST, delta_chi2_to_next, flip_covariance, mahalanobis_squared
from tracker.pose.pose_kernels import PARAMETERS, fit_both_solutions, project_edges

# Camera response, ink and blooming shift all edges equally towards dark or bright, by up to 0.25 px.
SHIFT_SD_PX = 0.25
# Neighbouring edgels share pixels, so their errors are correlated over about three of them.
CORRELATION_LENGTH_PX = 3.0
MIN_RESIDUAL_PX = 0.03
# Error that does not average out along a side: aliasing of a straight edge with the pixel grid, blur between
# neighbouring edges. Measured on rendered scenes with ground truth.
SIDE_BIAS_PX, INDEPENDENT_SIDES = 0.05, 10.0
MAX_MIRRORINGS = 5
IN_ORDER = np.arange(PARAMETERS)


@dataclass(frozen=True, slots=True, kw_only=True)
class EdgeFit:
    """A refined pose.

    Attributes:
        camera_from_marker: the pose.
        covariance: (6, 6) [mm, rad], as in `Seen`.
        shift_px: common shift of all edges towards their bright side.
        delta_chi2: as in `Seen`.
    """

    camera_from_marker: Rigid[Camera, Marker]
    covariance: Array
    shift_px: float
    delta_chi2: float = float("inf")


def fit_pose_to_edges(
    camera: CameraModel,
    gradient: Gradient,
    active: ActiveEdges,
    start: Rigid[Camera, Marker],
    *,
    contrast: float,
    side_px: float,
    first_reach_px: float,
    expected: Rigid[Camera, Marker] | None = None,
) -> EdgeFit | None:
    """Return the better of both planar solutions around `start`; None when no pose fits.

    Where neither the image nor the prediction resolves the ambiguity, the covariance is that of the mixture.
    """
    rotations, translations, matrices, numbers, first, second = _both(
        camera, gradient, active, start, contrast, reach_px(side_px), first_reach_px
    )
    if first < 0:
        return None

    def pose_of(k: int) -> Rigid[Camera, Marker]:
        return Rigid(rotation=rotations[k], translation_mm=translations[k])

    if second < 0:
        return _fit(pose_of(first), matrices[first], numbers[first], active, side_px)
    # Variance over all edges, not only over the inliers: where most are missing, the ambiguity is not
    # resolved.
    mean_px2 = float(numbers[first, 0]) / active.fitted.weight
    residuals = [float(numbers[k, 2] / numbers[k, 3]) for k in (first, second)]
    variance = max(min(residuals), MIN_RESIDUAL_PX**2, mean_px2) * CORRELATION_LENGTH_PX
    costs = [float(numbers[k, 0]) for k in (first, second)]
    if expected is None and costs[1] - costs[0] > DECIDED_COST * variance:
        return _fit(pose_of(first), matrices[first], numbers[first], active, side_px)
    poses = [pose_of(first), pose_of(second)]
    costs = [
        cost / variance + mahalanobis_squared(pose, expected) for cost, pose in zip(costs, poses, strict=True)
    ]
    best = int(costs[0] > costs[1])
    first = (first, second)[best]
    fit = _fit(poses[best], matrices[first], numbers[first], active, side_px)
    if fit is None:
        return None
    delta_chi2 = abs(costs[1] - costs[0])
    spread = flip_covariance(poses[best], poses[1 - best], delta_chi2=delta_chi2, expected=expected)
    return replace(
        fit,
        covariance=fit.covariance + spread,
        delta_chi2=delta_chi2_to_next(costs, poses, best),
    )


def _both(
    camera: CameraModel,
    gradient: Gradient,
    active: ActiveEdges,
    start: Rigid[Camera, Marker],
    contrast: float,
    last_reach_px: float,
    first_reach_px: float,
) -> tuple[Array, Array, Array, Array, int, int]:
    """Call `fit_both_solutions` around a start, and return its result."""
    fitted, last = active.fitted, last_reach_px
    reaches = np.array(
        [first_reach_px, first_reach_px, max(last, first_reach_px / 2.0), last, last, last, last, last]
    )
    both: tuple[Array, Array, Array, Array, int, int] = fit_both_solutions(
        gradient.x,
        gradient.y,
        float(gradient.left_px),
        float(gradient.top_px),
        camera.lens,
        fitted.points_mm,
        fitted.normals,
        fitted.strength_ratio,
        max(MIN_RESPONSE_RATIO * contrast, 0.6 * gradient.threshold),
        reaches,
        SHIFT_SD_PX,
        start.rotation,
        start.translation_mm,
        MAX_MIRRORINGS,
        MIN_RESIDUAL_PX**2,
        # Twice the deciding difference, because the cost of a fit that has not converged still decreases.
        2.0 * DECIDED_COST * CORRELATION_LENGTH_PX,
    )
    return both


def projected_edges(
    camera: CameraModel, pose: Rigid[Camera, Marker], active: ActiveEdges
) -> tuple[Array, Array] | None:
    """Return active edges in px (n, 2) and unit normals (n, 2), dark to bright; None behind the camera."""
    # Copies, because Numba compiles a kernel again for arrays that are read-only.
    pixels, directions, in_front = project_edges(
        pose.rotation.copy(), pose.translation_mm.copy(), camera.lens, active.points_mm, active.normals
    )
    return (pixels, directions) if in_front else None


def _fit(
    pose: Rigid[Camera, Marker], matrix: Array, numbers: Array, active: ActiveEdges, side_px: float
) -> EdgeFit | None:
    """Return the fit of one solution of `fit_both_solutions`; None where the pose is not determined."""
    cost, shift, squares, weights, count = (float(v) for v in numbers)
    variance = max(
        squares / weights * count / max(count - PARAMETERS, 1),
        cost / active.fitted.weight,
        MIN_RESIDUAL_PX**2,
    )
    # Edgels are one pixel apart at small sizes and farther at large ones.
    spacing = max(active.fitted.spacing_ratio * side_px, 1e-3)
    variance *= max(CORRELATION_LENGTH_PX / spacing, 1.0)
    variance += SIDE_BIAS_PX**2 * count / INDEPENDENT_SIDES
    inverse, is_determined = pose_rows(matrix, IN_ORDER, NO_BAND, RIDGE)
    if not is_determined:
        return None
    return EdgeFit(
        camera_from_marker=pose,
        covariance=inverse[:, :6] * variance,
        shift_px=shift,
    )
