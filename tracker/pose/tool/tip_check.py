"""Tip check: measure the spread of a calibrated tip held in one divot while the tool is tilted."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.errors import CalibrationError, InvalidInput
from tracker.geometry import Array
from tracker.pose.tool.gate import ToolGate
from tracker.pose.tool.motion_range import ToolMotionRange, motion_range_of
from tracker.pose.tool.pivot import reject_too_few, rms_3d_mm
from tracker.pose.tool.poses import Poses


@dataclass(frozen=True, slots=True, kw_only=True)
class TipCheck:
    """Spread of the calibrated tip over the poses of a tip check.

    Attributes:
        pivot_in_camera_mm: (3,), the mean position of the tip.
        rms_3d_mm: 3-D RMS distance of the tip from it, over all poses.
        max_mm: the largest distance.
        rms_by_axis_mm: (3,), along x, y, z of the camera.
        poses: number of different poses.
        motion_range: tilt and spin range of the tool.
    """

    pivot_in_camera_mm: Array
    rms_3d_mm: float
    max_mm: float
    rms_by_axis_mm: Array
    poses: int
    motion_range: ToolMotionRange

    def failures(self, gate: ToolGate) -> tuple[CalibrationError, ...]:
        """Return the reasons why this tip fails the gate; empty where it passes."""
        if self.rms_3d_mm <= gate.max_rms_3d_mm:
            return ()
        return (
            CalibrationError(
                "TIP_CHECK_FAILED",
                f"the tip moves by {self.rms_3d_mm:.2f} mm (3-D RMS) and by {self.max_mm:.2f} mm "
                f"at most, allowed {gate.max_rms_3d_mm:.2f} mm (3-D RMS)",
                "Check that neither the tool nor its marker is bent or loose, and calibrate the tip again.",
                {"rms_3d_mm": self.rms_3d_mm, "max_mm": self.max_mm, "allowed_mm": gate.max_rms_3d_mm},
            ),
        )


def check_tip(poses: Poses, tip_in_marker_mm: npt.ArrayLike, gate: ToolGate | None = None) -> TipCheck:
    """Return the spread of a tip (3,) over poses in which it was held in one place.

    A wrong tip also stays in one place if the tool is not tilted, so a check with too little tilt is
    rejected.

    Raises:
        InvalidInput: TOOL_TIP_INVALID.
        CalibrationError: TOOL_TOO_FEW_POSES, or TIP_CHECK_TILT_TOO_SMALL.
    """
    gate = gate or ToolGate()
    tip = np.asarray(tip_in_marker_mm, dtype=np.float64)
    if tip.shape != (3,) or not np.isfinite(tip).all():
        raise InvalidInput(
            "TOOL_TIP_INVALID",
            f"the tip is {tip.tolist()}, needed three numbers in mm",
            "Give the tip in the marker's frame, as pivot calibration returns it.",
            {"tip": tip.tolist()},
        )
    different = poses.of(~poses.repeats)
    reject_too_few(different, len(poses), gate)
    motion_range = motion_range_of(different, tip)
    if not motion_range.min_rotation_deg >= gate.min_tilt_deg:
        raise CalibrationError(
            "TIP_CHECK_TILT_TOO_SMALL",
            f"about one direction the tool was tilted by only {motion_range.min_rotation_deg:.1f} degrees "
            f"from end to end, needed {gate.min_tilt_deg:g}: a wrong tip would not be detected",
            "Keep the tip in the divot, tilt the tool to all sides, and check again.",
            {"turned_deg": motion_range.min_rotation_deg, "needed_deg": gate.min_tilt_deg},
        )
    tips = different.points_mm(tip)
    pivot = tips.mean(axis=0)
    by_axis = np.sqrt(((tips - pivot) ** 2).mean(axis=0))
    for array in (pivot, by_axis):
        array.setflags(write=False)
    return TipCheck(
        pivot_in_camera_mm=pivot,
        rms_3d_mm=rms_3d_mm(tips, pivot),
        max_mm=float(np.linalg.norm(tips - pivot, axis=1).max()),
        rms_by_axis_mm=by_axis,
        poses=len(different),
        motion_range=motion_range,
    )
