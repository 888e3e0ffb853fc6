"""The clearance of the whole drill: to the bone, to the channel, and in depth; and the grade that it has."""

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from tracker.geometry import Array, Rigid, Tool, Vertebra
from tracker.navigation.clearance.field import MeasuredAgainst, WallField
from tracker.navigation.clearance.rings import Rings, ahead_to_end_mm, rings_to_channel, rings_to_wall
from tracker.navigation.directions import Directions, Wall, directions_of
from tracker.plan.channel import Channel
from tracker.plan.pedicle import Side
from tracker.plan.screw import GertzbeinRobbins, grade_of_breach

SOON_MM = 2.0
# Between two walls the gradient says little of which is the nearer.
CLEAR_GRADIENT = 0.5


@dataclass(frozen=True, slots=True, kw_only=True)
class Nearest:
    """The place of the drill with the least clearance.

    Attributes:
        clearance_mm: from the drill's surface to the wall; below 0 where it is through.
        point_in_vertebra_mm: (3,), that place.
        wall: which wall it is.
    """

    clearance_mm: float
    point_in_vertebra_mm: Array
    wall: Wall

    @property
    def breach_mm(self) -> float:
        """How deep it is through the wall; 0 where it is not."""
        return max(-self.clearance_mm, 0.0)

    @property
    def grade(self) -> GertzbeinRobbins:
        """The class of Gertzbein and Robbins."""
        return grade_of_breach(self.breach_mm)


@dataclass(frozen=True, slots=True, kw_only=True)
class NotEntered:
    """No part of the drill is past the bone's back, or within reach of the channel: it has no clearance."""


@dataclass(frozen=True, slots=True, kw_only=True)
class DrillRings:
    """The places of the drill that the clearances are made from; `tracker.navigation.certainty` uses them.

    Attributes:
        against: which wall.
        now: the drill as it is.
        soon: the drill when it is `SOON_MM` further in its present direction.
        at_end: the screw when the present direction is kept to the planned depth.
        channel: the drill as it is, against the planned cylinder.
    """

    against: MeasuredAgainst
    now: Rings
    soon: Rings
    at_end: Rings
    channel: Rings


Closest: TypeAlias = Nearest | NotEntered


@dataclass(frozen=True, slots=True, kw_only=True)
class DrillClearance:
    """What is between the drill and the walls around it.

    Attributes:
        against: which wall `now`, `soon` and `at_end` were measured against.
        now: the whole drill as it is.
        soon: when it is 2 mm further in its present direction.
        at_end: the planned screw (or the drill) when the present direction is kept to the planned depth:
            the class that this direction would give.
        channel: the drill as it is, against the planned cylinder's wall.
        past_planned_mm: how far the tip is past the planned depth, along the channel; below 0 before it.
    """

    against: MeasuredAgainst
    now: Closest
    soon: Closest
    at_end: Closest
    channel: Closest
    past_planned_mm: float


def drill_rings(
    vertebra_from_tool: Rigid[Vertebra, Tool],
    channel: Channel,
    wall: WallField,
    *,
    radius_mm: float,
    length_mm: float,
    screw_radius_mm: float | None = None,
    soon_mm: float = SOON_MM,
) -> DrillRings:
    """All places of the drill, as it is, soon, and as a screw at the planned end.

    Args:
        vertebra_from_tool: the drill.
        channel: the plan.
        wall: distances to the bone; where it is not known, to the pedicle's outline or to the channel.
        radius_mm: of the drill.
        length_mm: of the drill, from its tip backwards.
        screw_radius_mm: of the planned screw; the drill's own where none is planned.
        soon_mm: what "soon" is.
    """
    end = ahead_to_end_mm(vertebra_from_tool, channel)
    now, soon, at_end = (
        rings_to_wall(
            vertebra_from_tool, channel, wall, radius_mm=radius, length_mm=length_mm, ahead_mm=ahead
        )
        for radius, ahead in (
            (radius_mm, 0.0),
            (radius_mm, soon_mm),
            (screw_radius_mm or radius_mm, end),
        )
    )
    to_channel = rings_to_channel(vertebra_from_tool, channel, radius_mm=radius_mm, length_mm=length_mm)
    return DrillRings(against=wall.against, now=now, soon=soon, at_end=at_end, channel=to_channel)


def clearance_of_drill(
    rings: DrillRings, vertebra_from_tool: Rigid[Vertebra, Tool], channel: Channel, side: Side | None = None
) -> DrillClearance:
    """The least clearances of the drill, where they are, and which walls."""
    across = directions_of(channel, side)
    tip = vertebra_from_tool.translation_mm - channel.entry_in_vertebra_mm
    return DrillClearance(
        against=rings.against,
        now=_closest(rings.now, channel, across),
        soon=_closest(rings.soon, channel, across),
        at_end=_closest(rings.at_end, channel, across),
        channel=_closest(rings.channel, channel, across),
        past_planned_mm=float(tip @ across.axis) - channel.length_mm,
    )


def _closest(rings: Rings, channel: Channel, across: Directions) -> Closest:
    if not rings.counts:
        return NotEntered()
    place = np.unravel_index(int(np.argmin(rings.clearance_mm)), rings.clearance_mm.shape)
    clearance = float(rings.clearance_mm[place])
    point = rings.points_mm[place].copy()
    point.setflags(write=False)
    outwards = -rings.gradient[place]
    # Far through a wall, the nearest wall may be the next one (across the canal): the way out of the channel
    # tells which was gone through.
    if clearance < 0.0 or float(np.linalg.norm(outwards)) < CLEAR_GRADIENT:
        depth = float((point - channel.entry_in_vertebra_mm) @ across.axis)
        on_axis = channel.entry_in_vertebra_mm + np.clip(depth, 0.0, channel.length_mm) * across.axis
        outwards = point - on_axis
    return Nearest(clearance_mm=clearance, point_in_vertebra_mm=point, wall=across.wall_towards(outwards))
