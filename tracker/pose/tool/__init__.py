"""The instrument behind its marker: its tip by pivoting, its axis by spinning, and the check of both."""

from tracker.pose.tool.collector import (
    CollectorSettings,
    Missing,
    Need,
    PoseCollector,
    Progress,
    Purpose,
    Taking,
)
from tracker.pose.tool.gate import ToolGate
from tracker.pose.tool.model import ToolModel
from tracker.pose.tool.pivot import (
    PivotCalibration,
    RejectedPose,
    RejectedReason,
    pivot_calibration,
    rms_3d_mm,
)
from tracker.pose.tool.poses import Poses
from tracker.pose.tool.spin import SpinCalibration, spin_calibration
from tracker.pose.tool.tip_check import TipCheck, check_tip
from tracker.pose.tool.turning import Turning
from tracker.pose.tool.written import rigid_from_quaternion, rigid_from_written

__all__ = [
    "CollectorSettings",
    "Missing",
    "Need",
    "PivotCalibration",
    "PoseCollector",
    "Poses",
    "Progress",
    "Purpose",
    "RejectedPose",
    "RejectedReason",
    "SpinCalibration",
    "Taking",
    "TipCheck",
    "ToolGate",
    "ToolModel",
    "Turning",
    "check_tip",
    "pivot_calibration",
    "rigid_from_quaternion",
    "rigid_from_written",
    "rms_3d_mm",
    "spin_calibration",
]
