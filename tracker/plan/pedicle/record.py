"""Record of one measured pedicle: values, standard deviations and warnings."""

from dataclasses import dataclass
from typing import Literal

import numpy as np

from tracker.errors import InvalidInput, Remark
from tracker.geometry import Array

Side = Literal["left", "right"]
SIDES: tuple[Side, ...] = ("left", "right")
# Length of a pedicle that is certainly no wider than the isthmus.
MIN_AHEAD_MM = 3.0


@dataclass(frozen=True, slots=True, kw_only=True)
class PedicleSpread:
    """Standard deviation of each value: of the fit, and of the alternative solutions."""

    width_mm: float
    height_mm: float
    transverse_deg: float
    sagittal_deg: float
    length_mm: float
    isthmus_mm: float


@dataclass(frozen=True, slots=True, kw_only=True)
class PedicleMeasure:
    """One pedicle, measured at its isthmus: the narrowest section across its own axis.

    Angles are relative to the patient's axes (LPS), projected onto an axial and a sagittal slice, not
    relative to the vertebra's endplates.

    Attributes:
        side: the patient's left or right.
        width_mm: outer width of the section, in the direction nearest to the patient's left-right.
        height_mm: outer height of the section, across the width.
        transverse_deg: angle of the axis from straight forwards in the axial plane, positive where it runs
            to the middle.
        sagittal_deg: angle of the axis from straight forwards in the sagittal plane, positive where it runs
            to the head.
        length_mm: length along the axis from the entry to the outer side of the body's anterior wall; the
            margin of a screw is not subtracted.
        isthmus_lps_mm: (3,), centre of the section.
        axis_lps: unit (3,), forwards.
        entry_lps_mm: (3,), where the axis enters the arch from posterior; the base of a process that it runs
            through lengthwise.
        front_lps_mm: (3,), where it leaves the body in front.
        outline_lps_mm: (n, 3), the section's outer wall.
        seed_lps_mm: (3,), the click.
        cortex_mm: mean thickness of the wall; valid only for fine voxels.
        sd: standard deviations.
        opens_ahead_mm: how far in front of the isthmus the pedicle opens into the body.
        warnings: about these values.
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
    warnings: tuple[Remark, ...] = ()

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
    """Validate the name of a side.

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
        {"side": side, "given_side": side},
    )


def transverse_deg_of(axis_lps: Array, side: Side) -> float:
    """Return the angle to the anterior direction in the axial plane, positive medially."""
    medial = -axis_lps[0] if side == "left" else axis_lps[0]
    return float(np.degrees(np.arctan2(medial, -axis_lps[1])))


def sagittal_deg_of(axis_lps: Array) -> float:
    """Return the angle to the anterior direction in the sagittal plane, positive cranially."""
    return float(np.degrees(np.arctan2(axis_lps[2], -axis_lps[1])))


def axis_from_angles(side: Side, *, transverse_deg: float, sagittal_deg: float) -> Array:
    """Return the unit axis (3,) in LPS, pointing forwards, with these projected angles."""
    medial = np.tan(np.radians(transverse_deg))
    axis = np.array([-medial if side == "left" else medial, -1.0, np.tan(np.radians(sagittal_deg))])
    return np.asarray(axis / np.linalg.norm(axis))
