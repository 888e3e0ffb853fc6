"""Plausible units of a mesh, by the size of a vertebra or a spine."""

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from tracker.geometry import Array

MM_FROM_UNIT = {"mm": 1.0, "cm": 10.0, "m": 1000.0, "inch": 25.4, "um": 0.001}
# Longest, middle and shortest side of the bounding box, from a child's cervical to an adult's lumbar vertebra
# with all processes; the atlas is the flattest.
VERTEBRA_LONGEST_MM = (25.0, 125.0)
VERTEBRA_MIDDLE_MM, VERTEBRA_SHORTEST_MM, VERTEBRA_FLATTEST_RATIO = 15.0, 8.0, 5.0
VERTEBRA_USUAL_MM = 85.0
# From two vertebrae to a spine with pelvis and ribs.
SPINE_LONGEST_MM, SPINE_MIDDLE_MM, SPINE_SHORTEST_MM = (125.0, 1000.0), (40.0, 450.0), 25.0
SPINE_USUAL_MM = 350.0


class Kind(StrEnum):
    """Anatomical extent of a mesh, by its size."""

    VERTEBRA = "vertebra"
    SPINE = "several vertebrae"


@dataclass(frozen=True, slots=True, kw_only=True)
class FittingUnit:
    """A unit in which a mesh has the size of a vertebra or of a spine.

    Attributes:
        unit: a key of `MM_FROM_UNIT`.
        kind: extent of the mesh in this unit.
        size_mm: (3,) size of the bounding box in this unit.
    """

    unit: str
    kind: Kind
    size_mm: Array


def kind_of(size_mm: Array) -> Kind | None:
    """Return the kind by a bounding box (3,) in mm: a vertebra, a spine or None."""
    shortest, middle, longest = np.sort(size_mm)
    if (
        VERTEBRA_LONGEST_MM[0] <= longest <= VERTEBRA_LONGEST_MM[1]
        and middle >= VERTEBRA_MIDDLE_MM
        and shortest >= max(VERTEBRA_SHORTEST_MM, longest / VERTEBRA_FLATTEST_RATIO)
    ):
        return Kind.VERTEBRA
    if (
        SPINE_LONGEST_MM[0] < longest <= SPINE_LONGEST_MM[1]
        and SPINE_MIDDLE_MM[0] <= middle <= SPINE_MIDDLE_MM[1]
        and shortest >= SPINE_SHORTEST_MM
    ):
        return Kind.SPINE
    return None


def fitting_units(size: Array) -> tuple[FittingUnit, ...]:
    """Return the plausible units of a bounding box (3,), the most probable first."""
    found = []
    for unit, mm in MM_FROM_UNIT.items():
        size_mm = np.asarray(size, dtype=np.float64) * mm
        kind = kind_of(size_mm)
        if kind is not None:
            found.append(FittingUnit(unit=unit, kind=kind, size_mm=size_mm))
    return tuple(sorted(found, key=_unlikeliness))


def _unlikeliness(fit: FittingUnit) -> tuple[bool, float]:
    usual_mm = VERTEBRA_USUAL_MM if fit.kind is Kind.VERTEBRA else SPINE_USUAL_MM
    return fit.kind is not Kind.VERTEBRA, float(abs(np.log(fit.size_mm.max() / usual_mm)))
