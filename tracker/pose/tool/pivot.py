"""Pivot calibration: estimate the tip from poses of a tool tilted about its fixed tip.

For a real pointer, distances alone give 383 mm to the tip and rotations alone 394 mm. The tracker has
systematic errors, and noise models that weight one of the two more strongly stated a smaller uncertainty and
were less accurate. Residuals in mm therefore have equal weight unless covariances are given, although
weighting would halve the error where only angles are noisy.
"""

from dataclasses import dataclass
from enum import StrEnum

import numpy as np
import scipy

from tracker.errors import CalibrationError
from tracker.geometry import Array
from tracker.pose.second_order import second_order_variance_mm2
from tracker.pose.tool.equations import (
    Equations,
    Mask,
    best_half,
    covariance_of,
    least_trimmed_squares,
    max_allowed,
)
from tracker.pose.tool.gate import ToolGate
from tracker.pose.tool.motion_range import ToolMotionRange, min_rotation_deg, motion_range_of
from tracker.pose.tool.poses import Poses

# Lower bound of a pose's standard deviation at the tip, because the tip is not a point and the divot has
# play.
MIN_SD_MM = 0.1
MAX_ROUNDS = 30
# Poses that are inverted by mistake fit as well, with the pivot in the tracker's frame in place of the tip:
# as far away as the tracker, which is about 1 m for an optical one. Long pointers have 400 mm.
MAX_TIP_DISTANCE_MM = 600.0
PIVOT_REMEDY = (
    "Hold the tip in the divot, tilt the tool slowly to all sides by 20 degrees and more, "
    "and calibrate again."
)


class RejectedReason(StrEnum):
    """Reason why a pose is an outlier."""

    OFF_THE_PIVOT = "OFF_THE_PIVOT"  # its tip is farther from the pivot than noise explains
    OFF_THE_AXIS = "OFF_THE_AXIS"  # its axis points farther away from the mean than noise explains
    REPEATED = "REPEATED"  # equals an earlier pose exactly


@dataclass(frozen=True, slots=True, kw_only=True)
class RejectedPose:
    """An excluded pose: its index, the reason, and its deviation `off`."""

    index: int
    reason: RejectedReason
    off: float


@dataclass(frozen=True, slots=True, kw_only=True)
class PivotCalibration:
    """Result of a pivot calibration.

    Attributes:
        tip_in_marker_mm: (3,), the tip.
        pivot_in_camera_mm: (3,), the fixed position of the tip.
        rms_3d_mm: RMS distance of the tip from the pivot over the inlier poses.
        rms_3d_of_all_mm: the same over all poses.
        tip_covariance_mm2: (3, 3) in the marker's frame, scaled for a chi-square 95 % ellipsoid.
        pivot_covariance_mm2: (3, 3) in the camera's frame.
        used: (n,) mask of inlier poses.
        rejected: the outliers, with the reason; `off` is the tip's distance from the pivot in mm.
        motion_range: tilt and spin range over the inlier poses.
    """

    tip_in_marker_mm: Array
    pivot_in_camera_mm: Array
    rms_3d_mm: float
    rms_3d_of_all_mm: float
    tip_covariance_mm2: Array
    pivot_covariance_mm2: Array
    used: Mask
    rejected: tuple[RejectedPose, ...]
    motion_range: ToolMotionRange

    @property
    def tip_sd_mm(self) -> float:
        """Return the standard deviation of the tip in its least certain direction."""
        return float(np.sqrt(max(np.linalg.eigvalsh(self.tip_covariance_mm2)[-1], 0.0)))

    def failures(self, gate: ToolGate) -> tuple[CalibrationError, ...]:
        """Return the reasons why this tip fails the gate; empty where it passes."""
        found = []
        if not self.rms_3d_mm <= gate.max_rms_3d_mm:
            found.append(
                CalibrationError(
                    "PIVOT_RESIDUAL_TOO_LARGE",
                    f"the tip is {self.rms_3d_mm:.2f} mm from the pivot (3-D RMS), "
                    f"allowed {gate.max_rms_3d_mm:.2f} mm",
                    "Prevent the tip from slipping, hold the marker in good light near the camera, "
                    "and calibrate again.",
                    {"rms_3d_mm": self.rms_3d_mm, "allowed_mm": gate.max_rms_3d_mm},
                )
            )
        if not self.tip_sd_mm <= gate.max_tip_sd_mm:
            found.append(
                CalibrationError(
                    "PIVOT_TIP_UNCERTAIN",
                    f"the tip has a standard deviation of {self.tip_sd_mm:.2f} mm, "
                    f"allowed {gate.max_tip_sd_mm:.2f} mm",
                    "Take more poses, tilt farther to all sides, and calibrate again.",
                    {"tip_sd_mm": self.tip_sd_mm, "allowed_mm": gate.max_tip_sd_mm},
                )
            )
        tip_mm = float(np.linalg.norm(self.tip_in_marker_mm))
        if tip_mm > MAX_TIP_DISTANCE_MM:
            found.append(
                CalibrationError(
                    "PIVOT_TIP_FAR",
                    f"the tip lies {tip_mm:.0f} mm from the marker, allowed {MAX_TIP_DISTANCE_MM:.0f} mm",
                    "Check that the poses lead from the marker to camera or tracker, and are not inverted.",
                    {"tip_mm": tip_mm, "allowed_mm": MAX_TIP_DISTANCE_MM},
                )
            )
        compared = int(self.used.sum()) + len(
            [one for one in self.rejected if one.reason is RejectedReason.OFF_THE_PIVOT]
        )
        ratio = int(self.used.sum()) / compared
        if ratio < gate.min_used_ratio:
            found.append(
                CalibrationError(
                    "PIVOT_POSES_DISAGREE",
                    f"only {int(self.used.sum())} of {compared} poses agree on one pivot, "
                    f"needed {gate.min_used_ratio:.0%}",
                    "The tip slipped or was moved: calibrate again in one divot.",
                    {"used": int(self.used.sum()), "poses": compared, "needed_ratio": gate.min_used_ratio},
                )
            )
        return tuple(found)


