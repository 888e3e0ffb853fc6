"""Sample the drill's cylinder as rings of surface points, with their clearances."""

from dataclasses import dataclass

import numpy as np

from tracker.geometry import Array, Rigid, Tool, Vertebra
from tracker.navigation.clearance.distance_field import UNIT_MM, WallDistanceField
from tracker.navigation.clearance.distance_kernels import channel_clearances, wall_clearances
from tracker.navigation.directions import channel_directions
from tracker.plan.channel import Channel

ROUND = 16
APART_MM = 1.0
# Points count from this depth past the posterior surface, about the thickness of the cortex.
CORTEX_MM = 2.0
# Sampled length behind the tip of a drill that lies across the channel.
LONGEST_MM = 80.0
MIN_ALONG = 0.05

TURN = 2.0 * np.pi * np.arange(ROUND) / ROUND
CIRCLE = np.stack([np.cos(TURN), np.sin(TURN)])


@dataclass(frozen=True, slots=True, kw_only=True)
class Rings:
    """Surface points of a cylinder, from its end backwards: s rings of r points.

    Attributes:
        points_mm: (s, r, 3) in the vertebra frame.
        clearance_mm: (s, r) to the wall, negative through it; infinite for points that do not count: before
            the posterior surface, or far from the channel.
        gradient: (s, r, 3), of the clearance with respect to the point.
    """

    points_mm: Array
    clearance_mm: Array
    gradient: Array

    @property
    def counts(self) -> bool:
        """Return whether any point counts."""
        return bool(np.isfinite(self.clearance_mm).any())


def rings_to_wall(
    pose: Rigid[Vertebra, Tool],
    channel: Channel,
    wall: WallDistanceField,
    *,
    radius_mm: float,
    length_mm: float,
    ahead_mm: float = 0.0,
) -> Rings:
    """Return clearances to the wall, at the present pose or `ahead_mm` further along the drill."""
    points = _places(pose, channel, radius_mm, length_mm, ahead_mm)
    clearance, gradient = np.empty(points.shape[:2]), np.empty(points.shape)
    across = channel_directions(channel)
    wall_clearances(
        wall.values,
        UNIT_MM,
        wall.grid.step_mm,
        wall.grid.origin_mm,
        wall.posterior.floor_mm,
        wall.posterior.step_mm,
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
    """Return clearances to the wall of the planned cylinder, from its entry to its end."""
    points = _places(pose, channel, radius_mm, length_mm, ahead_mm)
    clearance, gradient = np.empty(points.shape[:2]), np.empty(points.shape)
    across = channel_directions(channel)
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
    """Return the distance to the planned depth along the present direction; 0 if never reached.

    Also 0 past the planned depth.
    """
    axis = channel_directions(channel).axis
    along = float(pose.rotation[:, 2] @ axis)
    remaining = channel.length_mm - float((pose.translation_mm - channel.entry_in_vertebra_mm) @ axis)
    if along < 0.2:
        return 0.0
    return min(max(remaining / along, 0.0), 2.0 * channel.length_mm + LONGEST_MM)


def _places(
    pose: Rigid[Vertebra, Tool], channel: Channel, radius_mm: float, length_mm: float, ahead_mm: float
) -> Array:
    """Return points (s, r, 3) from `ahead_mm` before the tip back to the entry plane or the drill's end."""
    axis = channel_directions(channel).axis
    direction = pose.rotation[:, 2]
    along = float(direction @ axis)
    depth = float((pose.translation_mm - channel.entry_in_vertebra_mm) @ axis)
    posterior = min(length_mm, LONGEST_MM)
    if along > MIN_ALONG:
        # An oblique drill's rim reaches deeper than its axis.
        rim = radius_mm * float(np.sqrt(max(1.0 - along * along, 0.0)))
        posterior = min(posterior, (depth + rim) / along)
    if posterior + ahead_mm < 0.0:
        return np.empty((0, ROUND, 3))
    steps = np.linspace(ahead_mm, -posterior, max(int(np.ceil((ahead_mm + posterior) / APART_MM)), 1) + 1)
    ring = pose.translation_mm + radius_mm * (pose.rotation[:, :2] @ CIRCLE).T
    return np.asarray(ring[None] + steps[:, None, None] * direction)
