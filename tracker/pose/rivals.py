"""Which of the two planar solutions is the true one: what one image says, and what the images before say.

One image of a small marker in noise cannot tell the two solutions apart; several in a row can. So both are
carried from image to image with the difference of their costs; a wrong first choice is left within a few
images, and until then the covariance spans both. The difference is bounded, so that it can be lost again.

Edges that contradict what was expected are not clear, however large their difference: a strip along a side
gives edges a difference over 100 for the wrong solution, and a tip that is off by 33 mm. Where the other
solution is nearer to the expected pose, or the images before were undecided, the pixels judge both.
"""

from dataclasses import dataclass

import numpy as np

from tracker.appearance import KnownLight
from tracker.geometry import Array, Camera, Marker, Rigid, vector_from_rotation
from tracker.geometry.kernels import turn_between
from tracker.pose.arc import TOOL_REACH_MM

# Costs of both solutions this much apart (in units of the residuals' variance) leave no doubt: the odds of
# the worse one are under 1 in 10,000.
DECIDED_COST = 18.0
UNDECIDED_COST = 2.0
# Nearer than this, two solutions are one.
MIN_TURN_RAD, ONE_SOLUTION_RAD = 1e-3, float(np.radians(1.0))
EXPECTED_TURN_SD_DEG = 4.0
SMALL_DOUBT = 0.05
# A hand turns a drill by less than this between two images; farther is the other solution.
FAR_TURN_DEG, NEAR_TURN_DEG = 20.0, 10.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Expected(Rigid[Camera, Marker]):
    """The pose that the images before let expect, and its rival.

    Attributes:
        rival: the other planar solution; it moves along.
        lead_sd2: by how much the images before speak for this one, in squared residuals by their variance.
        light: the uneven light of the last image; None where it was even.
    """

    rival: Rigid[Camera, Marker]
    lead_sd2: float
    light: KnownLight | None = None


def surprise(pose: Rigid[Camera, Marker], expected: Rigid[Camera, Marker] | None) -> float:
    """What the images before say against a pose, in squared residuals by their variance.

    The squared turn from the expected pose, in units of what a hand turns beside its prediction; or from its
    rival, and what spoke against that one. So both are carried, until the images together decide.
    """
    if expected is None:
        return 0.0
    against = _turn_sd2(pose, expected)
    if isinstance(expected, Expected):
        against = min(against, expected.lead_sd2 + _turn_sd2(pose, expected.rival))
    return against


def lead_between(costs_sd2: list[float], poses: list[Rigid[Camera, Marker]], best: int) -> float:
    """By how much the best of some fits leads the next one that is another solution; infinite without one.

    Costs are squared residuals by their variance, and what is expected is in them.
    """
    others = [
        cost - costs_sd2[best]
        for cost, pose in zip(costs_sd2, poses, strict=True)
        if _turn_rad(pose, poses[best]) > ONE_SOLUTION_RAD
    ]
    return max(min(others), 0.0) if others else float("inf")


def doubt_between(
    better: Rigid[Camera, Marker],
    worse: Rigid[Camera, Marker],
    *,
    gap: float,
    expected: Rigid[Camera, Marker] | None,
) -> Array:
    """What it adds to a pose's covariance (6, 6) that the worse of two planar solutions may be the true one.

    `gap` is by how much its squared residuals are larger, in units of their variance.
    """
    if gap > DECIDED_COST and (expected is None or _turn_rad(better, expected) < np.radians(FAR_TURN_DEG)):
        return np.zeros((6, 6))
    if expected is not None and _turned_over(better, worse, expected):
        gap = min(gap, UNDECIDED_COST)
    apart = difference(better, worse)
    if gap > DECIDED_COST or float(np.linalg.norm(apart[3:])) < MIN_TURN_RAD:
        return np.zeros((6, 6))
    return _spread(apart, _doubt_at(gap))


def doubt_over(claimed: Rigid[Camera, Marker], other: Rigid[Camera, Marker], *, gap: float) -> Array:
    """What it adds to a pose's covariance (6, 6) that another one may be true, wherever that is.

    `gap` as in `doubt_between`; at 0 it is as probable.
    """
    return _spread(difference(claimed, other), _doubt_at(gap))


def _doubt_at(gap: float) -> float:
    """How probable it is that the worse one of two is true."""
    return 1.0 / (1.0 + float(np.exp(gap / 2.0)))


def is_nearer(one: Rigid[Camera, Marker], to: Rigid[Camera, Marker], than: Rigid[Camera, Marker]) -> bool:
    """Whether a pose is turned less from the first than from the second."""
    return _turn_rad(one, to) < _turn_rad(one, than)


def _spread(apart: Array, doubt: float) -> Array:
    """The covariance (6, 6) of a pose beside which another one, so much apart, is so probable."""
    spread = np.outer(apart, apart)
    # A turn goes along an arc, a covariance along its tangent: by so much is the other solution beside it.
    # By so much nearer is the end of a tool, which no turn tells to first order; a small doubt need not.
    beside = float(1.0 - np.cos(np.linalg.norm(apart[3:])))
    spread[3:, 3:] += beside**2 * np.eye(3)
    spread[:3, :3] += (TOOL_REACH_MM * beside) ** 2 * doubt / (doubt + SMALL_DOUBT) * np.eye(3)
    return np.asarray(doubt * spread)


def _turn_rad(a: Rigid[Camera, Marker], b: Rigid[Camera, Marker]) -> float:
    """By how much one pose is turned from the other."""
    return float(turn_between(a.rotation, b.rotation))


def _turn_sd2(pose: Rigid[Camera, Marker], other: Rigid[Camera, Marker]) -> float:
    return (_turn_rad(pose, other) / float(np.radians(EXPECTED_TURN_SD_DEG))) ** 2


def _turned_over(
    better: Rigid[Camera, Marker], worse: Rigid[Camera, Marker], expected: Rigid[Camera, Marker]
) -> bool:
    """Whether the better pose is one that no hand reaches from the expected one, and the worse is at hand."""
    is_far = _turn_rad(better, expected) > np.radians(FAR_TURN_DEG)
    return bool(is_far and _turn_rad(worse, expected) < np.radians(NEAR_TURN_DEG))


def difference(a: Rigid[Camera, Marker], b: Rigid[Camera, Marker]) -> Array:
    """What takes pose `a` to pose `b`, in the coordinates of the covariance."""
    return np.concatenate(
        [b.translation_mm - a.translation_mm, vector_from_rotation(b.rotation @ a.rotation.T)]
    )
