"""Detect implausible pose changes of a marker: faster than a hand, or flipped."""

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from tracker.geometry import Camera, Marker, Rigid, angle_between_deg, vector_from_rotation


class MotionKind(StrEnum):
    """Classification of the change from the previous pose."""

    PLAUSIBLE = "as-a-hand"  # within the speed of a hand, or the first pose
    JUMPED = "jumped"  # faster than a hand can move
    FLIPPED = "turned-over"  # flipped to the mirrored planar solution


@dataclass(frozen=True, slots=True, kw_only=True)
class PoseJumpSettings:
    """Plausible hand motion, and when a jump is accepted.

    Attributes:
        max_mm_s: maximum speed of a hand that guides a drill.
        max_deg_s: maximum angular speed.
        slack_mm: allowance for noise between two images.
        slack_deg: allowance for noise in the rotation.
        accept_after_images: number of consistent images after which a jump is accepted.
        expires_after_s: age after which the last pose is no longer compared; an unconfirmed jump remains
            unconfirmed while images arrive.
    """

    max_mm_s: float = 600.0
    max_deg_s: float = 240.0
    slack_mm: float = 1.5
    slack_deg: float = 2.5
    accept_after_images: int = 5
    expires_after_s: float = 0.5


@dataclass(frozen=True, slots=True, kw_only=True)
class PoseJumpCheck:
    """Result for the newest pose.

    Attributes:
        moved: classification of the change from the last accepted pose.
        accepted: whether the pose may be displayed.
        images: number of consecutive consistent images.
        moved_mm: from the last accepted pose; 0 for the first.
        rotated_deg: from the last accepted pose.
    """

    moved: MotionKind
    accepted: bool
    images: int
    moved_mm: float
    rotated_deg: float


@dataclass(frozen=True, slots=True, kw_only=True)
class _Timed:
    pose: Rigid[Camera, Marker]
    at_s: float


class PoseJumpDetector:
    """Detect jumps in a marker's poses. Mutable: the last accepted and the last seen pose."""

    def __init__(self, settings: PoseJumpSettings | None = None) -> None:
        self._settings = settings or PoseJumpSettings()
        self._believed: _Timed | None = None
        self._newest: _Timed | None = None
        self._images = 0

    def take(self, camera_from_marker: Rigid[Camera, Marker], *, at_s: float) -> PoseJumpCheck:
        """Check the pose of the next image in which the marker is seen."""
        here = _Timed(pose=camera_from_marker, at_s=at_s)
        accepted, newest = self._believed, self._newest
        self._newest = here
        in_doubt = self._images > 0 and newest is not None and not self._is_old(newest, at_s)
        if accepted is None or (self._is_old(accepted, at_s) and not in_doubt):
            return self._believe(here, MotionKind.PLAUSIBLE, 0.0, 0.0)
        moved_mm, rotated_deg = _apart(accepted.pose, here.pose)
        # While a jump is unconfirmed, elapsed time must not make it plausible.
        at_most_s = 2.0 * (at_s - newest.at_s) if in_doubt and newest is not None else np.inf
        if self._follows(accepted, here, at_most_s):
            return self._believe(here, MotionKind.PLAUSIBLE, moved_mm, rotated_deg)
        continues = in_doubt and newest is not None and self._follows(newest, here)
        self._images = self._images + 1 if continues else 1
        how = MotionKind.FLIPPED if is_flipped(accepted.pose, here.pose) else MotionKind.JUMPED
        if self._images >= self._settings.accept_after_images:
            return self._believe(here, how, moved_mm, rotated_deg)
        return PoseJumpCheck(
            moved=how, accepted=False, images=self._images, moved_mm=moved_mm, rotated_deg=rotated_deg
        )

    def forget(self) -> None:
        """Discard all poses."""
        self._believed = self._newest = None
        self._images = 0

    def _believe(self, here: _Timed, how: MotionKind, moved_mm: float, rotated_deg: float) -> PoseJumpCheck:
        images = max(self._images, 1)
        self._believed, self._images = here, 0
        return PoseJumpCheck(
            moved=how, accepted=True, images=images, moved_mm=moved_mm, rotated_deg=rotated_deg
        )

    def _is_old(self, pose: _Timed, at_s: float) -> bool:
        return not 0.0 <= at_s - pose.at_s <= self._settings.expires_after_s

    def _follows(self, before: _Timed, here: _Timed, at_most_s: float = np.inf) -> bool:
        if self._is_old(before, here.at_s):
            return False
        since_s = min(here.at_s - before.at_s, at_most_s)
        moved_mm, rotated_deg = _apart(before.pose, here.pose)
        return (
            moved_mm <= self._settings.slack_mm + self._settings.max_mm_s * since_s
            and rotated_deg <= self._settings.slack_deg + self._settings.max_deg_s * since_s
        )


def is_flipped(before: Rigid[Camera, Marker], after: Rigid[Camera, Marker]) -> bool:
    """Whether a planar marker flipped to the mirrored pose: normal reflected about the line of sight."""
    sight = after.translation_mm / max(float(np.linalg.norm(after.translation_mm)), 1e-9)
    normal, now = before.rotation[:, 2], after.rotation[:, 2]
    mirrored = 2.0 * float(normal @ sight) * sight - normal
    # Clearly nearer to the mirrored normal than to the previous one.
    return angle_between_deg(mirrored, now) < 0.35 * angle_between_deg(normal, now)


def _apart(one: Rigid[Camera, Marker], other: Rigid[Camera, Marker]) -> tuple[float, float]:
    turn = vector_from_rotation(other.rotation @ one.rotation.T)
    shift = other.translation_mm - one.translation_mm
    return float(np.linalg.norm(shift)), float(np.degrees(np.linalg.norm(turn)))
