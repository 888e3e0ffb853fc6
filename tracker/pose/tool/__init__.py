"""Tool calibration: the tip by pivot calibration, the axis by spin calibration, and the tip check."""

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
from tracker.pose.tool.motion_range import ToolMotionRange
from tracker.pose.tool.pivot import (
    PivotCalibration,
    RejectedPose,
    RejectedReason,
    pivot_calibration,
    rms_3d_mm,
)
from tracker.pose.tool.pose_parsing import rigid_from_matrix, rigid_from_quaternion
from tracker.pose.tool.poses import Poses
from tracker.pose.tool.spin import SpinCalibration, spin_calibration
from tracker.pose.tool.tip_check import TipCheck, check_tip

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
    "ToolMotionRange",
    "check_tip",
    "pivot_calibration",
    "rigid_from_matrix",
    "rigid_from_quaternion",
    "rms_3d_mm",
    "spin_calibration",
]
