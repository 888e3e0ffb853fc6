"""Screw selection from the catalogue, with all derived values."""

from dataclasses import dataclass

from tracker.errors import PlanError
from tracker.plan.channel import Channel
from tracker.plan.pedicle import PedicleMeasure
from tracker.plan.screw.catalogue import ScrewCatalogue
from tracker.plan.screw.channel import FRONT_MARGIN_MM
from tracker.plan.screw.clearance import Clearance, clearance_of
from tracker.plan.screw.density import BoneAlong, bone_along
from tracker.plan.screw.tolerance import Tolerance, tolerance_of
from tracker.plan.volume import Volume

WALL_MARGIN_MM = 0.5


@dataclass(frozen=True, slots=True, kw_only=True)
class ScrewPlan:
    """One screw in one channel with all derived values."""

    diameter_mm: float
    length_mm: float
    clearance: Clearance
    bone: BoneAlong
    tolerance: Tolerance


def propose_screw(
    channel: Channel,
    measure: PedicleMeasure,
    catalogue: ScrewCatalogue,
    *,
    wall_margin_mm: float = WALL_MARGIN_MM,
    front_margin_mm: float = FRONT_MARGIN_MM,
) -> tuple[float, float]:
    """Return the largest diameter with its margin to each wall and the longest length before the front wall.

    Raises:
        PlanError: NO_SCREW_FITS.
    """
    thinnest, shortest = catalogue.diameters_mm[0], catalogue.lengths_mm[0]
    room = clearance_of(channel, measure, diameter_mm=0.0, length_mm=0.0)
    diameters = [d for d in catalogue.diameters_mm if room.min_mm - 0.5 * d >= wall_margin_mm]
    lengths = [length for length in catalogue.lengths_mm if room.anterior_mm - length >= front_margin_mm]
    if not diameters or not lengths:
        raise PlanError(
            "NO_SCREW_FITS",
            f"the path leaves {room.min_mm:.1f} mm to the nearest wall and {room.anterior_mm:.1f} mm to "
            f"the front; the smallest screw is {thinnest:.1f} x {shortest:.0f} mm and needs "
            f"{0.5 * thinnest + wall_margin_mm:.1f} and {shortest + front_margin_mm:.1f} mm",
            "Move the path to the middle of the pedicle, or add a thinner or shorter screw to the catalogue.",
            {
                "nearest_wall_mm": room.min_mm,
                "front_mm": room.anterior_mm,
                "thinnest_mm": float(thinnest),
                "shortest_mm": float(shortest),
                "needed_wall_mm": float(0.5 * thinnest + wall_margin_mm),
                "needed_front_mm": float(shortest + front_margin_mm),
            },
        )
    return diameters[-1], lengths[-1]


def plan_screw(
    volume: Volume, channel: Channel, measure: PedicleMeasure, *, diameter_mm: float, length_mm: float
) -> ScrewPlan:
    """Return clearance and grade, bone density and tolerance of one screw.

    Raises:
        PlanError: SCREW_INVALID.
    """
    if not (0.0 < diameter_mm < 20.0 and 0.0 < length_mm < 200.0):
        raise PlanError(
            "SCREW_INVALID",
            f"the screw is {diameter_mm} x {length_mm} mm, "
            "allowed are diameters under 20 and lengths under 200 mm",
            "Give diameter and length of the screw in mm.",
            {"diameter_mm": diameter_mm, "length_mm": length_mm},
        )
    return ScrewPlan(
        diameter_mm=diameter_mm,
        length_mm=length_mm,
        clearance=clearance_of(channel, measure, diameter_mm=diameter_mm, length_mm=length_mm),
        bone=bone_along(volume, channel, diameter_mm=diameter_mm, length_mm=length_mm),
        tolerance=tolerance_of(channel, measure, diameter_mm=diameter_mm),
    )
