"""Known displacements in millimetres, and the pixels of their ends."""

from dataclasses import dataclass

import numpy as np

from tracker.errors import InvalidInput
from tracker.geometry import Array


@dataclass(frozen=True, slots=True, kw_only=True)
class Displacements:
    """Rows of the paper's Table 2: from one point of a plane to another, in mm and in px.

    Attributes:
        first_mm: (n, 2) X1, Y1 on the plane.
        second_mm: (n, 2) X2, Y2 on the plane.
        first_px: (n, 2) X1, Y1 in the image.
        second_px: (n, 2) X2, Y2 in the image.

    Raises:
        InvalidInput: DISPLACEMENTS_INVALID, there is none, shapes differ, a number is not finite, or one is
            0 mm long.
    """

    first_mm: Array
    second_mm: Array
    first_px: Array
    second_px: Array

    def __post_init__(self) -> None:
        for name in ("first_mm", "second_mm", "first_px", "second_px"):
            points = np.array(getattr(self, name), dtype=np.float64, order="C")
            points.setflags(write=False)
            object.__setattr__(self, name, points)
        problem = self._problem()
        if problem:
            raise InvalidInput(
                "DISPLACEMENTS_INVALID",
                f"the displacements cannot be used: {problem}",
                "Give the two ends of each displacement, in mm on the plane and in px in the image.",
                {"displacement_problem": problem},
            )

    @property
    def points_mm(self) -> Array:
        """Return all ends (2 n, 2) in mm."""
        return np.concatenate([self.first_mm, self.second_mm])

    @property
    def points_px(self) -> Array:
        """Return all ends (2 n, 2) in px, in the same order."""
        return np.concatenate([self.first_px, self.second_px])

    def _problem(self) -> str:
        shapes = {part.shape for part in (self.first_mm, self.second_mm, self.first_px, self.second_px)}
        shape = next(iter(shapes))
        if len(shapes) > 1 or len(shape) != 2 or shape[1] != 2:
            return f"their shapes are {sorted(shapes)}, needed (n, 2) alike"
        if shape[0] == 0:
            return "there is none"
        if not (np.isfinite(self.points_mm).all() and np.isfinite(self.points_px).all()):
            return "a coordinate is not finite"
        still = np.flatnonzero(np.linalg.norm(self.first_mm - self.second_mm, axis=1) <= 0.0)
        return f"number {int(still[0]) + 1} is 0 mm long" if still.size else ""
