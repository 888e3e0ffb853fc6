"""Collect poses for a tool calibration: accept informative ones, and report unmet requirements."""

from collections import Counter, deque
from collections.abc import Mapping
from dataclasses import dataclass, field
from enum import StrEnum
from typing import TypeAlias

import numpy as np

from tracker.errors import CalibrationError
from tracker.geometry import Array, Camera, Marker, Rigid
from tracker.pose.image_rate import GapLimit, image_period_s
from tracker.pose.sighting import Seen, Sighting
from tracker.pose.tool.gate import ToolGate
from tracker.pose.tool.motion_range import ToolMotionRange, motion_range_of
from tracker.pose.tool.pivot import PivotCalibration, pivot_calibration, provisional_tip_mm
from tracker.pose.tool.poses import Poses
from tracker.pose.tool.spin import SpinCalibration, min_variance_direction, spin_calibration
from tracker.pose.tool.tip_check import TipCheck, check_tip

# Number of images for the median image period, which is unknown with fewer than three intervals.
RATE_IMAGES = 16
MIN_RATE_INTERVALS = 3

Outcome: TypeAlias = PivotCalibration | SpinCalibration | TipCheck


class Purpose(StrEnum):
    """Calibration for which poses are collected."""

    PIVOT = "pivot"
    SPIN = "spin"
    TIP_CHECK = "tip_check"

    @classmethod
    def _missing_(cls, value: object) -> "Purpose | None":
        """Accept the earlier spelling in capitals."""
        return next((one for one in cls if isinstance(value, str) and one.value == value.lower()), None)


class Taking(StrEnum):
    """Return whether the pose of an image was accepted, or the reason why it was not."""

    TAKEN = "taken"
    NO_PICTURE = "no_picture"  # no image arrives: the camera or the tracking has stopped
    NOT_SEEN = "not_seen"  # the marker is not detected
    TOO_UNCERTAIN = "too_uncertain"  # the standard deviation of the pose is above its limit
    ALONE = "alone"  # no recent image to compute the speed from
    JUMPED = "jumped"  # farther from the last pose than a hand can move: one of the two is wrong
    NOTHING_NEW = "nothing_new"  # the rotation is near that of an accepted pose
    FULL = "full"  # enough for any calibration


class Need(StrEnum):
    """A kind of missing motion or pose."""

    MORE_POSES = "more_poses"
    TILT_MORE = "tilt_more"  # to both sides
    TILT_ACROSS = "tilt_across"  # perpendicular to the main tilt
    SPIN_MORE = "spin_more"
    BETTER_RESULT = "better_result"  # the amounts are met, but the result fails the gate


@dataclass(frozen=True, slots=True, kw_only=True)
class Missing:
    """An unmet requirement: the amount collected and the amount required (poses or degrees)."""

    need: Need
    there: float
    wanted: float


@dataclass(frozen=True, slots=True, kw_only=True)
class CollectorSettings:
    """Acceptance limits of poses, and the required amounts.

    Attributes:
        wanted_poses, wanted_tilt_deg, wanted_spin_deg: required amounts; above those of the gate, because
            more tilt reduces the uncertainty of the tip.
        max_rotation_sd_deg, max_shift_sd_mm: limits of a pose's standard deviation, in its worst direction.
        max_speed_mm_s, max_turn_rate_deg_s: limits of a hand's motion.
        max_reach_s: upper bound of the time by which these speeds are multiplied. Higher: with a slow camera
            no wrong pose is rejected.
        gap: limit of the time to the image with which a pose is compared.
        min_new_deg: minimum rotation from each accepted pose.
        max_poses: maximum number of poses.
    """

    wanted_poses: int = 40
    wanted_tilt_deg: float = 30.0
    wanted_spin_deg: float = 90.0
    max_rotation_sd_deg: float = 1.0
    max_shift_sd_mm: float = 3.0
    max_speed_mm_s: float = 1500.0
    max_turn_rate_deg_s: float = 360.0
    max_reach_s: float = 0.25
    gap: GapLimit = field(default_factory=GapLimit)
    min_new_deg: float = 2.0
    max_poses: int = 400


