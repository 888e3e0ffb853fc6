"""Plate files: names and positions of divots, and how the true size of the plate is known."""

from typing import Annotated, Literal

import yaml
from pydantic import Field, ValidationError

from server.config import Point, Section
from server.printing import Sheet, grid_of_divots, plate_sheet
from server.printing.plate_sheet import RULER_MM
from server.yaml_file import parsed_yaml
from tracker.accuracy import DivotPlate, PlateScale
from tracker.accuracy.plate import PRINTED_SD_MM
from tracker.errors import InvalidInput

REMEDY = "Write one with 'coaxial certify plate --output plate.pdf', or give name, sd_mm and divots."
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


def printed_plate(
    columns: int = 3,
    rows: int = 3,
    *,
    pitch_mm: float = 60.0,
    name: str = "A4-3x3",
    sd_mm: float = PRINTED_SD_MM,
) -> PlateFile:
    """Return a printed plate with rulers; by default the one that fits on A4.

    Raises:
        InvalidInput: PLATE_INVALID.
    """
    divots = grid_of_divots(columns, rows, pitch_mm)
    file = PlateFile(
        name=name[:40],
        sd_mm=sd_mm,
        rulers_mm=float(RULER_MM),
        divots={divot: list(point) for divot, point in divots.items()},
    )
    file.plate()
    return file


def printed_sheet(file: PlateFile, *, paper: str = "A4") -> Sheet:
    """Return the page of a printed plate.

    Raises:
        InvalidInput: PLATE_TOO_LARGE.
    """
    return plate_sheet(file.plate().points_mm, name=file.name, paper=paper)


def plate_file_in(text: str) -> PlateFile:
    """Return the plate of the text of a plate file, YAML or JSON.

    Raises:
        InvalidInput: PLATE_FILE_UNREADABLE or PLATE_FILE_INVALID.
    """
    try:
        values = parsed_yaml(text)
    except ValueError:
        raise InvalidInput(
            "PLATE_FILE_UNREADABLE", "the plate file is neither valid YAML nor JSON", REMEDY
        ) from None
    return plate_file_from(values)


def plate_file_from(values: object) -> PlateFile:
    """Return the plate of parsed YAML or JSON.

    Raises:
        InvalidInput: PLATE_FILE_INVALID.
    """
    if isinstance(values, dict) and isinstance(divots := values.get("divots"), dict):
        # YAML reads a name of digits, and a coordinate without a point, as an integer.
        values = {**values, "divots": {str(name): _floats(point) for name, point in divots.items()}}
    try:
        return PlateFile.model_validate(values)
    except ValidationError as error:
        first = error.errors(include_url=False)[0]
        key = ".".join(str(part)[:40] for part in first["loc"]) or "it"
        why = f"{key}: {first['msg'].lower()}"[:240]
        raise InvalidInput(
            "PLATE_FILE_INVALID", f"the plate file cannot be used: {why}", REMEDY, {"why": why}
        ) from None


def text_of_plate_file(plate: PlateFile) -> str:
    """Return the text of a plate file."""
    values = plate.model_dump(mode="python", exclude_none=True)
    return "# Written by coaxial; mm, x right, y down, z into the plate.\n" + yaml.safe_dump(
        values, sort_keys=False, default_flow_style=None, width=100
    )


def _floats(point: object) -> object:
    if not isinstance(point, list):
        return point
    return [float(one) if isinstance(one, int) and not isinstance(one, bool) else one for one in point]
