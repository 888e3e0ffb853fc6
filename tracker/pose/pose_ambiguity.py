"""Planar pose ambiguity: choose between the two solutions for a square from this and previous images.

A single noisy image of a small marker does not resolve the ambiguity; several images do. Both solutions are
tracked with their delta chi-square. A wrong first choice is corrected within a few images, and until then the
covariance is that of a mixture of both. The delta chi-square is bounded, so that later images can reverse it.

Edges that contradict the prediction do not decide, however large their delta chi-square: a strip along a side
gives more than 100 in favour of the wrong solution, and a tip error of 33 mm. Where the flipped solution is
nearer to the predicted pose, or previous images were undecided, both are refined photometrically.
"""

from dataclasses import dataclass

import numpy as np

from tracker.geometry import Array, Camera, Marker, Rigid, vector_from_rotation
from tracker.geometry.geometry_kernels import rotation_angle_between
from tracker.photometric import KnownIllumination

# At this delta chi-square the ambiguity is resolved: the odds of the worse solution are below 1 in 8,000.
DECIDED_COST = 18.0
UNDECIDED_COST = 2.0
# Solutions that differ by less are the same solution.
MIN_ROTATION_RAD, ONE_SOLUTION_RAD = 1e-3, float(np.radians(1.0))
EXPECTED_ROTATION_SD_DEG = 4.0
# A hand rotates a drill by less than this between two images; a larger rotation is the flipped solution.
FAR_ROTATION_DEG, NEAR_ROTATION_DEG = 20.0, 10.0


@dataclass(frozen=True, slots=True, kw_only=True)
class PosePrediction(Rigid[Camera, Marker]):
    """The pose predicted from previous images, and its flipped planar solution.

    Attributes:
        flipped: the other planar solution, predicted with the same motion.
        delta_chi2: chi-square of the flipped solution minus that of this pose, over previous images.
        illumination: the uneven illumination of the last image; None where it was even.
    """

    flipped: Rigid[Camera, Marker]
    delta_chi2: float
    illumination: KnownIllumination | None = None


def mahalanobis_squared(pose: Rigid[Camera, Marker], expected: Rigid[Camera, Marker] | None) -> float:
    """Return the squared Mahalanobis distance of a pose from the prediction, in rotation; 0 without one.

    The smaller of two values: the squared angle from the predicted pose divided by the variance of a hand's
    rotation, and the same from the flipped prediction plus its `delta_chi2`. Both solutions therefore remain
    possible until the images together decide.
    """
    if expected is None:
        return 0.0
    against = _rotation_sd2(pose, expected)
    if isinstance(expected, PosePrediction):
        against = min(against, expected.delta_chi2 + _rotation_sd2(pose, expected.flipped))
    return against


def delta_chi2_to_next(costs_sd2: list[float], poses: list[Rigid[Camera, Marker]], best: int) -> float:
    """Return the chi-square of the next different solution minus that of the best; infinite without one.

    `costs_sd2` are chi-squares that include the distance from the prediction.
    """
    others = [
        cost - costs_sd2[best]
        for cost, pose in zip(costs_sd2, poses, strict=True)
        if _rotation_rad(pose, poses[best]) > ONE_SOLUTION_RAD
    ]
    return max(min(others), 0.0) if others else float("inf")


def flip_covariance(
    better: Rigid[Camera, Marker],
    worse: Rigid[Camera, Marker],
    *,
    delta_chi2: float,
    expected: Rigid[Camera, Marker] | None,
) -> Array:
    """Return the term (6, 6) added to a pose's covariance for the probability of the flipped solution.

    `delta_chi2` is the chi-square of `worse` minus that of `better`.
    """
    if delta_chi2 > DECIDED_COST and (
        expected is None or _rotation_rad(better, expected) < np.radians(FAR_ROTATION_DEG)
    ):
        return np.zeros((6, 6))
    if expected is not None and _is_flip_of_expected(better, worse, expected):
        delta_chi2 = min(delta_chi2, UNDECIDED_COST)
    difference = pose_difference(better, worse)
    if delta_chi2 > DECIDED_COST or float(np.linalg.norm(difference[3:])) < MIN_ROTATION_RAD:
        return np.zeros((6, 6))
    return _spread(difference, _probability_of_worse(delta_chi2))


def mixture_covariance(
    claimed: Rigid[Camera, Marker], other: Rigid[Camera, Marker], *, delta_chi2: float
) -> Array:
    """Return the term (6, 6) added to a pose's covariance for the probability of another pose.

    `delta_chi2` as in `flip_covariance`; at 0 both are equally probable.
    """
    return _spread(pose_difference(claimed, other), _probability_of_worse(delta_chi2))


def _probability_of_worse(delta_chi2: float) -> float:
    """Return the probability of the worse of two solutions, for a difference `delta_chi2` of chi-square."""
    return 1.0 / (1.0 + float(np.exp(delta_chi2 / 2.0)))


def is_nearer_in_rotation(
    one: Rigid[Camera, Marker], to: Rigid[Camera, Marker], than: Rigid[Camera, Marker]
) -> bool:
    """Return whether a pose is nearer in rotation to the first than to the second."""
    return _rotation_rad(one, to) < _rotation_rad(one, than)


def _spread(difference: Array, probability: float) -> Array:
    """Return the mixture covariance (6, 6) for another pose at `difference` (6,) with this probability."""
    spread = np.outer(difference, difference)
    # A rotation moves directions on an arc, first-order propagation on its tangent; for points, whoever knows
    # their lever adds the same (`second_order.py`).
    beside = float(1.0 - np.cos(np.linalg.norm(difference[3:])))
    spread[3:, 3:] += beside**2 * np.eye(3)
    return np.asarray(probability * spread)


def _rotation_rad(a: Rigid[Camera, Marker], b: Rigid[Camera, Marker]) -> float:
    """Return the rotation angle between two poses [rad]."""
    return float(rotation_angle_between(a.rotation, b.rotation))


def _rotation_sd2(pose: Rigid[Camera, Marker], other: Rigid[Camera, Marker]) -> float:
    return (_rotation_rad(pose, other) / float(np.radians(EXPECTED_ROTATION_SD_DEG))) ** 2


def _is_flip_of_expected(
    better: Rigid[Camera, Marker], worse: Rigid[Camera, Marker], expected: Rigid[Camera, Marker]
) -> bool:
    """Return whether a hand cannot reach the better pose from the prediction, but can reach the worse one."""
    is_far = _rotation_rad(better, expected) > np.radians(FAR_ROTATION_DEG)
    return bool(is_far and _rotation_rad(worse, expected) < np.radians(NEAR_ROTATION_DEG))


def pose_difference(a: Rigid[Camera, Marker], b: Rigid[Camera, Marker]) -> Array:
    """Return the difference (6,) [mm, rad] from pose `a` to `b`, in the coordinates of the covariance."""
    return np.concatenate(
        [b.translation_mm - a.translation_mm, vector_from_rotation(b.rotation @ a.rotation.T)]
    )
