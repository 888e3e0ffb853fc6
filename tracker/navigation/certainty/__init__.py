"""Uncertainty carried through: from marker, reference, registration and tool to the chance of a breach.

tool = camera_from_vertebra.inverse @ (camera_from_marker @ marker_from_tool(model))
judged = judge(tool, channel, field, room, ...)
"""

from tracker.navigation.certainty.certain import Certain, Room, certain_for
from tracker.navigation.certainty.judged import Drill, Judged, judge
from tracker.navigation.certainty.placed import (
    Placed,
    marker_from_tool,
)
from tracker.navigation.certainty.probability import Probability, past_planned_ratio, probability_of_breach
from tracker.navigation.certainty.spread import Spread, crossing_sds_mm, radius_95, spread_of

__all__ = [
    "Certain",
    "Drill",
    "Judged",
    "Placed",
    "Probability",
    "Room",
    "Spread",
    "certain_for",
    "crossing_sds_mm",
    "judge",
    "marker_from_tool",
    "past_planned_ratio",
    "probability_of_breach",
    "radius_95",
    "spread_of",
]
