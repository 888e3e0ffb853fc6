"""Pairs of points: landmarks on the CT and the same landmarks as captured."""

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from tracker.errors import RegistrationError
from tracker.geometry import Array

PAIR_REMEDY = "Give each landmark of the plan and the tip on it as three numbers in mm, in the same order."


@dataclass(frozen=True, slots=True, kw_only=True)
class CommonTip:
    """The calibrated tip that all captures share, and its error.

    Attributes:
        tool: name of the tool.
        covariance_mm2: (3, 3) of the tip, in the marker frame.
        anchor_from_marker: (n, 3, 3), rotation of the marker at each capture.
    """

    tool: str
    covariance_mm2: Array
    anchor_from_marker: Array


@dataclass(frozen=True, slots=True, kw_only=True)
class PointPairs:
    """Landmarks marked on the CT and captured with the tip, in the same order.

    Attributes:
        fixed_mm: (n, 3), on the CT, LPS.
        moving_mm: (n, 3), captured tip positions, in the anchor frame.
        moving_covariances_mm2: (n, 3, 3) of those, in the anchor frame; None if not stated.
        common: the tip of all captures, whose covariance is then excluded from the others; None if unknown or
            not unique.
        labels: a name for each; "1", "2", ... by default.

    Raises:
        RegistrationError: POINTS_COUNTS_DIFFER, or POINTS_INVALID, a number is not finite or a shape wrong.
    """

    fixed_mm: Array
    moving_mm: Array
    moving_covariances_mm2: Array | None = None
    labels: tuple[str, ...] = ()
    common: CommonTip | None = None

    def __post_init__(self) -> None:
        fixed = _points(self.fixed_mm, "marked")
        moving = _points(self.moving_mm, "touched")
        if len(fixed) != len(moving):
            raise RegistrationError(
                "POINTS_COUNTS_DIFFER",
                f"{len(fixed)} points are marked on the CT and {len(moving)} were touched",
                PAIR_REMEDY,
                {"fixed": len(fixed), "moving": len(moving)},
            )
        labels = tuple(self.labels) or tuple(str(index + 1) for index in range(len(fixed)))
        if len(labels) != len(fixed) or len(set(labels)) != len(labels):
            raise RegistrationError(
                "POINTS_INVALID",
                f"{len(fixed)} points have {len(set(labels))} different names",
                "Give each landmark a unique name.",
                {"labels": len(fixed), "names": len(set(labels))},
            )
        object.__setattr__(self, "fixed_mm", fixed)
        object.__setattr__(self, "moving_mm", moving)
        object.__setattr__(self, "labels", labels)
        if self.moving_covariances_mm2 is not None:
            covariances = _covariances(self.moving_covariances_mm2, len(fixed))
            object.__setattr__(self, "moving_covariances_mm2", covariances)

    def __len__(self) -> int:
        return len(self.fixed_mm)

    def of(self, chosen: Sequence[int]) -> "PointPairs":
        """Return the pairs at these indices, in that order."""
        index = np.asarray(chosen, dtype=np.int64)
        covariances = self.moving_covariances_mm2
        return PointPairs(
            fixed_mm=self.fixed_mm[index],
            moving_mm=self.moving_mm[index],
            moving_covariances_mm2=None if covariances is None else covariances[index],
            labels=tuple(self.labels[one] for one in chosen),
            common=None
            if self.common is None
            else replace(self.common, anchor_from_marker=self.common.anchor_from_marker[index]),
        )


def _points(given: Array, which: str) -> Array:
    points = np.array(given, dtype=np.float64)
    if points.size == 0:
        points = points.reshape(0, 3)
    if points.ndim != 2 or points.shape[1] != 3:
        raise RegistrationError(
            "POINTS_INVALID",
            f"the points {which} have shape {points.shape}, needed (n, 3)",
            PAIR_REMEDY,
            {"points_where": which, "shape": str(points.shape)},
        )
    if not np.isfinite(points).all():
        wrong = int((~np.isfinite(points).all(axis=1)).sum())
        raise RegistrationError(
            "POINTS_INVALID",
            f"{wrong} of {len(points)} points {which} have a number that is not finite",
            PAIR_REMEDY,
            {"not_finite": wrong, "points": len(points), "points_where": which},
        )
    points.setflags(write=False)
    return points


def _covariances(given: Array, count: int) -> Array:
    covariances = np.array(given, dtype=np.float64)
    sound = covariances.shape == (count, 3, 3) and bool(np.isfinite(covariances).all())
    if sound:
        sound = bool((np.linalg.eigvalsh(covariances) >= -1e-9).all())
    if not sound:
        raise RegistrationError(
            "POINTS_INVALID",
            f"the covariances of {count} tips have shape {covariances.shape}, or are not positive definite",
            "Give a symmetric positive 3x3 matrix in mm^2 for each tip, or none at all.",
            {"tips": count, "shape": covariances.shape},
        )
    covariances = 0.5 * (covariances + covariances.transpose(0, 2, 1))
    covariances.setflags(write=False)
    return covariances
