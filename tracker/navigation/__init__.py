"""Navigation: the deviation of the drill from the planned channel, and the state of one image."""

from tracker.navigation.assessment import Assessment, Correction, Direction, Lag, Verdict, assess
from tracker.navigation.bullseye import BullseyeView, bullseye_view, half_axes_95_mm
from tracker.navigation.deviation import Deviation, deviation_from_channel
from tracker.navigation.drill_reference import DrillReference, ScrewSize
from tracker.navigation.figures import DrillLimits, Figure, FigureName, Status
from tracker.navigation.lag import LagEstimator, MeasuredLatency
from tracker.navigation.motion_detection import MotionDetection, motion_detected_by
from tracker.navigation.motion_monitor import MotionMonitor
from tracker.navigation.nearest_channel import NearestChannelMonitor
from tracker.navigation.placed_screw import PlacedScrew
from tracker.navigation.registration_check import (
    RegistrationCheck,
    check_registration,
    check_setup,
    min_errors_95_mm,
)
from tracker.navigation.snapshot import (
    Absent,
    AbsentReason,
    MotionState,
    NavigationSnapshot,
    Setup,
    ToolPose,
    VertebraPose,
)
from tracker.navigation.snapshot_builder import navigate
from tracker.navigation.tool_smoothing import ToolSmoothing

__all__ = [
    "Absent",
    "AbsentReason",
    "Assessment",
    "BullseyeView",
    "Correction",
    "Deviation",
    "Direction",
    "DrillLimits",
    "DrillReference",
    "Figure",
    "FigureName",
    "Lag",
    "LagEstimator",
    "MeasuredLatency",
    "MotionDetection",
    "MotionMonitor",
    "MotionState",
    "NavigationSnapshot",
    "NearestChannelMonitor",
    "PlacedScrew",
    "RegistrationCheck",
    "ScrewSize",
    "Setup",
    "Status",
    "ToolPose",
    "ToolSmoothing",
    "Verdict",
    "VertebraPose",
    "assess",
    "bullseye_view",
    "check_registration",
    "check_setup",
    "deviation_from_channel",
    "half_axes_95_mm",
    "min_errors_95_mm",
    "motion_detected_by",
    "navigate",
]
