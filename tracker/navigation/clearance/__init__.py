"""The clearance of the whole drill: distances to the bone made once, looked up in each image.

field = field_of_bone(surface, channel)          # once, when the channel is chosen: about a second
rings = drill_rings(pose, channel, field, ...)   # each image: tens of microseconds
clearance = clearance_of_drill(rings, pose, channel)
"""

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
    "Closest",
    "DrillClearance",
    "DrillRings",
    "MeasuredAgainst",
    "Nearest",
    "NotEntered",
    "Rings",
    "WallField",
    "clearance_of_drill",
    "drill_rings",
    "field_of_bone",
    "field_of_channel",
    "field_of_outline",
]
