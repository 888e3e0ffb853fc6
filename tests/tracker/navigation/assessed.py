"""Drills assessed in a bone that a hand can measure: a rod of 5 mm radius, 55 mm deep, a drill of 2 mm."""

from functools import cache

import numpy as np

from tests.tracker.navigation.bones import ROD_CHANNEL, drill_at, rod
from tracker.navigation import Assessment, DrillLimits, Guide, assess, deviation_from_channel
from tracker.navigation.certainty import Judged, Placed, Room
from tracker.navigation.clearance import field_of_bone
from tracker.pose import ToolModel

DRILL_RADIUS_MM = 2.0
# 0.1 mm and 0.1 degrees in each direction.
SURE = np.diag([0.1**2] * 3 + [np.radians(0.1) ** 2] * 3)
LIMITS = DrillLimits(warning_distance_mm=1.0, breach_ratio=0.05)


@cache
def guide(room_mm: float = 1.8, lever_mm: float = 18.0) -> Guide:
    """The rod as bone, with this room for error."""
    return Guide(
        wall=field_of_bone(rod(), ROD_CHANNEL),
        room=Room(room_mm=room_mm, lever_mm=lever_mm),
        side="left",
    )


def drill(tool: str = "drill") -> ToolModel:
    """A drill of 2 mm radius whose marker is 100 mm behind its tip."""
    return ToolModel.from_tip_and_axis(
        name=tool,
        marker=tool,
        tip_in_marker_mm=[0.0, -100.0, 0.0],
        axis_in_marker=[0.0, -1.0, 0.0],
        radius_mm=DRILL_RADIUS_MM,
        length_mm=100.0,
    )


def judged_at(
    depth_mm: float,
    *,
    unsure: float = 1.0,
    room_mm: float = 1.8,
    **off: float,
) -> Judged:
    """The judgement of a drill at a depth, off by `medial_mm`, `cranial_mm`, `medial_deg`, `cranial_deg`.

    `unsure`: how many times as large its standard deviations are as 0.1 mm and 0.1 degrees.
    """
    placed = Placed(pose=drill_at(ROD_CHANNEL, depth_mm, **off), covariance=SURE * unsure**2)
    return guide(room_mm).judged(placed, drill(), ROD_CHANNEL)


def assessed_at(depth_mm: float, *, unsure: float = 1.0, room_mm: float = 1.8, **off: float) -> Assessment:
    """The assessment of such a drill."""
    return assess(
        deviation_from_channel(drill_at(ROD_CHANNEL, depth_mm, **off), ROD_CHANNEL, "left"),
        judged_at(depth_mm, unsure=unsure, room_mm=room_mm, **off),
        ROD_CHANNEL,
        LIMITS,
    )
