"""How far the drill is from the planned channel."""

from dataclasses import dataclass

import numpy as np

from tracker.geometry import Rigid, Tool, Vertebra, angle_between_deg
from tracker.plan import Channel


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
    """

    entry_offset_mm: float
    angle_deg: float
    depth_mm: float
    remaining_mm: float
    tip_offset_mm: float


def deviation_from_channel(vertebra_from_tool: Rigid[Vertebra, Tool], channel: Channel) -> Deviation:
    """The deviation of a drill, whose tip is the tool's origin and whose direction is the tool's +z."""
    axis = channel.axis_in_vertebra
    tip = vertebra_from_tool.translation_mm - channel.entry_in_vertebra_mm
    direction = vertebra_from_tool.turn_directions([0.0, 0.0, 1.0])
    depth = float(tip @ axis)
    along = float(direction @ axis)
    entry_offset = np.inf
    # Below a thousandth (89.94 degrees) the crossing is metres away and says nothing.
    if abs(along) > 1e-3:
        entry_offset = float(np.linalg.norm(tip - direction * (depth / along)))
    return Deviation(
        entry_offset_mm=entry_offset,
        angle_deg=angle_between_deg(direction, axis),
        depth_mm=depth,
        remaining_mm=channel.length_mm - depth,
        tip_offset_mm=float(np.linalg.norm(tip - depth * axis)),
    )
