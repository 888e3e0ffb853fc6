"""The drill's cylinder as rings of places on its surface, each with its clearance to the wall."""

from dataclasses import dataclass

import numpy as np

from tracker.geometry import Array, Rigid, Tool, Vertebra
from tracker.navigation.clearance.field import UNIT_MM, WallField
from tracker.navigation.clearance.kernels import channel_clearances, wall_clearances
from tracker.navigation.directions import directions_of
from tracker.plan.channel import Channel

ROUND = 16
APART_MM = 1.0
# Past the bone's back by about a cortex: before that, a drill is on the bone and not yet in it.
CORTEX_MM = 2.0
# A drill that lies across the channel is looked at so far back from its tip.
LONGEST_MM = 80.0
MIN_ALONG = 0.05

TURN = 2.0 * np.pi * np.arange(ROUND) / ROUND
CIRCLE = np.stack([np.cos(TURN), np.sin(TURN)])


@dataclass(frozen=True, slots=True, kw_only=True)
class Rings:
    """Places on a cylinder, from its end backwards: s rings of r places.

    Attributes:
        points_mm: (s, r, 3) in the vertebra's frame.
        clearance_mm: (s, r) to the wall, below 0 where it is through; infinite where a place does not count:
            it is not past the bone's back, or far from the channel.
        gradient: (s, r, 3), how the clearance grows when the place moves.
    """

    points_mm: Array
    clearance_mm: Array
    gradient: Array

    @property
    def counts(self) -> bool:
        """Whether any place does."""
        return bool(np.isfinite(self.clearance_mm).any())


def rings_to_wall(
    pose: Rigid[Vertebra, Tool],
    channel: Channel,
    wall: WallField,
    *,
    radius_mm: float,
    length_mm: float,
    ahead_mm: float = 0.0,
) -> Rings:
    """Clearances of the drill, as it is or `ahead_mm` further in its present direction, to the wall."""
    points = _places(pose, channel, radius_mm, length_mm, ahead_mm)
    clearance, gradient = np.empty(points.shape[:2]), np.empty(points.shape)
    across = directions_of(channel)
    wall_clearances(
        wall.values,
        UNIT_MM,
        wall.grid.step_mm,
        wall.grid.origin_mm,
        wall.back.floor_mm,
        wall.back.step_mm,
        CORTEX_MM,
        across.entry_mm,
        across.basis,
        points,
        clearance,
        gradient,
    )
    return Rings(points_mm=points, clearance_mm=clearance, gradient=gradient)


def rings_to_channel(
    pose: Rigid[Vertebra, Tool],
    channel: Channel,
    *,
    radius_mm: float,
    length_mm: float,
    ahead_mm: float = 0.0,
) -> Rings:
    """Clearances of the drill to the wall of the planned cylinder, from its entry to its end."""
    points = _places(pose, channel, radius_mm, length_mm, ahead_mm)
    clearance, gradient = np.empty(points.shape[:2]), np.empty(points.shape)
    across = directions_of(channel)
    channel_clearances(
        channel.radius_mm,
        channel.length_mm,
        across.entry_mm,
        across.axis,
        points,
        clearance,
        gradient,
    )
    return Rings(points_mm=points, clearance_mm=clearance, gradient=gradient)


def ahead_to_end_mm(pose: Rigid[Vertebra, Tool], channel: Channel) -> float:
    """How far the drill has to go in its present direction to the planned depth; 0 if it never comes there.

    Also 0 when it is past it already.
    """
    axis = directions_of(channel).axis
    along = float(pose.rotation[:, 2] @ axis)
    remaining = channel.length_mm - float((pose.translation_mm - channel.entry_in_vertebra_mm) @ axis)
    if along < 0.2:
        return 0.0
    return min(max(remaining / along, 0.0), 2.0 * channel.length_mm + LONGEST_MM)


def _places(
    pose: Rigid[Vertebra, Tool], channel: Channel, radius_mm: float, length_mm: float, ahead_mm: float
) -> Array:
    """Places (s, r, 3) from `ahead_mm` before the tip back to the entry plane, or to the drill's end."""
    axis = directions_of(channel).axis
    direction = pose.rotation[:, 2]
    along = float(direction @ axis)
    depth = float((pose.translation_mm - channel.entry_in_vertebra_mm) @ axis)
    back = min(length_mm, LONGEST_MM)
    if along > MIN_ALONG:
        # An oblique drill's rim reaches deeper than its axis.
        rim = radius_mm * float(np.sqrt(max(1.0 - along * along, 0.0)))
        back = min(back, (depth + rim) / along)
    if back + ahead_mm < 0.0:
        return np.empty((0, ROUND, 3))
    steps = np.linspace(ahead_mm, -back, max(int(np.ceil((ahead_mm + back) / APART_MM)), 1) + 1)
    ring = pose.translation_mm + radius_mm * (pose.rotation[:, :2] @ CIRCLE).T
    return np.asarray(ring[None] + steps[:, None, None] * direction)
