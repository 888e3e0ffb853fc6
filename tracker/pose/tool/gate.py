"""Acceptance limits of tool calibrations."""

from dataclasses import dataclass


@dataclass(frozen=True, slots=True, kw_only=True)
class ToolGate:
    """Acceptance limits of pivot calibration, spin calibration and tip check.

    Attributes:
        max_rms_3d_mm: 3-D RMS distance of the tip from the pivot, for pivot calibration and tip check.
        max_tip_sd_mm: standard deviation of the tip in its least certain direction.
        min_tilt_deg: rotation range about each of two directions, from end to end.
        min_poses: number of different poses.
        min_used_ratio: ratio of inlier poses.
        min_spin_deg: rotation range about the tool's axis.
        max_wobble_deg: RMS motion of the axis during the spin.
        max_axis_sd_deg: standard deviation of the axis.
    """

    max_rms_3d_mm: float = 0.8
    max_tip_sd_mm: float = 0.8
    min_tilt_deg: float = 15.0
    min_poses: int = 10
    min_used_ratio: float = 0.6
    min_spin_deg: float = 60.0
    max_wobble_deg: float = 5.0
    max_axis_sd_deg: float = 0.5
