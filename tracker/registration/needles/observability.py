"""Observability of a registration by direction: from the image, or only from ruler and touch."""

from dataclasses import dataclass

import numpy as np

from tracker.geometry import Array
from tracker.registration.needles.pose_solver import Solution

# A direction is weak if more than this ratio of its information is not from the image.
WEAK_RATIO = 0.5


@dataclass(frozen=True, slots=True, kw_only=True)
class DirectionUncertainty:
    """Uncertainty of the needles' centroid in one direction, or of the vertebra about one axis.

    Attributes:
        name: as text.
        sd: standard deviation, in `unit`.
        unit: `mm` of a shift, `deg` of a rotation.
        not_from_image_ratio: share of the information from ruler and touched points.
    """

    name: str
    sd: float
    unit: str
    not_from_image_ratio: float

    @property
    def is_weak(self) -> bool:
        """Return whether most of the information is not from the image."""
        return self.not_from_image_ratio > WEAK_RATIO


@dataclass(frozen=True, slots=True, kw_only=True)
class PoseObservability:
    """Standard deviations at the needles' centroid, in the directions of the view.

    Attributes:
        depth: along the line of sight.
        across: perpendicular to it, in the worse of two directions.
        tilt: out of the image plane, about the worse of two axes.
        turn: about the line of sight.
    """

    depth: DirectionUncertainty
    across: DirectionUncertainty
    tilt: DirectionUncertainty
    turn: DirectionUncertainty

    @property
    def weak(self) -> tuple[DirectionUncertainty, ...]:
        """Return the directions that the image hardly determines."""
        return tuple(one for one in (self.depth, self.across, self.tilt, self.turn) if one.is_weak)

    @property
    def summary(self) -> str:
        """Return a summary for a surgeon."""
        known = [_text(one) for one in (self.depth, self.across, self.tilt, self.turn) if not one.is_weak]
        weak = [
            f"{_text(one)} ({one.not_from_image_ratio:.0%} of it from ruler and touch)" for one in self.weak
        ]
        shown = f"the image shows {', '.join(known)}" if known else "the image alone shows no direction"
        left = f"it hardly shows {', '.join(weak)}" if weak else "no direction is left to the ruler"
        return f"{shown}; {left}"


def pose_observability(solution: Solution) -> PoseObservability:
    """Return the standard deviations of a solution along and across its line of sight."""
    residual_model, covariance = solution.residual_model, solution.covariance
    task = residual_model.task
    middle = solution.pose.move_points(task.middle_mm)
    sight = middle / np.linalg.norm(middle)
    beside = np.linalg.svd(sight[None])[2][1:]
    jacobian = residual_model.jacobian(solution.pose)
    touched = 3 * len(task.view.touched)
    elsewhere = np.concatenate([jacobian[:4], jacobian[len(jacobian) - touched :]])
    known, measured = np.linalg.inv(covariance), elsewhere.T @ elsewhere
    shift, turn = covariance[:3, :3], covariance[3:, 3:]

    def direction(name: str, vector: Array, *, is_turn: bool) -> DirectionUncertainty:
        along = np.concatenate([np.zeros(3), vector] if is_turn else [vector, np.zeros(3)])
        sd = float(np.sqrt(along @ covariance @ along))
        return DirectionUncertainty(
            name=name,
            sd=float(np.degrees(sd)) if is_turn else sd,
            unit="deg" if is_turn else "mm",
            not_from_image_ratio=min(1.0, float((along @ measured @ along) / (along @ known @ along))),
        )

    return PoseObservability(
        depth=direction("depth along the view", sight, is_turn=False),
        across=direction("place across the view", _widest(shift, beside), is_turn=False),
        tilt=direction("tilt out of the image", _widest(turn, beside), is_turn=True),
        turn=direction("turn in the image", sight, is_turn=True),
    )


def _widest(covariance: Array, vectors: Array) -> Array:
    """Return the direction of largest variance of a covariance (3, 3) within the span of `vectors` (2, 3)."""
    _, axes = np.linalg.eigh(vectors @ covariance @ vectors.T)
    return np.asarray(axes[:, -1] @ vectors)


def _text(one: DirectionUncertainty) -> str:
    return f"{one.name} ±{one.sd:.1f} {one.unit}"
