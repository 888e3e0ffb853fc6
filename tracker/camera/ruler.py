"""Scale from two measured distances to the camera: millimetres from pixels (paper, 2.2, equations 1 to 5).

Valid for short displacements perpendicular to the line of sight, near the image centre, with square pixels
and no lens distortion. Used to check a calibrated camera by hand.
"""

import math
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.errors import InvalidInput
from tracker.geometry import Array


@dataclass(frozen=True, slots=True, kw_only=True)
class Ruler:
    """A camera above and beside the object, and its focal length.

    Attributes:
        vertical_mm: V, height of the camera above the object.
        horizontal_mm: H, horizontal distance of the camera from the object.
        focal_length_px: f, the camera constant.

    Raises:
        InvalidInput: RULER_INVALID, a distance is negative or not finite, or D or f is not above 0.
    """

    vertical_mm: float
    horizontal_mm: float
    focal_length_px: float

    def __post_init__(self) -> None:
        _needed(self.focal_length_px, "the focal length", "px")
        _needed(axial_distance_mm(self.vertical_mm, self.horizontal_mm), "the distance to the camera", "mm")

    @classmethod
    def from_displacement(cls, *, vertical_mm: float, horizontal_mm: float, pixels_per_mm: float) -> "Ruler":
        """Return the ruler with the focal length from one known displacement (equation 5)."""
        focal_length_px = pixels_per_mm * axial_distance_mm(vertical_mm, horizontal_mm)
        return cls(vertical_mm=vertical_mm, horizontal_mm=horizontal_mm, focal_length_px=focal_length_px)

    @property
    def axial_distance_mm(self) -> float:
        """Return D, the distance from the object to the camera."""
        return axial_distance_mm(self.vertical_mm, self.horizontal_mm)

    @property
    def angle_deg(self) -> float:
        """Return theta, the angle between the horizontal and the camera's axis."""
        return angle_deg(self.vertical_mm, self.horizontal_mm)

    @property
    def pixels_per_mm(self) -> float:
        """Return Pd/Rd at the distance D (equation 4)."""
        return self.focal_length_px / self.axial_distance_mm

    def displacement_mm(self, pixel_distance_px: npt.ArrayLike) -> Array:
        """Return the calculated Rd of each Pd (...): displacement in mm from displacement in px."""
        return np.asarray(np.asarray(pixel_distance_px, dtype=np.float64) / self.pixels_per_mm)


def axial_distance_mm(vertical_mm: float, horizontal_mm: float) -> float:
    """Return D, the distance from the object to a camera at V and H.

    Raises:
        InvalidInput: RULER_INVALID, a distance is negative or not finite.
    """
    for name, value in (("vertical", vertical_mm), ("horizontal", horizontal_mm)):
        if not (math.isfinite(value) and value >= 0.0):
            raise _unusable(f"the {name} distance is {value:g} mm, needed 0 or more", {f"{name}_mm": value})
    return math.hypot(vertical_mm, horizontal_mm)


def angle_deg(vertical_mm: float, horizontal_mm: float) -> float:
    """Return theta, the angle between the horizontal and the axis of a camera at V and H."""
    return math.degrees(math.atan2(vertical_mm, horizontal_mm))


def distances(first: npt.ArrayLike, second: npt.ArrayLike) -> Array:
    """Return Pd or Rd: distance of each second point (..., 2) from its first one, in the unit of both."""
    return np.asarray(
        np.linalg.norm(np.asarray(first, dtype=np.float64) - np.asarray(second, dtype=np.float64), axis=-1)
    )


def pixels_per_mm(pixel_distance_px: float, displacement_mm: float) -> float:
    """Return Pd/Rd, pixels per millimetre (equation 3).

    Raises:
        InvalidInput: RULER_INVALID, the displacement or its pixels are not above 0.
    """
    _needed(displacement_mm, "the displacement", "mm")
    _needed(pixel_distance_px, "the displacement in the image", "px")
    return pixel_distance_px / displacement_mm


def _needed(value: float, what: str, unit: str) -> None:
    if not (math.isfinite(value) and value > 0.0):
        raise _unusable(f"{what} is {value:g} {unit}, needed above 0", {f"value_{unit}": value})


def _unusable(problem: str, context: dict[str, object]) -> InvalidInput:
    return InvalidInput(
        "RULER_INVALID",
        f"the ruler cannot be used: {problem}",
        "Measure V and H from the camera to the object in mm again, and a displacement that can be seen.",
        {**context, "ruler_problem": problem},
    )
