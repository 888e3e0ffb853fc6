"""Which directions a registration by needles knows from the image, and which only from what was measured."""

from dataclasses import dataclass

import numpy as np

from tracker.geometry import Array
from tracker.registration.needles.solutions import Solution

# From here on a direction is called weak: most of what is known of it does not come from the image.
WEAK_RATIO = 0.5


@dataclass(frozen=True, slots=True, kw_only=True)
class Direction:
    """How well the needles' middle is known in one direction, or the vertebra about one axis.

    Attributes:
        name: in words.
        sd: standard deviation, in `unit`.
        unit: `mm` of a shift, `deg` of a turn.
        not_from_image_ratio: share of what is known of it that ruler and touched points gave.
    """

    name: str
    sd: float
    unit: str
    not_from_image_ratio: float

    @property
    def is_weak(self) -> bool:
        """Whether the image alone hardly shows it."""
        return self.not_from_image_ratio > WEAK_RATIO


@dataclass(frozen=True, slots=True, kw_only=True)
class Sureness:
    """Standard deviations at the middle of the needles, in the directions of the view.

    Attributes:
        depth: along the line of sight.
        across: across it, in the worse of the two directions.
        tilt: out of the image's plane, about the worse of the two axes in it.
        turn: about the line of sight.
    """

    depth: Direction
    across: Direction
    tilt: Direction
    turn: Direction

    @property
    def weak(self) -> tuple[Direction, ...]:
        """What the image hardly shows."""
        return tuple(one for one in (self.depth, self.across, self.tilt, self.turn) if one.is_weak)

    @property
    def sentence(self) -> str:
        """What a surgeon should know of it."""
        known = [_told(one) for one in (self.depth, self.across, self.tilt, self.turn) if not one.is_weak]
        weak = [
            f"{_told(one)} ({one.not_from_image_ratio:.0%} of it from ruler and touch)" for one in self.weak
        ]
        shown = f"the image shows {', '.join(known)}" if known else "the image alone shows no direction"
        left = f"it hardly shows {', '.join(weak)}" if weak else "no direction is left to the ruler"
        return f"{shown}; {left}"


def sureness_of(solution: Solution) -> Sureness:
    """Spreads of a solution along and across its line of sight (one standard deviation)."""
    equations, covariance = solution.equations, solution.covariance
    task = equations.task
    middle = solution.pose.move_points(task.middle_mm)
    sight = middle / np.linalg.norm(middle)
    beside = np.linalg.svd(sight[None])[2][1:]
    slopes = equations.slopes(solution.pose)
    touched = 3 * len(task.view.touched)
    elsewhere = np.concatenate([slopes[:4], slopes[len(slopes) - touched :]])
    known, measured = np.linalg.inv(covariance), elsewhere.T @ elsewhere
    shift, turn = covariance[:3, :3], covariance[3:, 3:]

    def direction(name: str, way: Array, *, is_turn: bool) -> Direction:
        along = np.concatenate([np.zeros(3), way] if is_turn else [way, np.zeros(3)])
        sd = float(np.sqrt(along @ covariance @ along))
        return Direction(
            name=name,
            sd=float(np.degrees(sd)) if is_turn else sd,
            unit="deg" if is_turn else "mm",
            not_from_image_ratio=min(1.0, float((along @ measured @ along) / (along @ known @ along))),
        )

    return Sureness(
        depth=direction("depth along the view", sight, is_turn=False),
        across=direction("place across the view", _widest(shift, beside), is_turn=False),
        tilt=direction("tilt out of the image", _widest(turn, beside), is_turn=True),
        turn=direction("turn in the image", sight, is_turn=True),
    )


def _widest(covariance: Array, ways: Array) -> Array:
    """The direction among `ways` (2, 3) in which a covariance (3, 3) is widest."""
    _, axes = np.linalg.eigh(ways @ covariance @ ways.T)
    return np.asarray(axes[:, -1] @ ways)


def _told(one: Direction) -> str:
    return f"{one.name} ±{one.sd:.1f} {one.unit}"