def rms_3d_mm(tips_in_camera_mm: Array, pivot_in_camera_mm: Array) -> float:
    """Return the 3-D RMS distance of tip positions (n, 3) from the pivot (3,)."""
    return float(np.sqrt(((tips_in_camera_mm - pivot_in_camera_mm) ** 2).sum(axis=1).mean()))


def pivot_calibration(poses: Poses, gate: ToolGate | None = None) -> PivotCalibration:
    """Return the tip from poses of a tool that was tilted while its tip stayed in one place.

    Solves rotation @ tip + translation = pivot by robust least squares; up to nearly half of the poses may be
    outliers. With covariances, poses are weighted by them (standard deviation at least `MIN_SD_MM`, used as
    relative weights). Without, residuals in mm have equal weight, as in the published method (Yaniv 2015,
    "algebraic one-step"), because a wrong weighting of distance against angle biases the tip when the tracker
    has systematic errors.

    Noise of the angles biases the tip to second order. For residuals within the gate, the bias is a small
    part of the stated standard deviation.

    Raises:
        CalibrationError: TOOL_TOO_FEW_POSES, or PIVOT_TILT_TOO_SMALL where a direction is undetermined.
    """
    gate = gate or ToolGate()
    fresh = ~poses.repeats
    different = poses.of(fresh)
    reject_too_few(different, len(poses), gate)
    _reject_too_little_tilt(min_rotation_deg(different), gate)
    x, agree, weighed = _fitted(different)
    tips = different.points_mm(x[:3])
    used = np.zeros(len(poses), dtype=np.bool_)
    used[fresh] = agree
    off_mm = np.linalg.norm(tips - x[3:], axis=1)
    motion_range = motion_range_of(different.of(agree), x[:3])
    _reject_too_little_tilt(motion_range.min_rotation_deg, gate)
    covariance = covariance_of(weighed.of(agree), x, numbers=3)
    covariance.setflags(write=False)
    return PivotCalibration(
        tip_in_marker_mm=_fixed(x[:3]),
        pivot_in_camera_mm=_fixed(x[3:]),
        rms_3d_mm=rms_3d_mm(tips[agree], x[3:]),
        rms_3d_of_all_mm=rms_3d_mm(tips, x[3:]),
        tip_covariance_mm2=covariance[:3, :3],
        pivot_covariance_mm2=covariance[3:, 3:],
        used=used,
        rejected=rejected_poses(fresh, agree, off_mm, RejectedReason.OFF_THE_PIVOT),
        motion_range=motion_range,
    )


def provisional_tip_mm(poses: Poses) -> Array:
    """Return a rough tip (3,), possibly far off, from poses that do not suffice for a calibration."""
    return _equations(poses).solved()[:3]


