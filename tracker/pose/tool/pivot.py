"""Pivot calibration: the tool is tilted with its tip held, and its marker tells where that tip is.

Distances alone give 383 mm to the tip of a real pointer, rotations alone 394: the tracker errs
systematically, and noise models that trust one of the two were more certain and farther off. So every
millimetre counts alike unless covariances are stated, at the price of half of the error where noise is of
angles only.
"""

from dataclasses import dataclass
from enum import StrEnum

import numpy as np
from scipy import optimize

from tracker.errors import CalibrationError
from tracker.geometry import Array
from tracker.pose.tool.equations import (
    Equations,
    Mask,
    covariance_of,
    half_that_fits,
    max_allowed,
    robust_start,
)
from tracker.pose.tool.gate import ToolGate
from tracker.pose.tool.poses import Poses
from tracker.pose.tool.turning import Turning, min_turn_deg, turning_of

# A tip is no point and a divot has play: no pose is believed better than this, whatever it states of itself.
MIN_SD_MM = 0.1
MAX_ROUNDS = 30
PIVOT_REMEDY = (
    "Hold the tip in the divot, tilt the tool slowly to all sides by 20 degrees and more, "
    "and calibrate again."
)


class RejectedReason(StrEnum):
    """Why a pose has no say."""

    OFF_THE_PIVOT = "OFF_THE_PIVOT"  # its tip is farther from the pivot than noise explains
    OFF_THE_AXIS = "OFF_THE_AXIS"  # its axis points farther away from the mean than noise explains
    REPEATED = "REPEATED"  # to the last digit an earlier pose


@dataclass(frozen=True, slots=True, kw_only=True)
class RejectedPose:
    """A pose that has no say: its index, why, and how far it is off."""

    index: int
    reason: RejectedReason
    off: float


@dataclass(frozen=True, slots=True, kw_only=True)
class PivotCalibration:
    """Where the tip is behind its marker.

    Attributes:
        tip_in_marker_mm: (3,).
        pivot_in_camera_mm: (3,), where the tip was held.
        rms_3d_mm: root of the mean squared distance of the tip from the pivot, over the poses in use.
        rms_3d_of_all_mm: the same over all poses.
        tip_covariance_mm2: (3, 3) in the marker's frame; its 95 % ellipsoid (chi-square) is meant.
        pivot_covariance_mm2: (3, 3) in the camera's frame.
        used: (n,) which poses agree.
        rejected: the others, with the reason; `off` is the tip's distance from the pivot in mm.
        turning: how far the tool was moved in the poses in use.
    """

    tip_in_marker_mm: Array
    pivot_in_camera_mm: Array
    rms_3d_mm: float
    rms_3d_of_all_mm: float
    tip_covariance_mm2: Array
    pivot_covariance_mm2: Array
    used: Mask
    rejected: tuple[RejectedPose, ...]
    turning: Turning

    @property
    def tip_sd_mm(self) -> float:
        """Standard deviation of the tip in the direction in which it is known least."""
        return float(np.sqrt(max(np.linalg.eigvalsh(self.tip_covariance_mm2)[-1], 0.0)))

    def failures(self, gate: ToolGate) -> tuple[CalibrationError, ...]:
        """What keeps this tip from being used; nothing where it passes."""
        found = []
        if not self.rms_3d_mm <= gate.max_rms_3d_mm:
            found.append(
                CalibrationError(
                    "PIVOT_RESIDUAL_TOO_LARGE",
                    f"the tip stays within {self.rms_3d_mm:.2f} mm of the pivot (3-D RMS), "
                    f"allowed {gate.max_rms_3d_mm:.2f} mm",
                    "Keep the tip from slipping, hold the marker in good light and near the camera, "
                    "and calibrate again.",
                    {"rms_3d_mm": self.rms_3d_mm, "allowed_mm": gate.max_rms_3d_mm},
                )
            )
        if not self.tip_sd_mm <= gate.max_tip_sd_mm:
            found.append(
                CalibrationError(
                    "PIVOT_TIP_UNCERTAIN",
                    f"the tip is known to {self.tip_sd_mm:.2f} mm (standard deviation), "
                    f"allowed {gate.max_tip_sd_mm:.2f} mm",
                    "Take more poses, tilt farther to all sides, and calibrate again.",
                    {"tip_sd_mm": self.tip_sd_mm, "allowed_mm": gate.max_tip_sd_mm},
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
                    "The tip slipped or was moved to another place: calibrate again in one divot.",
                    {"used": int(self.used.sum()), "poses": compared},
                )
            )
        return tuple(found)


