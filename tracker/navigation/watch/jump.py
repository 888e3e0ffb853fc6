"""A pose that jumped: further from the one before than a hand can move, or turned over."""

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from tracker.geometry import Camera, Marker, Rigid, angle_between_deg, vector_from_rotation


class Moved(StrEnum):
    """How a pose follows the one before."""

    AS_A_HAND = "as-a-hand"  # as a hand moves, or the first one
    JUMPED = "jumped"  # further than a hand can
    TURNED_OVER = "turned-over"  # to the mirrored solution of a planar marker


@dataclass(frozen=True, slots=True, kw_only=True)
class JumpSettings:
    """What a hand can do, and when a jump is believed.

    Attributes:
        max_mm_s: faster is no hand that guides a drill.
        max_deg_s: likewise.
        slack_mm: what noise adds between two images.
        slack_deg: likewise.
        believed_after: so many images that agree with each other make a jump the truth.
        forgotten_after_s: a pose so old is nothing that a new one could have jumped from; a jump in doubt
            stays in doubt as long as images come.
    """

    max_mm_s: float = 600.0
    max_deg_s: float = 240.0
    slack_mm: float = 1.5
    slack_deg: float = 2.5
    believed_after: int = 5
    forgotten_after_s: float = 0.5


@dataclass(frozen=True, slots=True, kw_only=True)
class Jump:
    """What the newest pose is worth.

    Attributes:
        moved: how it follows what was believed before.
        believed: whether it may be shown.
        images: how many images in a row say the same.
        moved_mm: from the pose that was believed last; 0 for the first.
        turned_deg: likewise.
    """

    moved: Moved
    believed: bool
    images: int
    moved_mm: float
    turned_deg: float


@dataclass(frozen=True, slots=True, kw_only=True)
class _Timed:
    pose: Rigid[Camera, Marker]
    at_s: float


class JumpWatch:
    """Watches a marker's poses from image to image. Mutable: the poses believed last and seen last."""

    def __init__(self, settings: JumpSettings | None = None) -> None:
        self._settings = settings or JumpSettings()
        self._believed: _Timed | None = None
        self._newest: _Timed | None = None
        self._images = 0

    def take(self, camera_from_marker: Rigid[Camera, Marker], *, at_s: float) -> Jump:
        """Judge the pose of the next image in which the marker is seen."""
        here = _Timed(pose=camera_from_marker, at_s=at_s)
        believed, newest = self._believed, self._newest
        self._newest = here
        in_doubt = self._images > 0 and newest is not None and not self._is_old(newest, at_s)
        if believed is None or (self._is_old(believed, at_s) and not in_doubt):
            return self._believe(here, Moved.AS_A_HAND, 0.0, 0.0)
        moved_mm, turned_deg = _apart(believed.pose, here.pose)
        # While in doubt, time alone does not bring the old pose nearer to what jumped away from it.
        at_most_s = 2.0 * (at_s - newest.at_s) if in_doubt and newest is not None else np.inf
        if self._follows(believed, here, at_most_s):
            return self._believe(here, Moved.AS_A_HAND, moved_mm, turned_deg)
        continues = in_doubt and newest is not None and self._follows(newest, here)
        self._images = self._images + 1 if continues else 1
        how = Moved.TURNED_OVER if turned_over(believed.pose, here.pose) else Moved.JUMPED
        if self._images >= self._settings.believed_after:
            return self._believe(here, how, moved_mm, turned_deg)
        return Jump(moved=how, believed=False, images=self._images, moved_mm=moved_mm, turned_deg=turned_deg)

    def forget(self) -> None:
        """Start anew, as after the marker was out of sight on purpose."""
        self._believed = self._newest = None
        self._images = 0

    def _believe(self, here: _Timed, how: Moved, moved_mm: float, turned_deg: float) -> Jump:
        images = max(self._images, 1)
        self._believed, self._images = here, 0
        return Jump(moved=how, believed=True, images=images, moved_mm=moved_mm, turned_deg=turned_deg)

    def _is_old(self, pose: _Timed, at_s: float) -> bool:
        return not 0.0 <= at_s - pose.at_s <= self._settings.forgotten_after_s

    def _follows(self, before: _Timed, here: _Timed, at_most_s: float = np.inf) -> bool:
        if self._is_old(before, here.at_s):
            return False
        since_s = min(here.at_s - before.at_s, at_most_s)
        moved_mm, turned_deg = _apart(before.pose, here.pose)
        return (
            moved_mm <= self._settings.slack_mm + self._settings.max_mm_s * since_s
            and turned_deg <= self._settings.slack_deg + self._settings.max_deg_s * since_s
        )


def turned_over(before: Rigid[Camera, Marker], after: Rigid[Camera, Marker]) -> bool:
    """Whether a planar marker turned into its mirror image: its normal reflected about the line of sight."""
    sight = after.translation_mm / max(float(np.linalg.norm(after.translation_mm)), 1e-9)
    normal, now = before.rotation[:, 2], after.rotation[:, 2]
    mirrored = 2.0 * float(normal @ sight) * sight - normal
    # Nearer to the mirror image than to itself, by a good part of the way between both.
    return angle_between_deg(mirrored, now) < 0.35 * angle_between_deg(normal, now)


def _apart(one: Rigid[Camera, Marker], other: Rigid[Camera, Marker]) -> tuple[float, float]:
    turn = vector_from_rotation(other.rotation @ one.rotation.T)
    shift = other.translation_mm - one.translation_mm
    return float(np.linalg.norm(shift)), float(np.degrees(np.linalg.norm(turn)))
