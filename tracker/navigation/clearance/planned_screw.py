"""Clearance of the planned screw to the bone by depth."""

import numpy as np

from tracker.geometry import Rigid, Tool, Vertebra, rotation_between
from tracker.navigation.clearance.distance_field import WallDistanceField
from tracker.navigation.clearance.rings import rings_to_wall
from tracker.plan.channel import Channel
from tracker.plan.screw import ClearanceAlong


def screw_clearance_along(
    channel: Channel, wall: WallDistanceField, *, diameter_mm: float, length_mm: float
) -> ClearanceAlong | None:
    """Return the clearance of a screw on the channel's axis to a wall, in steps of about 1 mm.

    As for the drill, points count from 2 mm past the posterior surface. None if none of the screw does.
    """
    axis = channel.axis_in_vertebra
    at_end: Rigid[Vertebra, Tool] = Rigid(
        rotation=rotation_between([0.0, 0.0, 1.0], axis),
        translation_mm=channel.entry_in_vertebra_mm + length_mm * axis,
    )
    rings = rings_to_wall(at_end, channel, wall, radius_mm=0.5 * diameter_mm, length_mm=length_mm)
    # From the end backwards; a ring that is only partly past the surface counts with that part.
    clearance = rings.clearance_mm.min(axis=1)[::-1]
    depth = ((rings.points_mm.mean(axis=1) - channel.entry_in_vertebra_mm) @ axis)[::-1]
    counts = np.isfinite(clearance)
    if not counts.any():
        return None
    return ClearanceAlong(depth_mm=depth[counts], clearance_mm=clearance[counts])
