"""A plate with divots at known positions, the reference of an accuracy test."""

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from tracker.errors import InvalidInput
from tracker.geometry import Array

MIN_DIVOTS = 4
# Two divots nearer to each other cannot be told apart by a wrong tip.
MIN_DISTANCE_MM = 5.0
# A tip held in a divot or on a printed cross rests this far from its centre, as a standard deviation.
PRINTED_SD_MM = 0.2


@dataclass(frozen=True, slots=True, kw_only=True)
class DivotPlate:
    """Positions of named divots in the frame of their plate.

    Attributes:
        name: name of the plate.
        points_mm: position (3,) of each divot by name.
        sd_mm: standard deviation along each axis of a tip that rests in a divot, from its stated position:
            tolerance of the plate and play of the tip.

    Raises:
        InvalidInput: PLATE_INVALID.
    """

    name: str
    points_mm: Mapping[str, tuple[float, float, float]]
    sd_mm: float = PRINTED_SD_MM

    def __post_init__(self) -> None:
        points = np.array(list(self.points_mm.values()), dtype=np.float64).reshape(-1, 3)
        count, nearest_mm = len(points), self.min_distance_mm
        problem = ""
        if not (np.isfinite(points).all() and np.isfinite(self.sd_mm) and self.sd_mm >= 0.0):
            problem = "a number is not finite or negative"
        elif count < MIN_DIVOTS:
            problem = f"it has {count} divots, needed {MIN_DIVOTS}"
        elif nearest_mm < MIN_DISTANCE_MM:
            problem = f"two divots are {nearest_mm:.1f} mm apart, needed {MIN_DISTANCE_MM:g} mm"
        elif np.linalg.svd(points - points.mean(axis=0), compute_uv=False)[1] < MIN_DISTANCE_MM:
            problem = "its divots are on one line"
        if problem:
            raise InvalidInput(
                "PLATE_INVALID",
                f"the plate '{self.name[:40]}' cannot be used: {problem}",
                "Give the position of each divot in mm, as measured or printed.",
                {
                    "plate": self.name[:40],
                    "plate_problem": problem,
                    "divots": count,
                    "needed": MIN_DIVOTS,
                    "nearest_mm": nearest_mm,
                    "needed_mm": MIN_DISTANCE_MM,
                },
            )

    @property
    def min_distance_mm(self) -> float:
        """Return the distance of the two nearest divots; infinity for fewer than two."""
        return float(self._distances_mm.min(initial=np.inf))

    @property
    def max_distance_mm(self) -> float:
        """Return the distance of the two farthest divots."""
        return float(self._distances_mm.max(initial=0.0))

    @property
    def _distances_mm(self) -> Array:
        points = np.array(list(self.points_mm.values()), dtype=np.float64).reshape(-1, 3)
        between = np.linalg.norm(points[:, None] - points[None], axis=2)
        return np.asarray(between[np.triu_indices(len(points), 1)])

    def spread(self, count: int) -> tuple[str, ...]:
        """Return up to `count` divots far from each other (farthest point sampling), in the plate's order."""
        names, points = list(self.points_mm), np.array(list(self.points_mm.values()), dtype=np.float64)
        nearest_mm = np.linalg.norm(points - points.mean(axis=0), axis=1)
        chosen: list[int] = []
        for _ in range(min(count, len(names))):
            farthest = int(nearest_mm.argmax())
            distances_mm = np.linalg.norm(points - points[farthest], axis=1)
            nearest_mm = np.minimum(nearest_mm, distances_mm) if chosen else distances_mm
            chosen.append(farthest)
        return tuple(names[one] for one in sorted(chosen))

    def points_of(self, names: list[str]) -> Array:
        """Return the positions (n, 3) of divots by name.

        Raises:
            InvalidInput: DIVOT_UNKNOWN.
        """
        for name in names:
            if name not in self.points_mm:
                raise InvalidInput(
                    "DIVOT_UNKNOWN",
                    f"the plate '{self.name[:40]}' has no divot '{name[:20]}'",
                    f"Name one of its divots: {', '.join(self.points_mm)[:200]}.",
                    {
                        "divot": name[:20],
                        "plate": self.name[:40],
                        "divots": ", ".join(self.points_mm)[:200],
                    },
                )
        return np.array([self.points_mm[name] for name in names], dtype=np.float64)

    def scaled(self, x_ratio: float, y_ratio: float) -> "DivotPlate":
        """Return the plate whose printed rulers measure these ratios of their length along x and y."""
        points = {name: (x * x_ratio, y * y_ratio, z) for name, (x, y, z) in self.points_mm.items()}
        return DivotPlate(name=self.name, points_mm=points, sd_mm=self.sd_mm)
