"""Assessments of drills in a simple bone: a rod of 5 mm radius, 55 mm deep, a drill of 2 mm radius."""

from functools import cache
from math import nan

import numpy as np

from tests.tracker.navigation.bones import ROD_CHANNEL, drill_at, rod
from tracker.navigation import Assessment, DrillLimits, DrillReference, assess, deviation_from_channel
from tracker.navigation.clearance import WallDistanceField, bone_distance_field
from tracker.navigation.uncertainty import DrillAnalysis, PedicleTolerance, UncertainPose
from tracker.pose import ToolModel

DRILL_RADIUS_MM = 2.0
# 0.1 mm and 0.1 degrees in each direction.
SURE = np.diag([0.1**2] * 3 + [np.radians(0.1) ** 2] * 3)
LIMITS = DrillLimits(warning_distance_mm=1.0, breach_ratio=0.05)


@cache
def _rod_wall() -> WallDistanceField:
    return bone_distance_field(rod(), ROD_CHANNEL)


def drill_reference(tolerance_mm: float = 1.8, lever_mm: float = 18.0) -> DrillReference:
    """The rod as bone, with this tolerance."""
    return DrillReference(
        wall=_rod_wall(),
        tolerance=PedicleTolerance(tolerance_mm=tolerance_mm, lever_mm=lever_mm),
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
    tolerance_mm: float = 1.8,
    **off: float,
) -> DrillAnalysis:
    """The assessment of a drill at a depth with these offsets and angles.

    `unsure`: factor of its standard deviations, relative to 0.1 mm and 0.1 degrees.

    """
    placed = UncertainPose(pose=drill_at(ROD_CHANNEL, depth_mm, **off), covariance=SURE * unsure**2)
    return drill_reference(tolerance_mm).analyse(placed, drill(), ROD_CHANNEL)


def assessed_at(
    depth_mm: float,
    *,
    unsure: float = 1.0,
    tolerance_mm: float = 1.8,
    min_error_95_mm: float = nan,
    **off: float,
) -> Assessment:
    """The assessment of such a drill."""
    return assess(
        deviation_from_channel(drill_at(ROD_CHANNEL, depth_mm, **off), ROD_CHANNEL, "left"),
        judged_at(depth_mm, unsure=unsure, tolerance_mm=tolerance_mm, **off),
        ROD_CHANNEL,
        LIMITS,
        min_error_95_mm=min_error_95_mm,
    )
