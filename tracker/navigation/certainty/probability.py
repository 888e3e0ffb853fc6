"""How probable it is that the drill is through the wall, and how far.

Sixteen lines of seven places agree within 0.03 with thousands of random drills, where a linearised
clearance was off by 0.07, and do not flicker from image to image.
"""

from collections.abc import Mapping
from dataclasses import dataclass
from functools import lru_cache
from itertools import pairwise

import numpy as np
from scipy.special import ndtr, ndtri

from tracker.geometry import Array, Tool, Vertebra
from tracker.navigation.certainty.kernels import first_places, min_along_lines, share_below
from tracker.navigation.certainty.placed import Placed
from tracker.navigation.clearance import Rings, WallField
from tracker.navigation.clearance.field import UNIT_MM
from tracker.plan.screw import GertzbeinRobbins

# Through the wall by more than this is a grade worse (Gertzbein and Robbins).
LIMITS_MM = -np.array([0.0, 2.0, 4.0, 6.0])
# Of each direction around the drill, the places that are through first.
PLACES = 2
LINES = 16
TURNS = np.array([-3.0, -2.0, -1.0, 0.0, 1.0, 2.0, 3.0])
# Six of the pose, and one in which the bone's surface errs.
DIMENSIONS = 7
# With all places further than so many standard deviations from the wall, nobody needs the probability.
SURELY = 7.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Probability:
    """Probabilities, 0 to 1, that follow from the uncertainty of the drill and of the wall.

    Attributes:
        through_ratio: any part of the cylinder is through the wall.
        grade_ratio: of each class of Gertzbein and Robbins; they sum to 1.
        sd_mm: standard deviation of the clearance at the place that is through most probably; 0 where
            nothing is in bone.
    """

    through_ratio: float
    grade_ratio: Mapping[GertzbeinRobbins, float]
    sd_mm: float


def probability_of_breach(
    rings: Rings, wall: WallField, tool: Placed[Vertebra, Tool], *, wall_sd_mm: float = 0.0
) -> Probability:
    """How probable a breach is, and how deep.

    The drill is moved as its covariance admits, along lines through all that is possible: each line runs in
    the direction in which the worst place moves towards the wall, and is integrated by what the field says
    at seven places of it; across it lie fixed samples that fill space evenly. No random numbers.

    Args:
        rings: the places of the cylinder that count, as they are shown.
        wall: the distances from which these are.
        tool: the drill with its covariance.
        wall_sd_mm: how far the wall itself may be from where the plan has it, all of it alike.
    """
    if not rings.counts:
        return _probability(np.zeros(len(LIMITS_MM)), 0.0)
    root = _root(tool.covariance)
    tip, direction = tool.pose.translation_mm, np.ascontiguousarray(tool.pose.rotation[:, 2])
    ways = rings.points_mm.shape[1]
    surprise, chosen = np.empty((PLACES, ways)), np.empty((PLACES, ways), np.int64)
    slopes = np.zeros(DIMENSIONS)
    sd = first_places(
        rings.points_mm,
        rings.clearance_mm,
        rings.gradient,
        tip,
        direction,
        root,
        float(wall_sd_mm),
        surprise,
        chosen,
        slopes,
    )
    if sd < 1e-6:
        return _probability((rings.clearance_mm.min() < LIMITS_MM).astype(np.float64), 0.0)
    below = np.zeros(len(LIMITS_MM))
    held = np.isfinite(surprise)
    if surprise[held].min() < SURELY:
        # The deepest too, which say how far it is through.
        deepest = rings.points_mm[rings.clearance_mm.argmin(axis=0), np.arange(ways)][held[0]]
        arms = np.concatenate([rings.points_mm[chosen[held], np.nonzero(held)[1]], deepest]) - tip
        least = np.empty((LINES, len(TURNS)))
        min_along_lines(
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
            TURNS,
            least,
        )
        share_below(least, TURNS, LIMITS_MM, below)
    return _probability(below, sd)


def past_planned_ratio(past_mm: float, sd_depth_mm: float) -> float:
    """How probable it is that the tip is past the planned depth."""
    if sd_depth_mm < 1e-9:
        return float(past_mm > 0.0)
    return float(ndtr(past_mm / sd_depth_mm))


def _root(covariance: Array) -> Array:
    """A matrix (6, 6) whose product with its transpose is the covariance, which may be flat."""
    values, vectors = np.linalg.eigh(covariance)
    return np.ascontiguousarray(vectors * np.sqrt(np.maximum(values, 0.0)))


def _probability(below: Array, sd_mm: float) -> Probability:
    edges = [1.0, *np.minimum.accumulate(below).tolist(), 0.0]
    grades = {grade: max(a - b, 0.0) for grade, (a, b) in zip(GertzbeinRobbins, pairwise(edges), strict=True)}
    return Probability(through_ratio=float(below[0]), grade_ratio=grades, sd_mm=float(sd_mm))


@lru_cache(maxsize=1)
def _samples() -> Array:
    """Normal samples (s, 7) that fill space evenly, each with its mirror image (Roberts' sequence)."""
    root = 2.0
    for _ in range(60):
        root = (1.0 + root) ** (1.0 / (DIMENSIONS + 1))
    steps = root ** -np.arange(1.0, DIMENSIONS + 1)
    even = (0.5 + np.outer(np.arange(1.0, LINES // 2 + 1), steps)) % 1.0
    half = ndtri(even)
    # As few as they are, they shall have the spread that normals have.
    half /= np.sqrt((half**2).mean(axis=0))
    samples = np.concatenate([half, -half])
    samples.setflags(write=False)
    return np.asarray(samples)