def rms_3d_mm(tips_in_camera_mm: Array, pivot_in_camera_mm: Array) -> float:
    """The one residual of a tip: root of the mean squared distance of its places (n, 3) from the pivot."""
    return float(np.sqrt(((tips_in_camera_mm - pivot_in_camera_mm) ** 2).sum(axis=1).mean()))


def pivot_calibration(poses: Poses, gate: ToolGate | None = None) -> PivotCalibration:
    """The tip from poses of a tool that was tilted while its tip stayed in one place.

    Each pose says rotation @ tip + translation = pivot. Poses that contradict the others have no say, up to
    nearly half of them. Where poses state covariances they count by these (no better than `MIN_SD_MM`, and
    only compared with each other); where not, every millimetre counts alike, as in the published method
    (Yaniv 2015, "algebraic one-step"), since a guess at which of distance and angle is truer shifts a tip
    when the tracker errs in a system.

    Noise of the angles pulls the tip by its square: under the residual that the gate allows that is a small
    part of the stated standard deviation, above it not.

    Raises:
        CalibrationError: TOOL_TOO_FEW_POSES, or PIVOT_TILT_TOO_SMALL where a direction stays open.
    """
    gate = gate or ToolGate()
    fresh = ~poses.repeats
    different = poses.of(fresh)
    reject_too_few(different, len(poses), gate)
    _reject_too_little_tilt(min_turn_deg(different), gate)
    x, agree, weighed = _fitted(different)
    tips = different.points_mm(x[:3])
    used = np.zeros(len(poses), dtype=np.bool_)
    used[fresh] = agree
    off_mm = np.linalg.norm(tips - x[3:], axis=1)
    turning = turning_of(different.of(agree), x[:3])
    _reject_too_little_tilt(turning.min_turn_deg, gate)
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
        turning=turning,
    )


def provisional_tip_mm(poses: Poses) -> Array:
    """A tip (3,) that may be far off, of poses that are too few or too alike for a calibration."""
    return _equations(poses).solved()[:3]


def reject_too_few(different: Poses, count: int, gate: ToolGate) -> None:
    """Raises TOOL_TOO_FEW_POSES where fewer different poses are left than a calibration needs."""
    if len(different) < gate.min_poses:
        raise CalibrationError(
            "TOOL_TOO_FEW_POSES",
            f"there are {len(different)} different poses of {count}, needed {gate.min_poses}",
            "Take more images while the tool moves; images in which it stands still say nothing new.",
            {"different": len(different), "poses": count, "needed": gate.min_poses},
        )


def rejected_poses(fresh: Mask, agree: Mask, off: Array, reason: RejectedReason) -> tuple[RejectedPose, ...]:
    """Those that have no say, in order: repeated ones, and of the others those that do not agree."""
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


def _reject_too_little_tilt(turn_deg: float, gate: ToolGate) -> None:
    if not turn_deg >= gate.min_tilt_deg:
        raise CalibrationError(
            "PIVOT_TILT_TOO_SMALL",
            f"about one direction the tool was turned by only {turn_deg:.1f} degrees from end to end, "
            f"needed {gate.min_tilt_deg:g} degrees about each of two directions",
            PIVOT_REMEDY,
            {"turned_deg": turn_deg, "needed_deg": gate.min_tilt_deg},
        )


def _fitted(poses: Poses) -> tuple[Array, Mask, Equations]:
    """Tip and pivot (6,), which poses agree, and the equations as they count."""
    plain = _equations(poses)
    x = robust_start(plain)
    weighed = plain.whitened(_whitening(poses, x[:3]))
    agree = half_that_fits(weighed.residuals(x))
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
    """(n, 3, 3): what makes the noise of each tip a unit ball; the identity where nothing is stated."""
    if poses.covariances is None:
        return np.asarray(np.broadcast_to(np.eye(3), (len(poses), 3, 3)))
    x, y, z = (poses.rotations @ tip_in_marker_mm).T
    zero = np.zeros(len(poses))
    cross = np.array([[zero, -z, y], [z, zero, -x], [-y, x, zero]]).transpose(2, 0, 1)
    moved = np.concatenate([np.broadcast_to(np.eye(3), cross.shape), -cross], axis=2)
    noise = moved @ poses.covariances @ moved.transpose(0, 2, 1) + MIN_SD_MM**2 * np.eye(3)
    return np.asarray(np.linalg.inv(np.linalg.cholesky(noise)))


def _least_squares(poses: Poses, plain: Equations, x: Array) -> Array:
    if poses.covariances is None:
        return plain.solved()
    # The weights move with the tip: kept still, noise of the angles would pull it to the marker.
    fit = optimize.least_squares(
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
