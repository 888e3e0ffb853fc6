"""Spin calibration: estimate the axis from poses of a tool rotated about it."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.errors import CalibrationError, InvalidInput
from tracker.geometry import Array, angle_between_deg
from tracker.pose.tool.equations import (
    Equations,
    Mask,
    best_half,
    covariance_of,
    max_allowed,
)
from tracker.pose.tool.gate import ToolGate
from tracker.pose.tool.motion_range import spin_range_deg
from tracker.pose.tool.pivot import RejectedPose, RejectedReason, reject_too_few, rejected_poses
from tracker.pose.tool.poses import Poses

# The tip lies on the axis, so a larger angle to the direction of the tip means another motion.
MAX_OFF_TIP_DEG = 60.0
MAX_ROUNDS = 30
REWEIGHTINGS = 30
SPIN_REMEDY = (
    "Keep the tip in the divot and the handle still, rotate the tool about its axis by 180 degrees, or as "
    "far as the marker stays in view, and calibrate again."
)


@dataclass(frozen=True, slots=True, kw_only=True)
class SpinCalibration:
    """Result of a spin calibration: the tool's axis in its marker's frame.

    Attributes:
        axis_in_marker: (3,), unit vector, from the marker towards the tip where the tip is known.
        points_to_tip: whether the tip determined the sign; if not, the axis may point backwards.
        axis_covariance_rad2: (3, 3) in the marker's frame, singular along the axis.
        axis_sd_deg: standard deviation in its least certain direction.
        spin_range_deg: rotation range about the axis.
        wobble_deg: RMS angle of the axis from its mean direction in the camera's frame, over inlier poses.
        used: (n,) mask of inlier poses.
        rejected: the outliers, with the reason; `off` in degrees.
    """

    axis_in_marker: Array
    points_to_tip: bool
    axis_covariance_rad2: Array
    axis_sd_deg: float
    spin_range_deg: float
    wobble_deg: float
    used: Mask
    rejected: tuple[RejectedPose, ...]

    def failures(self, gate: ToolGate) -> tuple[CalibrationError, ...]:
        """Return the reasons why this axis fails the gate; empty where it passes."""
        if self.axis_sd_deg <= gate.max_axis_sd_deg:
            return ()
        return (
            CalibrationError(
                "SPIN_AXIS_UNCERTAIN",
                f"the axis has a standard deviation of {self.axis_sd_deg:.2f} degrees, "
                f"allowed {gate.max_axis_sd_deg:.2f}",
                SPIN_REMEDY,
                {"axis_sd_deg": self.axis_sd_deg, "allowed_deg": gate.max_axis_sd_deg},
            ),
        )


def spin_calibration(
    poses: Poses, *, tip_in_marker_mm: npt.ArrayLike | None = None, gate: ToolGate | None = None
) -> SpinCalibration:
    """Return the axis of a tool that was rotated about it: the direction of the marker with minimum variance.

    The tip (3,), if known, determines the sign: the drilling direction is from the marker towards the tip.

    Raises:
        CalibrationError: TOOL_TOO_FEW_POSES, SPIN_TOO_SMALL, SPIN_WOBBLES, or SPIN_NOT_ABOUT_TOOL.
    """
    gate = gate or ToolGate()
    fresh = ~poses.repeats
    different = poses.of(fresh)
    reject_too_few(different, len(poses), gate)
    axis, agree = _fitted(different)
    if tip_in_marker_mm is not None:
        axis = _towards_tip(axis, np.asarray(tip_in_marker_mm, dtype=np.float64))
    spun = different.of(agree)
    spin_deg = spin_range_deg(spun, axis)
    off_deg = _off_deg(different, axis, agree)
    wobble_deg = float(np.sqrt((off_deg[agree] ** 2).mean()))
    _reject_other_motions(spin_deg, wobble_deg, gate)
    equations, across = _around(spun, axis)
    x = np.concatenate([np.zeros(2), _mean_direction(spun, axis)])
    covariance = covariance_of(equations, x, numbers=2)[:2, :2]
    used = np.zeros(len(poses), dtype=np.bool_)
    used[fresh] = agree
    return SpinCalibration(
        axis_in_marker=_fixed(axis),
        points_to_tip=tip_in_marker_mm is not None,
        axis_covariance_rad2=_fixed(across @ covariance @ across.T),
        axis_sd_deg=float(np.degrees(np.sqrt(np.linalg.eigvalsh(covariance)[-1]))),
        spin_range_deg=spin_deg,
        wobble_deg=wobble_deg,
        used=used,
        rejected=rejected_poses(fresh, agree, off_deg, RejectedReason.OFF_THE_AXIS),
    )


def min_variance_direction(poses: Poses) -> Array:
    """Return the unit direction (3,) of the marker that moved least over the poses."""
    return _direction_of_min_variance(poses, np.ones(len(poses)))


def _fitted(poses: Poses) -> tuple[Array, Mask]:
    """Return the direction (3,) of the marker that moved least, and the inlier mask."""
    axis = _direction_of_min_variance(poses, np.ones(len(poses)))
    for _ in range(REWEIGHTINGS):
        # Weights by the inverse distance give a geometric median, which is robust to outliers.
        off = np.linalg.norm(poses.rotations @ axis - _middle(poses.rotations @ axis), axis=1)
        axis = _direction_of_min_variance(poses, 1.0 / np.maximum(off, 1e-4))
    residuals = poses.rotations @ axis - _middle(poses.rotations @ axis)
    agree = best_half(residuals)
    for _ in range(MAX_ROUNDS):
        residuals = poses.rotations @ axis - (poses.rotations[agree] @ axis).mean(axis=0)
        now = np.linalg.norm(residuals, axis=1) <= max_allowed(residuals, agree)
        axis = _direction_of_min_variance(poses.of(now), np.ones(int(now.sum())))
        if (now == agree).all():
            break
        agree = now
    return axis, agree


def _direction_of_min_variance(poses: Poses, weights: Array) -> Array:
    """Return the unit direction (3,) of the marker with the smallest weighted variance."""
    share = weights / weights.sum()
    off = poses.rotations - np.tensordot(share, poses.rotations, 1)
    moved = np.einsum("n,nij,nik->jk", share, off, off)
    return np.asarray(np.linalg.eigh(moved)[1][:, 0])


def _middle(directions: Array) -> Array:
    return np.asarray(np.median(directions, axis=0))


def _mean_direction(poses: Poses, axis: Array) -> Array:
    return np.asarray((poses.rotations @ axis).mean(axis=0))


def _off_deg(poses: Poses, axis: Array, agree: Mask) -> Array:
    mean = _mean_direction(poses.of(agree), axis)
    return np.array([angle_between_deg(direction, mean) for direction in poses.rotations @ axis])


def _around(poses: Poses, axis: Array) -> tuple[Equations, Array]:
    """Return equations of two tilts and the mean direction of the axis (5,), and the tilt basis (3, 2)."""
    across = np.linalg.svd(axis[None, :])[2][1:].T
    mean = np.broadcast_to(-np.eye(3), (len(poses), 3, 3))
    design = np.concatenate([poses.rotations @ across, mean], axis=2)
    return Equations(design=design, offset=poses.rotations @ axis), across


def _towards_tip(axis: Array, tip_in_marker_mm: Array) -> Array:
    length = float(np.linalg.norm(tip_in_marker_mm))
    if tip_in_marker_mm.shape != (3,) or not np.isfinite(tip_in_marker_mm).all() or length < 1.0:
        raise InvalidInput(
            "TOOL_TIP_INVALID",
            f"the tip is {tip_in_marker_mm.tolist()}, which determines no direction from the marker",
            "Give the tip as three numbers in mm in the marker's frame, as pivot calibration returns it.",
            {"tip": tip_in_marker_mm.tolist()},
        )
    off_deg = angle_between_deg(axis, tip_in_marker_mm)
    nearer_deg = min(off_deg, 180.0 - off_deg)
    if nearer_deg > MAX_OFF_TIP_DEG:
        raise CalibrationError(
            "SPIN_NOT_ABOUT_TOOL",
            f"the axis of this motion is {nearer_deg:.0f} degrees from the direction to the tip, "
            f"allowed {MAX_OFF_TIP_DEG:g}: the tool was tilted, not spun",
            SPIN_REMEDY,
            {"off_deg": nearer_deg, "allowed_deg": MAX_OFF_TIP_DEG},
        )
    return axis if off_deg < 90.0 else -axis


def _reject_other_motions(spin_deg: float, wobble_deg: float, gate: ToolGate) -> None:
    context: dict[str, object] = {
        "spin_range_deg": spin_deg,
        "min_spin_deg": gate.min_spin_deg,
        "wobble_deg": wobble_deg,
        "max_wobble_deg": gate.max_wobble_deg,
    }
    if not wobble_deg <= gate.max_wobble_deg:
        raise CalibrationError(
            "SPIN_WOBBLES",
            f"the axis moved by {wobble_deg:.1f} degrees (RMS) while the tool was spun by {spin_deg:.0f}, "
            f"allowed {gate.max_wobble_deg:g}",
            SPIN_REMEDY,
            context,
        )
    if not spin_deg >= gate.min_spin_deg:
        raise CalibrationError(
            "SPIN_TOO_SMALL",
            f"the tool was spun by {spin_deg:.0f} degrees, needed {gate.min_spin_deg:g}",
            SPIN_REMEDY,
            context,
        )


def _fixed(array: Array) -> Array:
    copied = np.array(array)
    copied.setflags(write=False)
    return copied
