"""Accuracy of a tracked tool, measured with its tip in the divots of a plate (ASTM F2554)."""

from tracker.accuracy.assessment import (
    AccuracyAssessment,
    AccuracyLimits,
    PlateScale,
    assess_accuracy,
    plate_problems,
)
from tracker.accuracy.capture import DivotCapture, RestLimits, capture_at_rest
from tracker.accuracy.faults import Diagnosis, Fault, FaultEstimate
from tracker.accuracy.figures import DivotError, Figure, FigureName, Figures
from tracker.accuracy.marker_geometry import TrackedTool
from tracker.accuracy.plate import DivotPlate
from tracker.accuracy.plate_fit import reject_wrong_divot
from tracker.accuracy.statistics import Estimate
from tracker.accuracy.volume import VolumeMap, volume_map

__all__ = [
    "AccuracyAssessment",
    "AccuracyLimits",
    "Diagnosis",
    "DivotCapture",
    "DivotError",
    "DivotPlate",
    "Estimate",
    "Fault",
    "FaultEstimate",
    "Figure",
    "FigureName",
    "Figures",
    "PlateScale",
    "RestLimits",
    "TrackedTool",
    "VolumeMap",
    "assess_accuracy",
    "capture_at_rest",
    "plate_problems",
    "reject_wrong_divot",
    "volume_map",
]
