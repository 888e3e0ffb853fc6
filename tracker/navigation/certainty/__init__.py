"""Uncertainty carried through: from marker, reference, registration and tool to the chance of a breach.

tool = camera_from_vertebra.inverse @ (camera_from_marker @ marker_from_tool(model))
judged = judge(tool, channel, field, room, ...)
"""

from tracker.navigation.certainty.certain import Certain, Room, certain_for
from tracker.navigation.certainty.chance import Chance, chance_of_breach, past_planned_ratio
from tracker.navigation.certainty.judged import Drill, Judged, judge
from tracker.navigation.certainty.placed import (
    Placed,
    marker_from_tool,
)
from tracker.navigation.certainty.spread import Spread, crossing_sds_mm, radius_95, spread_of

__all__ = [
    "Certain",
    "Chance",
    "Drill",
    "Judged",
    "Placed",
    "Room",
    "Spread",
    "certain_for",
    "chance_of_breach",
    "crossing_sds_mm",
    "judge",
    "marker_from_tool",
    "past_planned_ratio",
    "radius_95",
    "spread_of",
]
