"""Clearance of the whole drill to bone and channel, its depth, and its Gertzbein-Robbins grade."""

from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from tracker.geometry import Array, Rigid, Tool, Vertebra
from tracker.navigation.clearance.distance_field import WallDistanceField, WallSource
from tracker.navigation.clearance.rings import Rings, ahead_to_end_mm, rings_to_channel, rings_to_wall
from tracker.navigation.directions import Directions, Wall, channel_directions
from tracker.plan.channel import Channel
from tracker.plan.pedicle import Side
from tracker.plan.screw import GertzbeinRobbins, grade_of_breach

LOOKAHEAD_MM = 2.0
# Midway between two walls the gradient does not identify the nearer one.
CLEAR_GRADIENT = 0.5


@dataclass(frozen=True, slots=True, kw_only=True)
class NearestWall:
    """The point of the drill with the smallest clearance.

    Attributes:
        clearance_mm: signed distance from the drill's surface to the wall; negative through it.
        point_in_vertebra_mm: (3,), that point.
        wall: the wall concerned.
    """

    clearance_mm: float
    point_in_vertebra_mm: Array
    wall: Wall

    @property
    def breach_mm(self) -> float:
        """Depth of the breach; 0 without one."""
        return max(-self.clearance_mm, 0.0)

    @property
    def grade(self) -> GertzbeinRobbins:
        """Gertzbein-Robbins grade."""
        return grade_of_breach(self.breach_mm)


@dataclass(frozen=True, slots=True, kw_only=True)
class NotEntered:
    """No part of the drill is past the posterior surface or near the channel: there is no clearance."""


@dataclass(frozen=True, slots=True, kw_only=True)
class DrillRings:
    """Sample points of the drill for the clearances; also used by `tracker.navigation.uncertainty`.

    Attributes:
        against: which wall.
        now: the drill at its present pose.
        lookahead: the drill `LOOKAHEAD_MM` deeper in its present direction.
        at_end: the screw at the planned depth in the present direction.
        channel: the drill at its present pose, against the planned cylinder.
    """

    against: WallSource
    now: Rings
    lookahead: Rings
    at_end: Rings
    channel: Rings


WallProximity: TypeAlias = NearestWall | NotEntered


@dataclass(frozen=True, slots=True, kw_only=True)
class DrillClearance:
    """Clearances of the drill.

    Attributes:
        against: what `now`, `lookahead` and `at_end` were measured against.
        now: clearance of the whole drill at its present pose.
        lookahead: the same 2 mm deeper in the present direction.
        at_end: clearance of the planned screw (or the drill) at the planned depth in the present direction;
            its grade is the expected one.
        channel: clearance of the drill at its present pose to the planned cylinder.
        past_planned_mm: of the tip past the planned depth, along the channel; negative before it.
    """

    against: WallSource
    now: WallProximity
    lookahead: WallProximity
    at_end: WallProximity
    channel: WallProximity
    past_planned_mm: float


def drill_rings(
    vertebra_from_tool: Rigid[Vertebra, Tool],
    channel: Channel,
    wall: WallDistanceField,
    *,
    radius_mm: float,
    length_mm: float,
    screw_radius_mm: float | None = None,
    lookahead_mm: float = LOOKAHEAD_MM,
) -> DrillRings:
    """Sample the surface of drill and screw at the present, look-ahead and final poses.

    Args:
        vertebra_from_tool: pose of the drill.
        channel: the planned channel.
        wall: distance field of the bone; if unknown, of the pedicle's outline or of the channel.
        radius_mm: of the drill.
        length_mm: of the drill, from its tip backwards.
        screw_radius_mm: of the planned screw; None uses that of the drill.
        lookahead_mm: distance of the look-ahead.
    """
    end = ahead_to_end_mm(vertebra_from_tool, channel)
    now, lookahead, at_end = (
        rings_to_wall(
            vertebra_from_tool, channel, wall, radius_mm=radius, length_mm=length_mm, ahead_mm=ahead
        )
        for radius, ahead in (
            (radius_mm, 0.0),
            (radius_mm, lookahead_mm),
            (screw_radius_mm or radius_mm, end),
        )
    )
    to_channel = rings_to_channel(vertebra_from_tool, channel, radius_mm=radius_mm, length_mm=length_mm)
    return DrillRings(against=wall.against, now=now, lookahead=lookahead, at_end=at_end, channel=to_channel)


def clearance_of_drill(
    rings: DrillRings, vertebra_from_tool: Rigid[Vertebra, Tool], channel: Channel, side: Side | None = None
) -> DrillClearance:
    """Return the smallest clearances of the drill, their points and walls."""
    across = channel_directions(channel, side)
    tip = vertebra_from_tool.translation_mm - channel.entry_in_vertebra_mm
    return DrillClearance(
        against=rings.against,
        now=_closest(rings.now, channel, across),
        lookahead=_closest(rings.lookahead, channel, across),
        at_end=_closest(rings.at_end, channel, across),
        channel=_closest(rings.channel, channel, across),
        past_planned_mm=float(tip @ across.axis) - channel.length_mm,
    )


def _closest(rings: Rings, channel: Channel, across: Directions) -> WallProximity:
    if not rings.counts:
        return NotEntered()
    place = np.unravel_index(int(np.argmin(rings.clearance_mm)), rings.clearance_mm.shape)
    clearance = float(rings.clearance_mm[place])
    point = rings.points_mm[place].copy()
    point.setflags(write=False)
    outwards = -rings.gradient[place]
    # Far through a wall, the nearest wall may be another one (across the canal), so the perforated wall is
    # determined by the direction from the channel.
    if clearance < 0.0 or float(np.linalg.norm(outwards)) < CLEAR_GRADIENT:
        depth = float((point - channel.entry_in_vertebra_mm) @ across.axis)
        on_axis = channel.entry_in_vertebra_mm + np.clip(depth, 0.0, channel.length_mm) * across.axis
        outwards = point - on_axis
    return NearestWall(clearance_mm=clearance, point_in_vertebra_mm=point, wall=across.wall_towards(outwards))
