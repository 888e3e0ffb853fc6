"""Manual corrections of measured pedicle values; the measured values are preserved."""

import dataclasses
from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np

from tracker.errors import PlanError
from tracker.geometry import Array
from tracker.plan.pedicle import PedicleMeasure, axis_from_angles

# Each correctable value and its allowed range.
CORRECTABLE: Mapping[str, tuple[float, float]] = {
    "width_mm": (1.0, 30.0),
    "height_mm": (1.0, 40.0),
    "transverse_deg": (-60.0, 60.0),
    "sagittal_deg": (-60.0, 60.0),
    "length_mm": (5.0, 120.0),
}


@dataclass(frozen=True, slots=True, kw_only=True)
class PedicleRecord:
    """A measured pedicle and its manual corrections.

    Attributes:
        measured: never changed by a correction.
        corrected: number by name, of those in `CORRECTABLE`.

    Raises:
        PlanError: CORRECTION_INVALID, a name is unknown or a number is out of range.
    """

    measured: PedicleMeasure
    corrected: Mapping[str, float] = field(default_factory=dict)

    def __post_init__(self) -> None:
        for name, value in self.corrected.items():
            if name not in CORRECTABLE:
                raise PlanError(
                    "CORRECTION_INVALID",
                    f"'{name}' cannot be corrected, allowed are {', '.join(CORRECTABLE)}",
                    "Correct one of these numbers.",
                    {"name": name, "allowed": ", ".join(CORRECTABLE)},
                )
            low, high = CORRECTABLE[name]
            if not low <= value <= high:
                raise PlanError(
                    "CORRECTION_INVALID",
                    f"{name} was corrected to {value}, allowed are {low:g} to {high:g}",
                    "Give the number again, in mm or degrees as its name says.",
                    {name: value, "number": name, "corrected": value, "low": low, "high": high},
                )

    @property
    def used(self) -> PedicleMeasure:
        """Return the pedicle with the corrections applied."""
        return corrected_measure(self.measured, self.corrected)


def corrected_measure(measure: PedicleMeasure, corrected: Mapping[str, float]) -> PedicleMeasure:
    """Return the pedicle with these values: outline scaled, axis rotated about the isthmus, end moved.

    The entry keeps its distance from the isthmus; a corrected length moves the front.
    """
    if not corrected:
        return measure
    number = {name: float(corrected.get(name, getattr(measure, name))) for name in CORRECTABLE}
    turned = "transverse_deg" in corrected or "sagittal_deg" in corrected
    axis = (
        axis_from_angles(
            measure.side, transverse_deg=number["transverse_deg"], sagittal_deg=number["sagittal_deg"]
        )
        if turned
        else measure.axis_lps
    )
    behind = float(np.linalg.norm(measure.entry_lps_mm - measure.isthmus_lps_mm))
    entry = measure.isthmus_lps_mm - behind * axis
    return dataclasses.replace(
        measure,
        width_mm=number["width_mm"],
        height_mm=number["height_mm"],
        transverse_deg=number["transverse_deg"],
        sagittal_deg=number["sagittal_deg"],
        length_mm=number["length_mm"],
        axis_lps=axis,
        entry_lps_mm=entry,
        front_lps_mm=entry + number["length_mm"] * axis,
        outline_lps_mm=_outline(measure, axis, number["width_mm"], number["height_mm"]),
    )


def _outline(measure: PedicleMeasure, axis: Array, width_mm: float, height_mm: float) -> Array:
    across, up = _across(measure.axis_lps)
    away = measure.outline_lps_mm - measure.isthmus_lps_mm
    x = (away @ across) * (width_mm / measure.width_mm)
    y = (away @ up) * (height_mm / measure.height_mm)
    new_across, new_up = _across(axis)
    return np.asarray(measure.isthmus_lps_mm + x[:, None] * new_across + y[:, None] * new_up)


def _across(axis: Array) -> tuple[Array, Array]:
    up = np.array([0.0, 0.0, 1.0]) - axis * axis[2]
    up /= np.linalg.norm(up)
    across = np.cross(up, axis)
    return across * (1.0 if across[0] > 0.0 else -1.0), up
