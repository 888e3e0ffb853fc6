"""Probability and depth of a breach, given the pose covariance of the drill.

Line sampling with sixteen lines of seven nodes agrees within 0.03 with Monte Carlo simulation of thousands of
drills, where a linearised clearance has an error of 0.07. Fixed samples make the result deterministic.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise

import numpy as np
import scipy

from tracker.geometry import Array, Tool, Vertebra
from tracker.navigation.clearance import Rings, WallDistanceField
from tracker.navigation.clearance.distance_field import UNIT_MM
from tracker.navigation.uncertainty.probability_kernels import (
    breach_probability,
    min_clearance_along_lines,
    rank_contacts,
)
from tracker.navigation.uncertainty.uncertain_pose import UncertainPose
from tracker.plan.screw import GertzbeinRobbins

# Clearances at which the Gertzbein-Robbins grade increases.
GRADE_LIMITS_MM = -np.array([0.0, 2.0, 4.0, 6.0])
# Number of contact points per direction around the drill.
CONTACTS_PER_DIRECTION = 2
LINES = 16
OFFSETS_SD = np.array([-3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0])
# Six dimensions of the pose, and one of the wall's position.
DIMENSIONS = 7
# Beyond this Mahalanobis distance of all points the probability counts as 0.
MAX_MAHALANOBIS = 7.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Probability:
    """Breach probabilities, 0 to 1, from the uncertainty of drill and wall.

    Attributes:
        through_ratio: any part of the cylinder is through the wall.
        grade_ratio: of each Gertzbein-Robbins grade; they sum to 1.
        sd_mm: standard deviation of the clearance at the most probable contact point; 0 if nothing is in
            bone.
    """

    through_ratio: float
    grade_ratio: Mapping[GertzbeinRobbins, float]
    sd_mm: float


def probability_of_breach(
    rings: Rings, wall: WallDistanceField, tool: UncertainPose[Vertebra, Tool], *, wall_sd_mm: float = 0.0
) -> Probability:
    """Estimate the probability of a breach by depth, by line sampling.

    The drill is displaced according to its covariance along lines: each runs in the direction in which the
    most probable contact point approaches the wall and is integrated from the distance field at seven nodes;
    perpendicular to it a fixed low-discrepancy sequence is used. No random numbers.

    Args:
        rings: sample points of the cylinder at its nominal pose.
        wall: distance field they were evaluated in.
        tool: pose of the drill with its covariance.
        wall_sd_mm: standard deviation of the wall's position, common to all of it.
    """
    if not rings.counts:
        return _probability(np.zeros(len(GRADE_LIMITS_MM)), 0.0)
    root = _root(tool.covariance)
    tip, direction = tool.pose.translation_mm, np.ascontiguousarray(tool.pose.rotation[:, 2])
    directions = rings.points_mm.shape[1]
    mahalanobis, chosen = (
        np.empty((CONTACTS_PER_DIRECTION, directions)),
        np.empty((CONTACTS_PER_DIRECTION, directions), np.int64),
    )
    slopes = np.zeros(DIMENSIONS)
    sd = rank_contacts(
        rings.points_mm,
        rings.clearance_mm,
        rings.gradient,
        tip,
        direction,
        root,
        float(wall_sd_mm),
        mahalanobis,
        chosen,
        slopes,
    )
    if sd < 1e-6:
        return _probability((rings.clearance_mm.min() < GRADE_LIMITS_MM).astype(np.float64), 0.0)
    below = np.zeros(len(GRADE_LIMITS_MM))
    valid = np.isfinite(mahalanobis)
    if mahalanobis[valid].min() < MAX_MAHALANOBIS:
        # The deepest points determine the depth of the breach.
        deepest = rings.points_mm[rings.clearance_mm.argmin(axis=0), np.arange(directions)][valid[0]]
        arms = np.concatenate([rings.points_mm[chosen[valid], np.nonzero(valid)[1]], deepest]) - tip
        min_clearance = np.empty((LINES, len(OFFSETS_SD)))
        min_clearance_along_lines(
            wall.values,
            UNIT_MM,
            wall.grid.step_mm,
            wall.grid.origin_mm,
            arms,
            tip,
            direction,
            root,
            slopes / sd,
            float(wall_sd_mm),
            _samples(),
            OFFSETS_SD,
            min_clearance,
        )
        breach_probability(min_clearance, OFFSETS_SD, GRADE_LIMITS_MM, below)
    return _probability(below, sd)


def past_planned_ratio(past_mm: float, sd_depth_mm: float) -> float:
    """Return the probability that the tip is past the planned depth."""
    if sd_depth_mm < 1e-9:
        return float(past_mm > 0.0)
    return float(scipy.special.ndtr(past_mm / sd_depth_mm))


def _root(covariance: Array) -> Array:
    """Return a square root (6, 6) of a covariance, which may be singular."""
    values, vectors = np.linalg.eigh(covariance)
    return np.ascontiguousarray(vectors * np.sqrt(np.maximum(values, 0.0)))


def _probability(below: Array, sd_mm: float) -> Probability:
    edges = [1.0, *np.minimum.accumulate(below).tolist(), 0.0]
    grades = {grade: max(a - b, 0.0) for grade, (a, b) in zip(GertzbeinRobbins, pairwise(edges), strict=True)}
    return Probability(through_ratio=float(below[0]), grade_ratio=grades, sd_mm=float(sd_mm))


@lru_cache(maxsize=1)
def _samples() -> Array:
    """Return antithetic normal samples (s, 7) of low discrepancy (Roberts' sequence)."""
    root = 2.0
    for _ in range(60):
        root = (1.0 + root) ** (1.0 / (DIMENSIONS + 1))
    steps = root ** -np.arange(1.0, DIMENSIONS + 1)
    even = (0.5 + np.outer(np.arange(1.0, LINES // 2 + 1), steps)) % 1.0
    half = scipy.special.ndtri(even)
    # Rescale to unit variance, because there are few samples.
    half /= np.sqrt((half**2).mean(axis=0))
    samples = np.concatenate([half, -half])
    samples.setflags(write=False)
    return np.asarray(samples)