@dataclass(frozen=True, slots=True, kw_only=True)
class Progress:
    """Progress of a tool calibration.

    Attributes:
        taken: number of accepted poses.
        rejected_images: number of images without an accepted pose, by reason.
        motion_range: tilt and spin range of the tool, or the error that prevents it.
        outcome: the calibration from the poses so far, or the error that prevents it.
        missing: unmet requirements; empty when the calibration may end.
    """

    taken: int
    rejected_images: Mapping[Taking, int]
    motion_range: ToolMotionRange | CalibrationError
    outcome: Outcome | CalibrationError
    missing: tuple[Missing, ...]

    @property
    def is_enough(self) -> bool:
        """Return whether all requirements are met."""
        return not self.missing


@dataclass(frozen=True, slots=True)
class _Last:
    at_s: float
    pose: Rigid[Camera, Marker]


class PoseCollector:
    """Collects the poses of one marker for a calibration. Mutable; times are passed in."""

    def __init__(
        self,
        purpose: Purpose,
        *,
        tip_in_marker_mm: Array | None = None,
        gate: ToolGate | None = None,
        settings: CollectorSettings | None = None,
    ) -> None:
        """Start a collection; a tip check requires the tip, and a spin calibration takes its sign from it."""
        if purpose is Purpose.TIP_CHECK and tip_in_marker_mm is None:
            raise CalibrationError(
                "TOOL_TIP_MISSING",
                "there is no tip to check",
                "Calibrate the tip by pivot calibration first.",
            )
        self._purpose = purpose
        self._tip = tip_in_marker_mm
        self._gate = gate or ToolGate()
        self._settings = settings or CollectorSettings()
        self._poses: list[Rigid[Camera, Marker]] = []
        self._covariances: list[Array] = []
        self._rejected_images: Counter[Taking] = Counter()
        self._last: _Last | None = None
        self._times_s: deque[float] = deque(maxlen=RATE_IMAGES)

    def take(self, sighting: Sighting, *, at_s: float) -> Taking:
        """Accept the pose of a sighting, or return the reason why not."""
        if not isinstance(sighting, Seen):
            self._times_s.append(at_s)
            return self._count(Taking.NOT_SEEN)
        return self.take_pose(sighting.camera_from_marker, sighting.pose_covariance, at_s=at_s)

    def take_pose(self, pose: Rigid[Camera, Marker], covariance: Array, *, at_s: float) -> Taking:
        """Accept a pose with its covariance (6, 6), or return the reason why not."""
        self._times_s.append(at_s)
        last, self._last = self._last, _Last(at_s, pose)
        taking = self._judged(pose, covariance, last, at_s)
        if taking is Taking.TAKEN:
            self._poses.append(pose)
            self._covariances.append(covariance)
        return self._count(taking)

    @property
    def poses(self) -> Poses:
        """Return the accepted poses in the order of time.

        Raises:
            InvalidInput: POSE_UNIT_SUSPECT or POSE_COVARIANCE_INVALID.
        """
        return Poses.from_rigids(self._poses, self._covariances)

    def progress(self) -> Progress:
        """Return the progress. This fits all accepted poses, which is too slow for every image."""
        poses = self.poses
        outcome = self._outcome(poses)
        motion_range = self._motion_range(poses, outcome)
        return Progress(
            taken=len(poses),
            rejected_images=dict(self._rejected_images),
            motion_range=motion_range,
            outcome=outcome,
            missing=tuple(self._missing(len(poses), motion_range, outcome)),
        )

    def _count(self, taking: Taking) -> Taking:
        if taking is not Taking.TAKEN:
            self._rejected_images[taking] += 1
        return taking

    def _judged(
        self, pose: Rigid[Camera, Marker], covariance: Array, last: _Last | None, at_s: float
    ) -> Taking:
        limits = self._settings
        shift_sd_mm = float(np.sqrt(np.linalg.eigvalsh(covariance[:3, :3])[-1]))
        turn_sd_deg = float(np.degrees(np.sqrt(np.linalg.eigvalsh(covariance[3:, 3:])[-1])))
        if not (shift_sd_mm <= limits.max_shift_sd_mm and turn_sd_deg <= limits.max_rotation_sd_deg):
            return Taking.TOO_UNCERTAIN
        period_s = image_period_s(self._times_s, min_intervals=MIN_RATE_INTERVALS)
        if last is None or not 0.0 < at_s - last.at_s <= limits.gap.allowed_s(period_s):
            return Taking.ALONE
        reach_s = min(at_s - last.at_s, limits.max_reach_s)
        shift_mm = float(np.linalg.norm(pose.translation_mm - last.pose.translation_mm))
        rotation_deg = float(_turns_deg(pose.rotation, last.pose.rotation[None])[0])
        if shift_mm > limits.max_speed_mm_s * reach_s or rotation_deg > limits.max_turn_rate_deg_s * reach_s:
            return Taking.JUMPED
        if len(self._poses) >= limits.max_poses:
            return Taking.FULL
        taken = np.array([one.rotation for one in self._poses]).reshape(-1, 3, 3)
        if len(taken) and float(_turns_deg(pose.rotation, taken).min()) < limits.min_new_deg:
            return Taking.NOTHING_NEW
        return Taking.TAKEN

    def _outcome(self, poses: Poses) -> Outcome | CalibrationError:
        try:
            if self._purpose is Purpose.PIVOT:
                return pivot_calibration(poses, self._gate)
            if self._purpose is Purpose.SPIN:
                return spin_calibration(poses, tip_in_marker_mm=self._tip, gate=self._gate)
            return check_tip(poses, np.asarray(self._tip), self._gate)
        except CalibrationError as error:
            return error

    def _motion_range(
        self, poses: Poses, outcome: Outcome | CalibrationError
    ) -> ToolMotionRange | CalibrationError:
        if isinstance(outcome, PivotCalibration | TipCheck):
            return outcome.motion_range
        if len(poses) < 3:
            return CalibrationError(
                "TOOL_TOO_FEW_POSES",
                f"there are {len(poses)} poses",
                "Tilt the tool with its tip in the divot.",
                {"poses": len(poses)},
            )
        if self._purpose is Purpose.SPIN:
            # Only the direction matters; the length is arbitrary.
            return motion_range_of(poses, 100.0 * min_variance_direction(poses))
        return motion_range_of(poses, provisional_tip_mm(poses) if self._tip is None else self._tip)

    def _missing(
        self,
        count: int,
        motion_range: ToolMotionRange | CalibrationError,
        outcome: Outcome | CalibrationError,
    ) -> list[Missing]:
        wanted = self._settings
        missing = []
        if count < wanted.wanted_poses:
            missing.append(Missing(need=Need.MORE_POSES, there=count, wanted=wanted.wanted_poses))
        if isinstance(motion_range, CalibrationError):
            return missing or [Missing(need=Need.MORE_POSES, there=count, wanted=wanted.wanted_poses)]
        ways = {
            Need.TILT_MORE: (motion_range.tilt_range_deg, wanted.wanted_tilt_deg),
            Need.TILT_ACROSS: (motion_range.tilt_range_across_deg, wanted.wanted_tilt_deg),
        }
        if self._purpose is Purpose.SPIN:
            ways = {Need.SPIN_MORE: (motion_range.spin_range_deg, wanted.wanted_spin_deg)}
        missing += [
            Missing(need=need, there=there, wanted=enough)
            for need, (there, enough) in ways.items()
            if there < enough
        ]
        if not missing and (isinstance(outcome, CalibrationError) or outcome.failures(self._gate)):
            missing.append(Missing(need=Need.BETTER_RESULT, there=count, wanted=count))
        return missing


def _turns_deg(rotation: Array, others: Array) -> Array:
    """Return angles (n,) between a rotation and others (n, 3, 3), by the chord, accurate for small angles."""
    chord = np.linalg.norm(others - rotation, axis=(1, 2)) / np.sqrt(8.0)
    return np.asarray(np.degrees(2.0 * np.arcsin(np.minimum(chord, 1.0))))
