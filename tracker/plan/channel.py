"""The planned channel through the pedicle."""

from dataclasses import dataclass

import numpy as np

from tracker.errors import PlanError
from tracker.geometry import Array


@dataclass(frozen=True, slots=True, kw_only=True)
class Channel:
    """A cylinder from the entry point on the bone to the target in the vertebral body.

    As in the paper (2.1), its diameter is the minimum width of the pedicle.

    Attributes:
        name: display name ("L3 left").
        entry_in_vertebra_mm: (3,), on the bone's surface.
        target_in_vertebra_mm: (3,), the planned end of the drilling.
        radius_mm: radius of the cylinder.

    Raises:
        PlanError: CHANNEL_INVALID, entry and target are nearer than 1 mm, or the radius is not above 0.
    """

    name: str
    entry_in_vertebra_mm: Array
    target_in_vertebra_mm: Array
    radius_mm: float

    def __post_init__(self) -> None:
        for name in ("entry_in_vertebra_mm", "target_in_vertebra_mm"):
            point = np.array(getattr(self, name), dtype=np.float64).reshape(3)
            point.setflags(write=False)
            object.__setattr__(self, name, point)
        length = float(np.linalg.norm(self.target_in_vertebra_mm - self.entry_in_vertebra_mm))
        if not (length >= 1.0 and self.radius_mm > 0.0):
            raise PlanError(
                "CHANNEL_INVALID",
                f"channel '{self.name}' is {length:.2f} mm long with radius {self.radius_mm:.2f} mm, "
                "needed at least 1 mm and above 0 mm",
                "Set entry point, target and diameter of the channel again.",
                {"length_mm": length, "radius_mm": self.radius_mm, "channel": self.name},
            )

    @property
    def length_mm(self) -> float:
        """Return the distance from entry point to target."""
        return float(np.linalg.norm(self.target_in_vertebra_mm - self.entry_in_vertebra_mm))

    @property
    def axis_in_vertebra(self) -> Array:
        """Return the unit direction (3,) of drilling."""
        return (self.target_in_vertebra_mm - self.entry_in_vertebra_mm) / self.length_mm
