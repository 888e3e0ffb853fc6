"""The pose that lays all active edges on the edges of the image, with its covariance."""

from dataclasses import dataclass, replace

import numpy as np

from tracker.camera import CameraModel
from tracker.edges import Gradient
from tracker.geometry import Array, Camera, Marker, Rigid, vector_from_rotation
from tracker.marker import ActiveEdges, reach_px
from tracker.marker.score import LEAST_RESPONSE_RATIO
from tracker.pose.kernels import PARAMETERS, project_edges, refine_both

# Camera response, ink and blooming shift all edges towards dark or bright alike: by up to 0.25 px.
SHIFT_SD_PX = 0.25
# Neighbouring edgels share pixels, so that their errors are alike over about three of them.
CORRELATION_LENGTH_PX = 3.0
LEAST_RESIDUAL_PX = 0.03
# Costs of both solutions this much apart (in units of the residuals' variance) leave no doubt: the odds of
# the worse one are under 1 in 10,000.
DECIDED_COST = 18.0
# What does not average out along a side: the pattern of pixels against a straight edge, blur between edges
# that are near to each other. Measured on rendered scenes, where the truth is known.
SIDE_BIAS_PX, INDEPENDENT_SIDES = 0.05, 10.0
UNDECIDED_COST = 2.0
# Nearer than this, two solutions are one.
LEAST_TURN_RAD = 1e-3
EXPECTED_TURN_SD_DEG = 4.0
MOST_MIRRORINGS = 5
# A hand turns a drill by less than this between two images; farther is the other solution.
FAR_TURN_DEG, NEAR_TURN_DEG = 20.0, 10.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Fit:
    """A refined pose.

    Attributes:
        camera_from_marker: the pose.
        covariance: (6, 6) [mm, rad], as in `Seen`.
        cost_px2: robust sum of squared residuals.
        residual_px: sd of the residuals along the normals.
        shift_px: by how much all edges are shifted towards their bright side.
        doubt_ratio: probability that the other planar solution is the true one, 0..0.5.
    """

    camera_from_marker: Rigid[Camera, Marker]
    covariance: Array
    cost_px2: float
    residual_px: float
    shift_px: float
    doubt_ratio: float = 0.0


