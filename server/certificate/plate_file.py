"""Plate files: names and positions of divots, and how the true size of the plate is known."""

from typing import Annotated, Literal

import yaml
from pydantic import Field

from server.config import Point, Section
from tracker.accuracy import DivotPlate, PlateScale
from tracker.errors import InvalidInput

RULERS_REMEDY = "Give the measured lengths of the rulers across and down the page in mm."
DivotName = Annotated[str, Field(min_length=1, max_length=20)]


class PlateFile(Section):
    """A plate: printed with rulers whose true length is to be measured, or measured by its maker."""

    kind: Literal["coaxial accuracy plate"] = "coaxial accuracy plate"
    name: Annotated[str, Field(min_length=1, max_length=40)]
    sd_mm: Annotated[float, Field(ge=0.0, le=2.0)]
    """Standard deviation of a tip in a divot from the stated position, along each axis."""
    rulers_mm: Annotated[float, Field(gt=0.0, le=1000.0)] | None = None
    """Stated length of the two printed rulers; None for a plate whose divots were measured."""
    divots: Annotated[dict[DivotName, Point], Field(max_length=100)]

    def plate(self) -> DivotPlate:
        """Return the plate as it is stated.

        Raises:
            InvalidInput: PLATE_INVALID.
        """
        points = {name: (x, y, z) for name, (x, y, z) in self.divots.items()}
        return DivotPlate(name=self.name, points_mm=points, sd_mm=self.sd_mm)

    def scale(self, measured_mm: tuple[float, float] | None, *, sd_mm: float) -> PlateScale | None:
        """Return the true scale; None for a printed plate whose rulers nobody measured.

        Args:
            measured_mm: True lengths of the rulers along x and y.
            sd_mm: Standard deviation of these lengths.

        Raises:
            InvalidInput: PLATE_RULERS_INVALID, lengths of other rulers, or for a plate without rulers;
                PLATE_INVALID.
        """
        if self.rulers_mm is None:
            if measured_mm is not None:
                raise InvalidInput(
                    "PLATE_RULERS_INVALID",
                    f"the plate '{self.name}' has no rulers",
                    "Give no lengths of rulers for a plate whose divots were measured.",
                    {"plate": self.name},
                )
            # Of their distances and not of their coordinates: the origin may be anywhere.
            return PlateScale(x_ratio=1.0, y_ratio=1.0, sd_ratio=self.sd_mm / self.plate().max_distance_mm)
        if measured_mm is None:
            return None
        x, y = (value / self.rulers_mm for value in measured_mm)
        # A ruler read in cm or inches is no print scale.
        if not (0.8 <= x <= 1.25 and 0.8 <= y <= 1.25 and sd_mm > 0.0):
            raise InvalidInput(
                "PLATE_RULERS_INVALID",
                f"rulers of {self.rulers_mm:g} mm cannot have {measured_mm[0]:g} and {measured_mm[1]:g} mm",
                RULERS_REMEDY,
                {"rulers_mm": self.rulers_mm, "x_mm": measured_mm[0], "y_mm": measured_mm[1]},
            )
        return PlateScale(x_ratio=x, y_ratio=y, sd_ratio=sd_mm / self.rulers_mm)


def text_of_plate_file(plate: PlateFile) -> str:
    """Return the text of a plate file."""
    values = plate.model_dump(mode="python", exclude_none=True)
    return "# Written by coaxial; mm, x right, y down, z into the plate.\n" + yaml.safe_dump(
        values, sort_keys=False, default_flow_style=None, width=100
    )
