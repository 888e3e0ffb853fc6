"""Clearance of the whole drill, from a distance field that is computed once and sampled in each image.

field = select_wall(channel, surface, measure, radius_mm=...).wall  # once per channel: one to two seconds
rings = drill_rings(pose, channel, field, ...)  # per image: tens of microseconds
clearance = clearance_of_drill(rings, pose, channel)
"""

from tracker.navigation.clearance.distance_field import WallDistanceField, WallSource, bone_distance_field
from tracker.navigation.clearance.drill import (
    LOOKAHEAD_MM,
    DrillClearance,
    DrillRings,
    NearestWall,
    NotEntered,
    WallProximity,
    clearance_of_drill,
    drill_rings,
)
from tracker.navigation.clearance.outline_field import channel_distance_field, outline_distance_field
from tracker.navigation.clearance.planned_screw import screw_clearance_along
from tracker.navigation.clearance.rings import Rings
from tracker.navigation.clearance.wall_selection import WallSelection, planned_clearance_mm, select_wall

__all__ = [
    "LOOKAHEAD_MM",
    "DrillClearance",
    "DrillRings",
    "NearestWall",
    "NotEntered",
    "Rings",
    "WallDistanceField",
    "WallProximity",
    "WallSelection",
    "WallSource",
    "bone_distance_field",
    "channel_distance_field",
    "clearance_of_drill",
    "drill_rings",
    "outline_distance_field",
    "planned_clearance_mm",
    "screw_clearance_along",
    "select_wall",
]