def refined_pose(
    camera: CameraModel,
    gradient: Gradient,
    active: ActiveEdges,
    start: Rigid[Camera, Marker],
    *,
    contrast: float,
    side_px: float,
    first_reach_px: float,
    expected: Rigid[Camera, Marker] | None = None,
) -> Fit | None:
    """The better of both planar solutions around `start`; None when no pose fits.

    Where neither the image nor what was expected decides between the two, the covariance spans both.
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
    # By all edges, not by those few that agree: where most are missing or far off, nothing is decided.
    mean_px2 = float(numbers[first, 0]) / active.fitted.weight
    residuals = [float(numbers[k, 2] / numbers[k, 3]) for k in (first, second)]
    variance = max(min(residuals), LEAST_RESIDUAL_PX**2, mean_px2) * CORRELATION_LENGTH_PX
    costs = [float(numbers[k, 0]) for k in (first, second)]
    if expected is None and costs[1] - costs[0] > DECIDED_COST * variance:
        return _fit(pose_of(first), matrices[first], numbers[first], active, side_px)
    poses = [pose_of(first), pose_of(second)]
    costs = [cost + variance * surprise(pose, expected) for cost, pose in zip(costs, poses, strict=True)]
    if costs[0] > costs[1]:
        first, poses = second, poses[::-1]
    fit = _fit(poses[0], matrices[first], numbers[first], active, side_px)
    gap = abs(costs[1] - costs[0]) / variance
    if fit is None:
        return None
    doubt, spread = doubt_between(poses[0], poses[1], gap=gap, expected=expected)
    return replace(fit, covariance=fit.covariance + spread, doubt_ratio=doubt)


def _both(
    camera: CameraModel,
    gradient: Gradient,
    active: ActiveEdges,
    start: Rigid[Camera, Marker],
    contrast: float,
    last_reach_px: float,
    first_reach_px: float,
) -> tuple[Array, Array, Array, Array, int, int]:
    """What `refine_both` makes of a start: fits, and which of them is the better and which the other."""
    fitted, last = active.fitted, last_reach_px
    reaches = np.array(
        [first_reach_px, first_reach_px, max(last, first_reach_px / 2.0), last, last, last, last, last]
    )
    both: tuple[Array, Array, Array, Array, int, int] = refine_both(
        gradient.x,
        gradient.y,
        float(gradient.left_px),
        float(gradient.top_px),
        camera.lens,
        fitted.points_mm,
        fitted.normals,
        fitted.strength_ratio,
        max(LEAST_RESPONSE_RATIO * contrast, 0.6 * gradient.threshold),
        reaches,
        SHIFT_SD_PX,
        start.rotation,
        start.translation_mm,
        MOST_MIRRORINGS,
        LEAST_RESIDUAL_PX**2,
        # Twice what decides: the cost of a fit that is not at its end falls a little yet.
        2.0 * DECIDED_COST * CORRELATION_LENGTH_PX,
    )
    return both


def doubt_between(
    better: Rigid[Camera, Marker],
    worse: Rigid[Camera, Marker],
    *,
    gap: float,
    expected: Rigid[Camera, Marker] | None,
) -> tuple[float, Array]:
    """Probability 0..0.5 that the worse of two planar solutions is the true one, and what it adds (6, 6).

    `gap` is by how much its squared residuals are larger, in units of their variance.
    """
    apart = _difference(better, worse)
    if expected is not None and _turned_over(better, worse, expected):
        gap = min(gap, UNDECIDED_COST)
    if gap > DECIDED_COST or float(np.linalg.norm(apart[3:])) < LEAST_TURN_RAD:
        return 0.0, np.zeros((6, 6))
    doubt = 1.0 / (1.0 + float(np.exp(gap / 2.0)))
    return doubt, doubt * np.outer(apart, apart)


def _turned_over(
    better: Rigid[Camera, Marker], worse: Rigid[Camera, Marker], expected: Rigid[Camera, Marker]
) -> bool:
    """Whether the better pose is one that no hand reaches from the expected one, and the worse is at hand."""
    turns = [
        float(np.linalg.norm(vector_from_rotation(pose.rotation @ expected.rotation.T)))
        for pose in (better, worse)
    ]
    return bool(turns[0] > np.radians(FAR_TURN_DEG) and turns[1] < np.radians(NEAR_TURN_DEG))


def surprise(pose: Rigid[Camera, Marker], expected: Rigid[Camera, Marker] | None) -> float:
    """Squared turn from the expected pose, in units of what a hand turns beside its prediction."""
    if expected is None:
        return 0.0
    turned = vector_from_rotation(pose.rotation @ expected.rotation.T)
    return float(turned @ turned) / float(np.radians(EXPECTED_TURN_SD_DEG)) ** 2


def projected_edges(
    camera: CameraModel, pose: Rigid[Camera, Marker], active: ActiveEdges
) -> tuple[Array, Array] | None:
    """Active edges as pixels (n, 2) and unit normals (n, 2), dark to bright; None behind the camera."""
    pixels, directions, in_front = project_edges(
        pose.rotation, pose.translation_mm, camera.lens, active.points_mm, active.normals
    )
    return (pixels, directions) if in_front else None


def _fit(
    pose: Rigid[Camera, Marker], matrix: Array, numbers: Array, active: ActiveEdges, side_px: float
) -> Fit | None:
    """The fit of what `refine_both` returns of one solution; None where it says nothing of the pose."""
    cost, shift, squares, weights, count = (float(v) for v in numbers)
    variance = max(
        squares / weights * count / max(count - PARAMETERS, 1),
        cost / active.fitted.weight,
        LEAST_RESIDUAL_PX**2,
    )
    # Edgels stand a pixel apart at small sizes and farther at large ones.
    spacing = max(active.fitted.spacing_ratio * side_px, 1e-3)
    variance *= max(CORRELATION_LENGTH_PX / spacing, 1.0)
    variance += SIDE_BIAS_PX**2 * count / INDEPENDENT_SIDES
    scale = np.sqrt(matrix.diagonal())
    scales = scale[:, None] * scale
    try:
        inverse = np.linalg.inv(matrix / scales) / scales
    except np.linalg.LinAlgError:
        return None
    return Fit(
        camera_from_marker=pose,
        covariance=inverse[:6, :6] * variance,
        cost_px2=cost,
        residual_px=float(np.sqrt(squares / weights)),
        shift_px=shift,
    )


def _difference(a: Rigid[Camera, Marker], b: Rigid[Camera, Marker]) -> Array:
    """What takes pose `a` to pose `b`, in the coordinates of the covariance."""
    return np.concatenate(
        [b.translation_mm - a.translation_mm, vector_from_rotation(b.rotation @ a.rotation.T)]
    )
