"""Steadied poses: the mean of the last images as long as they agree, with its lag stated.

Noise makes a drawn line tremble. A mean over the last images takes most of it away, and shows the marker
where it was a moment ago: by how much is stated with every pose. A pose that differs from one before it by
more than their covariances and a hand that holds still admit (about a millimetre, or half a degree) is shown
in its own image, and what was before is forgotten.

A plain mean has an exact lag at any image rate; a jump or a fast hand empties the window in the same image.
What moves is not steadied.
"""

from collections import deque
from dataclasses import dataclass

import numpy as np

from tracker.geometry import Array, Camera, Marker, Rigid, rotation_from_vector, vector_from_rotation

# Squared distance of two poses in units of what is admitted (6 degrees of freedom): noise alone exceeds it
# once in a hundred images. Then the pose is shown as it is: rather trembling than late.
MAX_SURPRISE = 16.81
# What a hand that holds still moves within the lag (sd). Four times as much is a motion, and is never late.
STILL_SD_MM, STILL_SD_DEG = 0.25, 0.12
# Where a covariance spans both planar solutions it admits nearly anything; a turn over is still a jump.
MAX_TURN_DEG = 3.0
MAX_IMAGES = 64
STILL = np.diag([STILL_SD_MM**2] * 3 + [float(np.radians(STILL_SD_DEG)) ** 2] * 3)


@dataclass(frozen=True, slots=True, kw_only=True)
class SteadySettings:
    """How much poses are steadied.

    Attributes:
        lag_ms: how far behind a steadied pose may be, at most; 0 steadies nothing.
        near_wall: steady near the channel's wall, too.
        near_wall_mm: what "near" is: the gap between the drill at its tip and the wall.
    """

    lag_ms: float = 0.0
    near_wall: bool = False
    near_wall_mm: float = 3.0


@dataclass(frozen=True, slots=True, kw_only=True)
class SteadyPose:
    """A pose made of the last images.

    Attributes:
        camera_from_marker: their mean.
        pose_covariance: (6, 6) [mm, rad], as in `Seen`, of this pose as that of the newest image: the mean of
            the covariances, which holds however much the errors of neighbouring images have in common, and
            how far the newest image's own pose is from it, which holds however the marker moved.
        lag_ms: mean age of the images in it; 0 where it is the newest pose itself.
        noise_ratio: what is left of noise that is independent from image to image, 0..1.
        images: how many are in it.
    """

    camera_from_marker: Rigid[Camera, Marker]
    pose_covariance: Array
    lag_ms: float
    noise_ratio: float
    images: int


@dataclass(frozen=True, slots=True)
class _Known:
    at_s: float
    pose: Rigid[Camera, Marker]
    covariance: Array


class Steady:
    """Steadies the pose of one marker. Mutable: holds the images that agree."""

    def __init__(self, *, lag_ms: float) -> None:
        self._lag_s = lag_ms / 1000.0
        self._last: deque[_Known] = deque(maxlen=MAX_IMAGES)

    def forget(self) -> None:
        """The marker is not seen: nothing is filled in, and the next pose stands alone."""
        self._last.clear()

    def take(self, pose: Rigid[Camera, Marker], covariance: Array, *, at_s: float) -> SteadyPose:
        """The steadied pose of the image at this time; the very same pose where nothing agrees with it."""
        if self._last and at_s <= self._last[-1].at_s:
            self.forget()
        new = _Known(at_s, pose, covariance)
        chosen, age_s = [new], 0.0
        for count, old in enumerate(reversed(self._last), start=2):
            if not _agree(old, new):
                self.forget()
                self._last.extend(reversed(chosen[1:]))
                break
            age_s += at_s - old.at_s
            # A little more, because equal steps of time are not equal to the last digit.
            if age_s / count > self._lag_s + 1e-6:
                break
            chosen.append(old)
        self._last.append(new)
        return _mean(chosen)


def _agree(old: _Known, new: _Known) -> bool:
    """Whether noise and a hand that holds still may have made one pose of the other."""
    apart = _apart(old.pose, new.pose)
    if float(np.linalg.norm(apart[3:])) > np.radians(MAX_TURN_DEG):
        return False
    try:
        surprise = float(apart @ np.linalg.solve(old.covariance + new.covariance + STILL, apart))
    except np.linalg.LinAlgError:
        return not apart.any()
    return surprise <= MAX_SURPRISE


def _apart(old: Rigid[Camera, Marker], new: Rigid[Camera, Marker]) -> Array:
    """What takes the new pose to the old one, in the coordinates of the covariance."""
    turn = vector_from_rotation(old.rotation @ new.rotation.T)
    return np.concatenate([old.translation_mm - new.translation_mm, turn])


def _mean(chosen: list[_Known]) -> SteadyPose:
    """The mean of some images, the newest first."""
    new = chosen[0]
    if len(chosen) == 1:
        return SteadyPose(
            camera_from_marker=new.pose, pose_covariance=new.covariance, lag_ms=0.0, noise_ratio=1.0, images=1
        )
    apart = np.array([_apart(one.pose, new.pose) for one in chosen])
    age_s = np.array([new.at_s - one.at_s for one in chosen])
    step, lag_s = apart.mean(axis=0), float(age_s.mean())
    covariance = np.mean([one.covariance for one in chosen], axis=0) + np.outer(step, step)
    return SteadyPose(
        camera_from_marker=Rigid(
            rotation=rotation_from_vector(step[3:]) @ new.pose.rotation,
            translation_mm=new.pose.translation_mm + step[:3],
        ),
        pose_covariance=np.asarray(covariance),
        lag_ms=1000.0 * lag_s,
        noise_ratio=float(1.0 / np.sqrt(len(chosen))),
        images=len(chosen),
    )
