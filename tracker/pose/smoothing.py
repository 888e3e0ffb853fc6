"""Pose smoothing: a moving average over the last consistent poses, with its lag.

The moving average removes most of the jitter of a drawn line, and lags by a time that is returned with every
pose. A pose that differs from an earlier one by more than their covariances and a still hand allow (about a
millimetre, or half a degree) is returned unchanged, and the window is cleared.

The lag of a moving average is known at any image rate. A jump or a fast motion clears the window in the same
image, so motion is not smoothed.
"""

from collections import deque
from dataclasses import dataclass

import numpy as np

from tracker.geometry import Array, Camera, Marker, Rigid, vector_from_rotation

# Squared Mahalanobis distance of two poses, the 99 % point of chi-square with 6 degrees of freedom. Above it
# the pose is returned unchanged, because jitter is better than lag.
MAX_MAHALANOBIS_SQUARED = 16.81
# Motion of a still hand within the lag (sd). A motion of four times as much is never delayed.
STILL_SD_MM, STILL_SD_DEG = 0.25, 0.12
# The covariance of an ambiguous pose allows nearly any rotation, but a flip must count as a jump.
MAX_TURN_DEG = 3.0
MAX_IMAGES = 64
STILL = np.diag([STILL_SD_MM**2] * 3 + [float(np.radians(STILL_SD_DEG)) ** 2] * 3)


@dataclass(frozen=True, slots=True, kw_only=True)
class SmoothingSettings:
    """Settings of the pose smoothing.

    Attributes:
        lag_ms: maximum lag of a smoothed pose; 0 disables smoothing.
        near_wall: also smooth near the channel's wall.
        near_wall_mm: distance between the drill at its tip and the wall that counts as near.
    """

    lag_ms: float = 0.0
    near_wall: bool = False
    near_wall_mm: float = 3.0


@dataclass(frozen=True, slots=True, kw_only=True)
class SmoothedPose:
    """A pose averaged over the last images.

    Attributes:
        camera_from_marker: the mean pose.
        pose_covariance: (6, 6) [mm, rad], as in `Seen`, of the mean as an estimate of the newest pose: the
            mean of the covariances, valid for any correlation between neighbouring images, plus the outer
            product of the difference from the newest pose, valid for any motion of the marker.
        lag_ms: mean age of the averaged images; 0 for the newest pose itself.
        noise_ratio: remaining share of noise that is independent between images, 0..1.
        images: number of averaged images.
    """

    camera_from_marker: Rigid[Camera, Marker]
    pose_covariance: Array
    lag_ms: float
    noise_ratio: float
    images: int


@dataclass(frozen=True, slots=True)
class _TimedPose:
    at_s: float
    pose: Rigid[Camera, Marker]
    covariance: Array


class PoseSmoother:
    """Smooths the pose of one marker. Mutable: stores the consistent poses."""

    def __init__(self, *, lag_ms: float) -> None:
        self._lag_s = lag_ms / 1000.0
        self._last: deque[_TimedPose] = deque(maxlen=MAX_IMAGES)

    def forget(self) -> None:
        """Clear the window after an image in which the marker was not seen."""
        self._last.clear()

    def take(self, pose: Rigid[Camera, Marker], covariance: Array, *, at_s: float) -> SmoothedPose:
        """Return the smoothed pose at this time; `pose` itself if no earlier pose is consistent with it."""
        if self._last and at_s <= self._last[-1].at_s:
            self.forget()
        new = _TimedPose(at_s, pose, covariance)
        chosen, age_s = [new], 0.0
        for count, old in enumerate(reversed(self._last), start=2):
            if not _agree(old, new):
                self.forget()
                self._last.extend(reversed(chosen[1:]))
                break
            age_s += at_s - old.at_s
            # Tolerance for the rounding of equal time steps.
            if age_s / count > self._lag_s + 1e-6:
                break
            chosen.append(old)
        self._last.append(new)
        return _mean(chosen)


def _agree(old: _TimedPose, new: _TimedPose) -> bool:
    """Return whether noise and a still hand can explain the difference of two poses."""
    difference = _apart(old.pose, new.pose)
    if float(np.linalg.norm(difference[3:])) > np.radians(MAX_TURN_DEG):
        return False
    try:
        mahalanobis_squared = float(
            difference @ np.linalg.solve(old.covariance + new.covariance + STILL, difference)
        )
    except np.linalg.LinAlgError:
        return not difference.any()
    return mahalanobis_squared <= MAX_MAHALANOBIS_SQUARED


def _apart(old: Rigid[Camera, Marker], new: Rigid[Camera, Marker]) -> Array:
    """Return the difference (6,) from the new pose to the old one, in the coordinates of the covariance."""
    rotation = vector_from_rotation(old.rotation @ new.rotation.T)
    return np.concatenate([old.translation_mm - new.translation_mm, rotation])


def _mean(chosen: list[_TimedPose]) -> SmoothedPose:
    """Return the mean of poses, the newest first."""
    new = chosen[0]
    if len(chosen) == 1:
        return SmoothedPose(
            camera_from_marker=new.pose, pose_covariance=new.covariance, lag_ms=0.0, noise_ratio=1.0, images=1
        )
    difference = np.array([_apart(one.pose, new.pose) for one in chosen])
    age_s = np.array([new.at_s - one.at_s for one in chosen])
    step, lag_s = difference.mean(axis=0), float(age_s.mean())
    covariance = np.mean([one.covariance for one in chosen], axis=0) + np.outer(step, step)
    return SmoothedPose(
        camera_from_marker=new.pose.displaced(step),
        pose_covariance=np.asarray(covariance),
        lag_ms=1000.0 * lag_s,
        noise_ratio=float(1.0 / np.sqrt(len(chosen))),
        images=len(chosen),
    )
