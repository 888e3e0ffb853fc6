"""The screw catalogue."""

from dataclasses import dataclass

import numpy as np

from tracker.errors import PlanError


@dataclass(frozen=True, slots=True, kw_only=True)
class ScrewCatalogue:
    """Available diameters and lengths; every diameter is available in every length.

    Attributes:
        diameters_mm: available diameters, ascending.
        lengths_mm: available lengths, ascending.

    Raises:
        PlanError: CATALOGUE_INVALID, a list is empty or a number is not above 0.
    """

    diameters_mm: tuple[float, ...]
    lengths_mm: tuple[float, ...]

    def __post_init__(self) -> None:
        for name in ("diameters_mm", "lengths_mm"):
            values = tuple(sorted(float(value) for value in getattr(self, name)))
            if not values or not all(np.isfinite(value) and 0.0 < value < 200.0 for value in values):
                raise PlanError(
                    "CATALOGUE_INVALID",
                    f"the screw catalogue's {name} are {list(values)}, "
                    "needed one or more between 0 and 200 mm",
                    "Correct plan.screw_diameters_mm and plan.screw_lengths_mm in the config.",
                    {"setting": name, "values": str(list(values))},
                )
            object.__setattr__(self, name, values)


USUAL_CATALOGUE = ScrewCatalogue(
    diameters_mm=(4.0, 4.5, 5.0, 5.5, 6.0, 6.5, 7.0, 7.5, 8.5),
    lengths_mm=(25.0, 30.0, 35.0, 40.0, 45.0, 50.0, 55.0, 60.0),
)
