"""The clearance of the whole drill: distances to the bone made once, looked up in each image.

field = choose_wall(channel, surface, measure, radius_mm=...).wall    # once for a channel: a second or two
rings = drill_rings(pose, channel, field, ...)    # each image: tens of microseconds
clearance = clearance_of_drill(rings, pose, channel)
"""

from tracker.navigation.clearance.choice import ChosenWall, choose_wall, on_plan_mm
from tracker.navigation.clearance.drill import (
    SOON_MM,
    Closest,
    DrillClearance,
    DrillRings,
    Nearest,
    NotEntered,
    clearance_of_drill,
    drill_rings,
)
from tracker.navigation.clearance.field import MeasuredAgainst, WallField, field_of_bone
from tracker.navigation.clearance.outline import field_of_channel, field_of_outline
from tracker.navigation.clearance.rings import Rings

__all__ = [
    "SOON_MM",
    "ChosenWall",
    "Closest",
    "DrillClearance",
    "DrillRings",
    "MeasuredAgainst",
    "Nearest",
    "NotEntered",
    "Rings",
    "WallField",
    "choose_wall",
    "clearance_of_drill",
    "drill_rings",
    "field_of_bone",
    "field_of_channel",
    "field_of_outline",
    "on_plan_mm",
]
