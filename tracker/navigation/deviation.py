"""Deviation of the drill from the planned channel."""

from dataclasses import dataclass

import numpy as np

from tracker.geometry import Array, Rigid, Tool, Vertebra, angle_between_deg
from tracker.navigation.directions import channel_directions
from tracker.plan import Channel
from tracker.plan.pedicle import Side, sagittal_deg_of, transverse_deg_of


@dataclass(frozen=True, slots=True, kw_only=True)
class Deviation:
    """Entry offset, angle and depth of the drill relative to the channel, and their components.

    Attributes:
        entry_offset_mm: distance from the entry point to where the drill's axis meets the entry plane
            (through the entry point, perpendicular to the channel); 0 on the axis. Infinite if the drill lies
            across the channel and its axis never meets that plane.
        angle_deg: between the drilling direction and the channel's axis, 0..180.
        depth_mm: of the tip past the entry plane, along the channel; negative outside.
        remaining_mm: from the tip to the planned end, along the channel; negative past it.
        tip_offset_mm: distance of the tip from the channel's axis.
        entry_lateral_mm: lateral component of the entry offset, in the axial slice, positive laterally;
            infinite if the offset is.
        entry_cranial_mm: cranial component, perpendicular to the lateral one, positive towards the head.
        transverse_deg: medial angle of the drill relative to the channel in an axial slice (same definition
            as the pedicle's transverse angle); negative laterally.
        sagittal_deg: cranial angle of the drill relative to the channel in a sagittal slice.
        angle_medial_deg: medial component of `angle_deg`, perpendicular to the channel; never larger than it.
        angle_cranial_deg: cranial component of `angle_deg`.
    """

    entry_offset_mm: float
    angle_deg: float
    depth_mm: float
    remaining_mm: float
    tip_offset_mm: float
    entry_lateral_mm: float
    entry_cranial_mm: float
    transverse_deg: float
    sagittal_deg: float
    angle_medial_deg: float
    angle_cranial_deg: float


def deviation_from_channel(
    vertebra_from_tool: Rigid[Vertebra, Tool], channel: Channel, side: Side | None = None
) -> Deviation:
    """Compute the deviation of a drill; its tip is the tool's origin, its drilling direction the tool's +z.

    `side` is that of the plan; None derives it from the channel, which converges towards the midline.
    """
    across = channel_directions(channel, side)
    axis = across.axis
    tip = vertebra_from_tool.translation_mm - channel.entry_in_vertebra_mm
    direction = vertebra_from_tool.rotate_directions([0.0, 0.0, 1.0])
    depth = float(tip @ axis)
    along = float(direction @ axis)
    entry_offset = lateral = cranial = np.inf
    # Below a thousandth (89.94 degrees) the crossing is metres away and meaningless.
    if abs(along) > 1e-3:
        crossing = tip - direction * (depth / along)
        entry_offset = float(np.linalg.norm(crossing))
        lateral, cranial = -float(crossing @ across.medial), float(crossing @ across.cranial)
    angle_deg = angle_between_deg(direction, axis)
    to_medial, to_cranial = float(direction @ across.medial), float(direction @ across.cranial)
    # A drill that points straight back has an angle but no direction of deviation.
    per_part = angle_deg / max(float(np.hypot(to_medial, to_cranial)), 1e-9)
    return Deviation(
        entry_offset_mm=entry_offset,
        angle_deg=angle_deg,
        depth_mm=depth,
        remaining_mm=channel.length_mm - depth,
        tip_offset_mm=float(np.linalg.norm(tip - depth * axis)),
        entry_lateral_mm=lateral,
        entry_cranial_mm=cranial,
        transverse_deg=_turned_deg(direction, axis, across.side),
        sagittal_deg=_within_half_turn(sagittal_deg_of(direction) - sagittal_deg_of(axis)),
        angle_medial_deg=to_medial * per_part,
        angle_cranial_deg=to_cranial * per_part,
    )


def _turned_deg(direction: Array, axis: Array, side: Side) -> float:
    return _within_half_turn(transverse_deg_of(direction, side) - transverse_deg_of(axis, side))


def _within_half_turn(angle_deg: float) -> float:
    """Wrap an angle to -180..180."""
    return (angle_deg + 180.0) % 360.0 - 180.0
