"""The pose that lays all active edges on the edges of the image, with its covariance."""

from dataclasses import dataclass
from functools import partial

import numpy as np

from tracker.camera import CameraModel
from tracker.camera.lens import lens_numbers
from tracker.edges import Gradient
from tracker.geometry import Array, Camera, Marker, Rigid, vector_from_rotation
from tracker.marker import ActiveEdges, reach_px
from tracker.marker.score import LEAST_RESPONSE_RATIO
from tracker.pose.kernels import PARAMETERS, project_edges, refine
from tracker.pose.planar import other_solution

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
    refined_from = partial(
        _refined,
        camera,
        gradient,
        active,
        contrast=contrast,
        side_px=side_px,
        first_reach_px=first_reach_px,
    )
    first, second = refined_from(start), None
    seed = first.camera_from_marker if first is not None else start
    # A fit that stopped halfway costs more than the wrong solution well fitted, and its mirror image mirrors
    # nothing: what is taken stands only after its own mirror image, fitted from it, has lost.
    for _ in range(MOST_MIRRORINGS):
        mirrored = refined_from(other_solution(seed))
        if mirrored is None or (first is not None and mirrored.cost_px2 >= first.cost_px2):
            second = mirrored or second
            break
        first, second = mirrored, first
        seed = mirrored.camera_from_marker
    if first is None or second is None:
        return first or second
    # By all edges, not by those few that agree: where most are missing or far off, nothing is decided.
    mean_px2 = min(first.cost_px2, second.cost_px2) / _weight(active)
    residual = max(min(first.residual_px, second.residual_px), LEAST_RESIDUAL_PX)
    variance = max(residual**2, mean_px2) * CORRELATION_LENGTH_PX
    costs = [one.cost_px2 + variance * surprise(one.camera_from_marker, expected) for one in (first, second)]
    better, worse = (first, second) if costs[0] <= costs[1] else (second, first)
    gap = abs(costs[1] - costs[0]) / variance
    apart = difference(better.camera_from_marker, worse.camera_from_marker)
    if expected is not None and turned_over(better.camera_from_marker, worse.camera_from_marker, expected):
        gap = min(gap, UNDECIDED_COST)
    if gap > DECIDED_COST or float(np.linalg.norm(apart[3:])) < 1e-3:
        return better
    doubt = 1.0 / (1.0 + float(np.exp(gap / 2.0)))
    return Fit(
        camera_from_marker=better.camera_from_marker,
        covariance=better.covariance + doubt * np.outer(apart, apart),
        cost_px2=better.cost_px2,
        residual_px=better.residual_px,
        shift_px=better.shift_px,
        doubt_ratio=doubt,
    )


def turned_over(
    better: Rigid[Camera, Marker], worse: Rigid[Camera, Marker], expected: Rigid[Camera, Marker]
) -> bool:
    """Whether the better pose is one that no hand reaches from the expected one, and the worse is at hand."""
    turns = [
        float(np.linalg.norm(vector_from_rotation(pose.rotation @ expected.rotation.T)))
        for pose in (better, worse)
    ]
    return bool(turns[0] > np.radians(FAR_TURN_DEG) and turns[1] < np.radians(NEAR_TURN_DEG))


def _weight(active: ActiveEdges) -> float:
    """What all edges that take part in a fit weigh together."""
    return max(float(active.strength_ratio[active.straight].sum()), 1.0)


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
    pixels, directions = np.empty_like(active.points_mm), np.empty_like(active.points_mm)
    in_front = project_edges(
        pose.rotation,
        pose.translation_mm,
        lens_numbers(camera),
        active.points_mm,
        active.normals,
        pixels,
        directions,
    )
    return (pixels, directions) if in_front else None


def _refined(
    camera: CameraModel,
    gradient: Gradient,
    active: ActiveEdges,
    start: Rigid[Camera, Marker],
    *,
    contrast: float,
    side_px: float,
    first_reach_px: float,
) -> Fit | None:
    rotation, translation = start.rotation.copy(), start.translation_mm.copy()
    last = reach_px(side_px)
    reaches = np.array(
        [first_reach_px, first_reach_px, max(last, first_reach_px / 2.0), last, last, last, last, last]
    )
    straight = active.straight
    matrix, shift, squares, cost, weights, count = refine(
        gradient.x,
        gradient.y,
        float(gradient.left_px),
        float(gradient.top_px),
        rotation,
        translation,
        lens_numbers(camera),
        active.points_mm[straight],
        active.normals[straight],
        active.strength_ratio[straight],
        active.strength_ratio[straight],
        max(LEAST_RESPONSE_RATIO * contrast, 0.6 * gradient.threshold),
        reaches,
        SHIFT_SD_PX,
    )
    if count == 0 or weights <= PARAMETERS:
        return None
    variance = max(
        squares / weights * count / max(count - PARAMETERS, 1),
        float(cost) / _weight(active),
        LEAST_RESIDUAL_PX**2,
    )
    # Edgels stand a pixel apart at small sizes and farther at large ones.
    spacing = max(float(np.median(active.length_mm)) * side_px / _side_mm(active), 1e-3)
    variance *= max(CORRELATION_LENGTH_PX / spacing, 1.0)
    variance += SIDE_BIAS_PX**2 * count / INDEPENDENT_SIDES
    scale = np.sqrt(np.diag(matrix))
    try:
        inverse = np.linalg.inv(matrix / np.outer(scale, scale)) / np.outer(scale, scale)
    except np.linalg.LinAlgError:
        return None
    u, _, vt = np.linalg.svd(rotation)
    return Fit(
        camera_from_marker=Rigid(rotation=u @ vt, translation_mm=translation),
        covariance=inverse[:6, :6] * variance,
        cost_px2=float(cost),
        residual_px=float(np.sqrt(squares / weights)),
        shift_px=float(shift),
    )


def _side_mm(active: ActiveEdges) -> float:
    return float(np.ptp(active.points_mm, axis=0).max())


def difference(a: Rigid[Camera, Marker], b: Rigid[Camera, Marker]) -> Array:
    """What takes pose `a` to pose `b`, in the coordinates of the covariance."""
    return np.concatenate(
        [b.translation_mm - a.translation_mm, vector_from_rotation(b.rotation @ a.rotation.T)]
    )
