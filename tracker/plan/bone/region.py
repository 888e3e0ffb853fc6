"""The region of interest: an axis-aligned box in LPS mm."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.errors import PlanError
from tracker.geometry import Array
from tracker.plan.volume import Volume

# A vertebra with its processes lies within this distance of a point in its canal.
VERTEBRA_REACH_MM = 55.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Region:
    """An axis-aligned box in the patient frame.

    Attributes:
        low_lps_mm: (3,), the corner with the smallest coordinates.
        high_lps_mm: (3,), the opposite one.

    Raises:
        PlanError: REGION_INVALID, a corner is not finite, or a side is not longer than 0 mm.
    """

    low_lps_mm: Array
    high_lps_mm: Array

    def __post_init__(self) -> None:
        for name in ("low_lps_mm", "high_lps_mm"):
            corner = np.array(getattr(self, name), dtype=np.float64).reshape(-1)
            corner.setflags(write=False)
            object.__setattr__(self, name, corner)
        low, high = self.low_lps_mm, self.high_lps_mm
        if (
            low.shape != (3,)
            or high.shape != (3,)
            or not np.isfinite([low, high]).all()
            or (high <= low).any()
        ):
            raise PlanError(
                "REGION_INVALID",
                f"the region from {_formatted(low)} to {_formatted(high)} mm is not a box, "
                "each side must be above 0 mm",
                "Give the corner with the smallest left, posterior and superior coordinates first.",
                {
                    "low_lps_mm": low.tolist(),
                    "high_lps_mm": high.tolist(),
                    "low": _formatted(low),
                    "high": _formatted(high),
                },
            )

    @classmethod
    def between(cls, low_lps_mm: npt.ArrayLike, high_lps_mm: npt.ArrayLike) -> "Region":
        """Return the box between two corners. Raises as the class."""
        return cls(low_lps_mm=np.asarray(low_lps_mm), high_lps_mm=np.asarray(high_lps_mm))

    @classmethod
    def around(cls, points_lps_mm: npt.ArrayLike, *, reach_mm: float = VERTEBRA_REACH_MM) -> "Region":
        """Return the bounding box of points (n, 3), enlarged by a margin along the axes.

        Raises:
            PlanError: REGION_INVALID, there is no point, or it is not finite.
        """
        points = np.asarray(points_lps_mm, dtype=np.float64).reshape(-1, 3)
        if points.shape[0] == 0:
            points = np.full((1, 3), np.nan)
        return cls(low_lps_mm=points.min(axis=0) - reach_mm, high_lps_mm=points.max(axis=0) + reach_mm)

    def contains(self, points_lps_mm: npt.ArrayLike) -> npt.NDArray[np.bool_]:
        """Return which points (..., 3) lie in the box: (...) bool."""
        points = np.asarray(points_lps_mm, dtype=np.float64)
        return np.asarray(((points >= self.low_lps_mm) & (points <= self.high_lps_mm)).all(axis=-1))

    def indexes_in(self, volume: Volume) -> tuple[npt.NDArray[np.int64], npt.NDArray[np.int64]]:
        """Return first and past-the-last index (i, j, k) of the voxels in the box, clipped to the volume.

        Raises:
            PlanError: REGION_OUTSIDE, no two voxels along each axis lie in it.
        """
        steps = np.stack(np.meshgrid([0, 1], [0, 1], [0, 1], indexing="ij"), axis=-1).reshape(-1, 3)
        corners = volume.index_from_lps(self.low_lps_mm + steps * (self.high_lps_mm - self.low_lps_mm))
        size = np.array(volume.shape_ijk)
        first = np.clip(np.floor(corners.min(axis=0)) - 1, 0, size).astype(np.int64)
        last = np.clip(np.ceil(corners.max(axis=0)) + 2, 0, size).astype(np.int64)
        if (last - first < 2).any():
            ends = np.stack(np.meshgrid(*[[0, n - 1] for n in size], indexing="ij"), axis=-1).reshape(-1, 3)
            extent = volume.lps_from_index(ends)
            raise PlanError(
                "REGION_OUTSIDE",
                f"the region from {_formatted(self.low_lps_mm)} to {_formatted(self.high_lps_mm)} mm lies "
                f"outside of the CT, which reaches from {_formatted(extent.min(axis=0))} to "
                f"{_formatted(extent.max(axis=0))} mm",
                "Give a region inside of the CT, in its own coordinates (LPS).",
                {
                    "low_lps_mm": self.low_lps_mm.tolist(),
                    "high_lps_mm": self.high_lps_mm.tolist(),
                    "low": _formatted(self.low_lps_mm),
                    "high": _formatted(self.high_lps_mm),
                    "ct_low": _formatted(extent.min(axis=0)),
                    "ct_high": _formatted(extent.max(axis=0)),
                },
            )
        return first, last


def _formatted(point: Array) -> str:
    return "(" + ", ".join(f"{value:.1f}" for value in np.ravel(point)) + ")"
