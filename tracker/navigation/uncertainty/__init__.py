"""Propagation of uncertainty from marker, reference, registration and tool to the probability of a breach.

tool = camera_from_vertebra.inverse @ (camera_from_marker @ marker_from_tool(model))
analysis = analyse_drill(tool, channel, field, tolerance, ...)
"""

from tracker.navigation.uncertainty.analysis import Drill, DrillAnalysis, analyse_drill
from tracker.navigation.uncertainty.probability import Probability, past_planned_ratio, probability_of_breach
from tracker.navigation.uncertainty.propagation import (
    ELLIPSOID_95,
    DrillUncertainty,
    crossing_sds_mm,
    propagate_uncertainty,
    radius_95,
)
from tracker.navigation.uncertainty.tolerance import PedicleTolerance, ToleranceCheck, check_tolerance
from tracker.navigation.uncertainty.uncertain_pose import (
    UncertainPose,
    marker_from_tool,
)

__all__ = [
    "ELLIPSOID_95",
    "Drill",
    "DrillAnalysis",
    "DrillUncertainty",
    "PedicleTolerance",
    "Probability",
    "ToleranceCheck",
    "UncertainPose",
    "analyse_drill",
    "check_tolerance",
    "crossing_sds_mm",
    "marker_from_tool",
    "past_planned_ratio",
    "probability_of_breach",
    "propagate_uncertainty",
    "radius_95",
]