def reject_too_few(different: Poses, count: int, gate: ToolGate) -> None:
    """Raise TOOL_TOO_FEW_POSES where a calibration needs more different poses."""
    if len(different) < gate.min_poses:
        raise CalibrationError(
            "TOOL_TOO_FEW_POSES",
            f"there are {len(different)} different poses of {count}, needed {gate.min_poses}",
            "Take more images while the tool moves; images of a tool at rest add no information.",
            {"different": len(different), "poses": count, "needed": gate.min_poses},
        )


def rejected_poses(fresh: Mask, agree: Mask, off: Array, reason: RejectedReason) -> tuple[RejectedPose, ...]:
    """Return the excluded poses by index: repeated ones and outliers."""
    found = [
        RejectedPose(index=int(index), reason=RejectedReason.REPEATED, off=0.0)
        for index in np.flatnonzero(~fresh)
    ]
    index_of = np.flatnonzero(fresh)
    found += [
        RejectedPose(index=int(index_of[one]), reason=reason, off=float(off[one]))
        for one in np.flatnonzero(~agree)
    ]
    return tuple(sorted(found, key=lambda one: one.index))


def _reject_too_little_tilt(rotation_deg: float, gate: ToolGate) -> None:
    if not rotation_deg >= gate.min_tilt_deg:
        raise CalibrationError(
            "PIVOT_TILT_TOO_SMALL",
            f"about one direction the tool was tilted by only {rotation_deg:.1f} degrees from end to end, "
            f"needed {gate.min_tilt_deg:g} degrees about each of two directions",
            PIVOT_REMEDY,
            {"turned_deg": rotation_deg, "needed_deg": gate.min_tilt_deg},
        )


def _fitted(poses: Poses) -> tuple[Array, Mask, Equations]:
    """Return tip and pivot (6,), the inlier mask, and the weighted equations."""
    plain = _equations(poses)
    x = least_trimmed_squares(plain)
    weighed = plain.whitened(_whitening(poses, x[:3]))
    agree = best_half(weighed.residuals(x))
    for _ in range(MAX_ROUNDS):
        residuals = weighed.residuals(x)
        now = np.linalg.norm(residuals, axis=1) <= max_allowed(residuals, agree)
        x = _least_squares(poses.of(now), plain.of(now), x)
        weighed = plain.whitened(_whitening(poses, x[:3]))
        if (now == agree).all():
            break
        agree = now
    return x, agree, weighed


def _equations(poses: Poses) -> Equations:
    pivot = np.broadcast_to(-np.eye(3), (len(poses), 3, 3))
    return Equations(
        design=np.concatenate([poses.rotations, pivot], axis=2), offset=np.asarray(poses.translations_mm)
    )


def _whitening(poses: Poses, tip_in_marker_mm: Array) -> Array:
    """Return the whitening matrices (n, 3, 3) of the tips; the identity without covariances."""
    if poses.covariances is None:
        return np.asarray(np.broadcast_to(np.eye(3), (len(poses), 3, 3)))
    x, y, z = (poses.rotations @ tip_in_marker_mm).T
    zero = np.zeros(len(poses))
    cross = np.array([[zero, -z, y], [z, zero, -x], [-y, x, zero]]).transpose(2, 0, 1)
    moved = np.concatenate([np.broadcast_to(np.eye(3), cross.shape), -cross], axis=2)
    arc = second_order_variance_mm2(poses.covariances, float(np.linalg.norm(tip_in_marker_mm)))
    noise = moved @ poses.covariances @ moved.transpose(0, 2, 1)
    noise = noise + (arc[:, None, None] + MIN_SD_MM**2) * np.eye(3)
    return np.asarray(np.linalg.inv(np.linalg.cholesky(noise)), dtype=float)


def _least_squares(poses: Poses, plain: Equations, x: Array) -> Array:
    if poses.covariances is None:
        return plain.solved()
    # The weights depend on the tip. With constant weights, noise of the angles would bias it towards the
    # marker.
    fit = scipy.optimize.least_squares(
        lambda at: plain.whitened(_whitening(poses, at[:3])).residuals(at).ravel(),
        x,
        x_scale="jac",
        method="lm",
    )
    return np.asarray(fit.x)


def _fixed(array: Array) -> Array:
    copied = np.array(array)
    copied.setflags(write=False)
    return copied
