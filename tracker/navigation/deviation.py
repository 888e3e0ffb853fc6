"""How far the drill is from the planned channel."""

from dataclasses import dataclass

import numpy as np

from tracker.geometry import Array, Rigid, Tool, Vertebra, angle_between_deg
from tracker.navigation.directions import directions_of
from tracker.plan import Channel
from tracker.plan.pedicle import Side, sagittal_deg_of, transverse_deg_of


@dataclass(frozen=True, slots=True, kw_only=True)
class Deviation:
    """The three numbers of the surgeon, and what they are made of.

    Attributes:
        entry_offset_mm: distance, in the plane through the entry point across the channel, from the entry
            point to where the drill's line meets that plane; 0 on the axis. Infinite when the drill is
            across the channel and never meets it.
        angle_deg: between the drilling direction and the channel's axis, 0..180.
        depth_mm: how far the tip is past the entry plane, along the channel; negative while outside.
        remaining_mm: how far is still to go to the planned end; negative when past it.
        tip_offset_mm: distance of the tip from the channel's axis.
        entry_lateral_mm: the part of the entry offset along the slice, positive away from the patient's
            middle; infinite as the whole.
        entry_cranial_mm: the part along the body, positive to the head; with the other at right angles.
        transverse_deg: by how much the drill runs more to the middle than the channel, as an axial slice
            shows it (angles as those of a pedicle's measure); negative outwards.
        sagittal_deg: by how much it runs more to the head, as a sagittal slice shows it.
        angle_medial_deg: the part of the angle to the middle, across the channel itself; never more than it.
        angle_cranial_deg: the part to the head, likewise.
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
    """The deviation of a drill, whose tip is the tool's origin and whose direction is the tool's +z.

    `side` is the plan's; without it, the side to which a channel that runs to the middle belongs.
    """
    across = directions_of(channel, side)
    axis = across.axis
    tip = vertebra_from_tool.translation_mm - channel.entry_in_vertebra_mm
    direction = vertebra_from_tool.turn_directions([0.0, 0.0, 1.0])
    depth = float(tip @ axis)
    along = float(direction @ axis)
    entry_offset = lateral = cranial = np.inf
    # Below a thousandth (89.94 degrees) the crossing is metres away and says nothing.
    if abs(along) > 1e-3:
        crossing = tip - direction * (depth / along)
        entry_offset = float(np.linalg.norm(crossing))
        lateral, cranial = -float(crossing @ across.medial), float(crossing @ across.cranial)
    angle_deg = angle_between_deg(direction, axis)
    to_medial, to_cranial = float(direction @ across.medial), float(direction @ across.cranial)
    # A drill that points straight back has an angle and no side.
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
    """The same angle, -180..180."""
    return (angle_deg + 180.0) % 360.0 - 180.0
