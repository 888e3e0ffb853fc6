"""What is known of one pedicle: its numbers, how sure they are, and what must be said with them."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from tracker.errors import InvalidInput
from tracker.geometry import Array

Side = Literal["left", "right"]
SIDES: tuple[Side, ...] = ("left", "right")
# Of a pedicle, what is surely no wider than the isthmus.
MIN_AHEAD_MM = 3.0


@dataclass(frozen=True, slots=True, kw_only=True)
class PedicleSpread:
    """Standard deviation of each number: of the fit, and of what else there would have done as well."""

    width_mm: float
    height_mm: float
    transverse_deg: float
    sagittal_deg: float
    length_mm: float
    isthmus_mm: float


@dataclass(frozen=True, slots=True, kw_only=True)
class PedicleMeasure:
    """One pedicle, measured at its isthmus: the narrowest section across its own axis.

    Angles stand against the patient's axes (LPS) as they show on an axial and on a sagittal slice, not
    against the vertebra's own endplates.

    Attributes:
        side: the patient's left or right.
        width_mm: outer width of the section, in the direction nearest to the patient's left-right.
        height_mm: outer height of the section, across the width.
        transverse_deg: angle of the axis from straight forwards in the axial plane, positive where it runs
            to the middle.
        sagittal_deg: angle of the axis from straight forwards in the sagittal plane, positive where it runs
            to the head.
        length_mm: along the axis from the entry to the outer side of the body's front wall; a screw keeps
            its own margin before that.
        isthmus_lps_mm: (3,), centre of the section.
        axis_lps: unit (3,), forwards.
        entry_lps_mm: (3,), where the axis enters the arch from behind; of a process that it runs through
            lengthwise, the base.
        front_lps_mm: (3,), where it leaves the body in front.
        outline_lps_mm: (n, 3), the section's outer wall.
        seed_lps_mm: (3,), the click.
        cortex_mm: mean thickness of the wall, where voxels are fine enough to tell.
        sd: standard deviations.
        opens_ahead_mm: how far in front of the isthmus the pedicle opens into the body.
        warnings: sentences that belong to these numbers.
    """

    side: Side
    width_mm: float
    height_mm: float
    transverse_deg: float
    sagittal_deg: float
    length_mm: float
    isthmus_lps_mm: Array
    axis_lps: Array
    entry_lps_mm: Array
    front_lps_mm: Array
    outline_lps_mm: Array
    seed_lps_mm: Array
    cortex_mm: float
    sd: PedicleSpread
    opens_ahead_mm: float = MIN_AHEAD_MM
    warnings: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        for name in _ARRAYS:
            array = np.array(getattr(self, name), dtype=np.float64)
            array.setflags(write=False)
            object.__setattr__(self, name, array)


_ARRAYS = (
    "isthmus_lps_mm",
    "axis_lps",
    "entry_lps_mm",
    "front_lps_mm",
    "outline_lps_mm",
    "seed_lps_mm",
)


def checked_side(side: str) -> Side:
    """The side by its name.

    Raises:
        InvalidInput: SIDE_INVALID.
    """
    if side == "left":
        return "left"
    if side == "right":
        return "right"
    raise InvalidInput(
        "SIDE_INVALID",
        f"side is '{side}', allowed are left and right",
        "Name the patient's side.",
        {"side": side},
    )


def transverse_deg_of(axis_lps: Array, side: Side) -> float:
    """Angle from straight forwards on an axial slice, positive to the middle."""
    medial = -axis_lps[0] if side == "left" else axis_lps[0]
    return float(np.degrees(np.arctan2(medial, -axis_lps[1])))


def sagittal_deg_of(axis_lps: Array) -> float:
    """Angle from straight forwards on a sagittal slice, positive to the head."""
    return float(np.degrees(np.arctan2(axis_lps[2], -axis_lps[1])))


def axis_from_angles(side: Side, *, transverse_deg: float, sagittal_deg: float) -> Array:
    """The unit axis (3,) in LPS, forwards, that shows these angles on an axial and a sagittal slice."""
    medial = np.tan(np.radians(transverse_deg))
    axis = np.array([-medial if side == "left" else medial, -1.0, np.tan(np.radians(sagittal_deg))])
    return np.asarray(axis / np.linalg.norm(axis))
