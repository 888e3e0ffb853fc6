"""Planned needles: at points of the bone, or on lines of the reference slice."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.errors import InvalidInput, PlanError, RegistrationError
from tracker.geometry import Array
from tracker.plan import Landmark, ReferenceSlice

# Backwards in the patient, which is up when the patient lies prone.
BACKWARDS_LPS = (0.0, 1.0, 0.0)
MIN_NEEDLES = 3
MIN_APART_MM = 5.0


@dataclass(frozen=True, slots=True, kw_only=True)
class PlannedNeedle:
    """One planned needle, with the accuracy of its placement.

    Attributes:
        name: of its landmark or line.
        point_lps_mm: (3,), its entry into the bone; for a line, any point near the bone.
        covariance_mm2: (3, 3), of the placement.
        direction_lps: (3,), unit, from the bone outwards along the needle.
        direction_sd_deg: standard deviation of its direction, about each of two axes.

    Raises:
        InvalidInput: NEEDLE_PLACE_INVALID.
    """

    name: str
    point_lps_mm: Array
    covariance_mm2: Array
    direction_lps: Array
    direction_sd_deg: float

    def __post_init__(self) -> None:
        shapes = {"point_lps_mm": (3,), "covariance_mm2": (3, 3), "direction_lps": (3,)}
        arrays = {name: np.array(getattr(self, name), dtype=np.float64) for name in shapes}
        length = float(np.linalg.norm(arrays["direction_lps"]))
        if (
            any(array.shape != shapes[name] or not np.isfinite(array).all() for name, array in arrays.items())
            or length < 1e-6
            or not 0.0 < self.direction_sd_deg <= 90.0
            or np.linalg.eigvalsh(arrays["covariance_mm2"]).min() <= 0.0
        ):
            raise InvalidInput(
                "NEEDLE_PLACE_INVALID",
                f"the place of needle '{self.name[:40]}' has an invalid number; its direction has a spread "
                f"of {self.direction_sd_deg:g} deg, allowed above 0 to 90",
                "Give a point and a direction in LPS, and spreads above 0.",
                {"needle": self.name[:40], "direction_sd_deg": self.direction_sd_deg},
            )
        arrays["direction_lps"] /= length
        for name, array in arrays.items():
            array.setflags(write=False)
            object.__setattr__(self, name, array)


def planned_at_landmarks(
    landmarks: Sequence[Landmark],
    *,
    placing_sd_mm: float = 0.7,
    direction_lps: npt.ArrayLike = BACKWARDS_LPS,
    direction_sd_deg: float = 15.0,
) -> tuple[PlannedNeedle, ...]:
    """Return needles that enter the bone at these landmarks, in any direction.

    Args:
        landmarks: of the vertebra, one per needle.
        placing_sd_mm: of the placement, along each axis.
        direction_lps: (3,), nominal direction from the bone outwards.
        direction_sd_deg: standard deviation of that direction.
    """
    return tuple(
        PlannedNeedle(
            name=one.name,
            point_lps_mm=one.point_lps_mm,
            covariance_mm2=placing_sd_mm**2 * np.eye(3),
            direction_lps=np.asarray(direction_lps, dtype=np.float64),
            direction_sd_deg=direction_sd_deg,
        )
        for one in landmarks
    )


def planned_on_lines(
    reference: ReferenceSlice,
    *,
    across_sd_mm: float = 1.0,
    along_sd_mm: float = 25.0,
    off_slice_sd_mm: float = 10.0,
    direction_sd_deg: float = 10.0,
) -> tuple[PlannedNeedle, ...]:
    """Return the paper's needles: one per vertical line of the slice, with open depth and slice offset.

    Args:
        reference: the slice with its three lines.
        across_sd_mm: of the distances between needles.
        along_sd_mm: of the entry along its line, from the line's middle.
        off_slice_sd_mm: of the offset perpendicular to the slice.
        direction_sd_deg: of the needle's direction about its line.
    """
    places = []
    for line in reference.lines:
        start, end = line.ends_lps_mm
        along = (end - start) / np.linalg.norm(end - start)
        along = along if along[1] > 0.0 else -along
        across = _across(reference)
        frame = np.stack([across, along, np.cross(across, along)], axis=1)
        spread = np.diag([across_sd_mm**2, along_sd_mm**2, off_slice_sd_mm**2])
        places.append(
            PlannedNeedle(
                name=line.name,
                point_lps_mm=0.5 * (start + end),
                covariance_mm2=frame @ spread @ frame.T,
                direction_lps=along,
                direction_sd_deg=direction_sd_deg,
            )
        )
    return tuple(places)


def reject_poor_geometry(places: Sequence[PlannedNeedle]) -> None:
    """Reject needles that do not determine a pose.

    Raises:
        RegistrationError: NEEDLES_TOO_FEW, NEEDLES_TOO_CLOSE, NEEDLES_COLLINEAR.
        PlanError: NEEDLE_TWICE.
    """
    names = [one.name for one in places]
    if len(set(names)) < len(names):
        raise PlanError(
            "NEEDLE_TWICE",
            f"{len(names)} needles have {len(set(names))} names",
            "Name each once.",
            {"needles": len(names), "names": len(set(names))},
        )
    if len(places) < MIN_NEEDLES:
        raise RegistrationError(
            "NEEDLES_TOO_FEW",
            f"{len(places)} needles are planned, needed {MIN_NEEDLES}",
            "Set a landmark for each needle on the CT.",
            {"needles": len(places), "needed": MIN_NEEDLES},
        )
    points = np.stack([one.point_lps_mm for one in places])
    distance_mm, one, other = min(
        (float(np.linalg.norm(points[i] - points[j])), names[i], names[j])
        for i in range(len(places))
        for j in range(i)
    )
    if distance_mm < MIN_APART_MM:
        raise RegistrationError(
            "NEEDLES_TOO_CLOSE",
            f"needles '{other[:40]}' and '{one[:40]}' are {distance_mm:.1f} mm apart, "
            f"needed {MIN_APART_MM:g} mm",
            "Put the needles farther apart.",
            {"apart_mm": distance_mm, "one": other[:40], "other": one[:40], "needed_mm": MIN_APART_MM},
        )
    across_mm = height_mm(places)
    if across_mm < MIN_APART_MM and not _are_lines(places):
        raise RegistrationError(
            "NEEDLES_COLLINEAR",
            f"the needles are within {across_mm:.1f} mm of one straight line, needed {MIN_APART_MM:g} mm",
            "Put one needle farther from the line through the others.",
            {"across_mm": across_mm, "needed_mm": MIN_APART_MM},
        )


def height_mm(places: Sequence[PlannedNeedle]) -> float:
    """Return the extent of the points perpendicular to their principal axis."""
    points = np.stack([one.point_lps_mm for one in places])
    centred = points - points.mean(axis=0)
    _, _, axes = np.linalg.svd(centred)
    beside = centred - np.outer(centred @ axes[0], axes[0])
    return float(np.ptp(beside @ axes[1]))


def _are_lines(places: Sequence[PlannedNeedle]) -> bool:
    """Return whether only the lines of the needles are planned; these may be collinear, as in the paper."""
    return all(float(one.direction_lps @ one.covariance_mm2 @ one.direction_lps) > 10.0**2 for one in places)


def _across(reference: ReferenceSlice) -> Array:
    by_name = {line.name: line.ends_lps_mm.mean(axis=0) for line in reference.lines}
    across = by_name["left"] - by_name["right"]
    return np.asarray(across / np.linalg.norm(across))
