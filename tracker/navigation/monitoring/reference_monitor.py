"""Detect whether the patient's reference marker moved since the registration.

A camera motion invalidates nothing, because all poses are measured relative to the reference. A displaced
reference looks like a moving camera, unless the static scene shows that the camera did not move. A breathing
patient moves the reference before a static scene, too, and takes it back: slowly, as far as in the breaths
before, and for seconds. A bump is faster, or farther, or stays.
"""

from collections import deque
from dataclasses import dataclass, replace
from enum import StrEnum

import numpy as np

from tracker.geometry import Array, Camera, Marker, Rigid, vector_from_rotation
from tracker.navigation.monitoring.scene_monitor import SceneState


class ReferenceState(StrEnum):
    """State of the reference."""

    IN_PLACE = "in-place"  # at its previous pose in the camera frame
    WITH_CAMERA = "with-camera"  # reference and scene moved together: the camera was moved
    BREATHING = "breathing"  # displaced as in earlier breaths, and expected back
    SWAYING = "swaying"  # displaced slowly: perhaps a first breath
    MOVED = "moved"  # the reference moved and the scene did not: check on anatomy
    UNDETERMINED = "cannot-tell"  # the reference moved, and the state of the scene is unknown


@dataclass(frozen=True, slots=True, kw_only=True)
class ReferenceSettings:
    """Limits of a displaced reference, and of breathing.

    A smaller `max_mm` or `max_deg` reports smaller bumps, and more noise. Larger limits of a breath accept a
    deeper one, and let a reference that slips slowly stay unreported for `max_breath_s`.

    Attributes:
        max_mm: translation up to which the reference is in place.
        max_deg: rotation up to which it is in place.
        confirm_images: number of consecutive images needed.
        max_breath_mm: maximum displacement by breathing.
        max_breath_deg: the same for the rotation.
        max_breath_s: maximum time of a breath out of place; 10 breaths a minute take 6 s each.
        max_speed_mm_s: maximum speed of breathing; 12 mm to and fro in 2.5 s reach it.
        max_speed_deg_s: the same for the rotation.
        speed_window_s: time over which a speed is measured, as a difference of the means of its halves.
        min_breaths: number of breaths after which breathing is known.
        memory_s: time for which a breath is remembered.
        depth_ratio: how much deeper than the deepest remembered breath the next one may be.
    """

    max_mm: float = 4.0
    max_deg: float = 3.0
    confirm_images: int = 5
    max_breath_mm: float = 12.0
    max_breath_deg: float = 5.0
    max_breath_s: float = 6.0
    max_speed_mm_s: float = 15.0
    max_speed_deg_s: float = 8.0
    speed_window_s: float = 0.4
    min_breaths: int = 2
    memory_s: float = 60.0
    depth_ratio: float = 1.5


@dataclass(frozen=True, slots=True, kw_only=True)
class ReferenceCheck:
    """Result of one image.

    Attributes:
        state: of the reference.
        moved_mm: in the camera frame, since the registration or the last check on anatomy.
        rotated_deg: the same for the rotation.
        images: number of consecutive images with a displaced reference.
    """

    state: ReferenceState
    moved_mm: float
    rotated_deg: float
    images: int


@dataclass(frozen=True, slots=True, kw_only=True)
class _Excursion:
    """Consecutive images with a displaced reference: its times, farthest displacement, and highest speed."""

    began_s: float
    last_s: float
    max_mm: float
    max_deg: float
    is_fast: bool


class ReferenceMonitor:
    """Monitor the reference from a registration on. Mutable: recent motion, and the breaths before."""

    def __init__(
        self, camera_from_reference: Rigid[Camera, Marker], *, settings: ReferenceSettings | None = None
    ) -> None:
        """Start at the present pose of the reference."""
        self._start = camera_from_reference
        self._settings = settings or ReferenceSettings()
        self._images = 0
        self._excursion: _Excursion | None = None
        self._breaths: deque[_Excursion] = deque()
        self._recent: deque[tuple[float, Array]] = deque()

    def check(
        self, camera_from_reference: Rigid[Camera, Marker], scene: SceneState, *, at_s: float
    ) -> ReferenceCheck:
        """Check the reference in an image, given the state of the scene since its displacement.

        After `MOVED` or `WITH_CAMERA` create a new monitor for the new pose, with a new `SceneMonitor`: after
        a check on anatomy in the first case, at once in the second.

        Args:
            camera_from_reference: its pose in the image.
            scene: state of the scene.
            at_s: capture time of the image.
        """
        shift = camera_from_reference.translation_mm - self._start.translation_mm
        turn = np.degrees(vector_from_rotation(camera_from_reference.rotation @ self._start.rotation.T))
        moved_mm, rotated_deg = float(np.linalg.norm(shift)), float(np.linalg.norm(turn))
        is_fast = self._is_fast(np.concatenate([shift, turn]), at_s)
        if moved_mm > self._settings.max_mm or rotated_deg > self._settings.max_deg:
            self._images += 1
            before = self._excursion or _Excursion(
                began_s=at_s, last_s=at_s, max_mm=0.0, max_deg=0.0, is_fast=False
            )
            self._excursion = replace(
                before,
                last_s=at_s,
                max_mm=max(before.max_mm, moved_mm),
                max_deg=max(before.max_deg, rotated_deg),
                is_fast=before.is_fast or is_fast,
            )
        else:
            self._end_excursion()
        state = ReferenceState.IN_PLACE
        if self._excursion is not None and self._images >= self._settings.confirm_images:
            state = {
                SceneState.STILL: self._displaced(self._excursion),
                SceneState.MOVED: ReferenceState.WITH_CAMERA,
            }.get(scene, ReferenceState.UNDETERMINED)
        return ReferenceCheck(state=state, moved_mm=moved_mm, rotated_deg=rotated_deg, images=self._images)

    def _displaced(self, now: _Excursion) -> ReferenceState:
        """Return the state of a reference that is displaced before a still scene."""
        if not self._may_be_breath(now):
            return ReferenceState.MOVED
        limits, known = self._settings, self._breaths
        while known and now.last_s - known[0].last_s > limits.memory_s:
            known.popleft()
        if len(known) < limits.min_breaths:
            return ReferenceState.SWAYING
        deepest_mm = max(limits.max_mm, *(one.max_mm for one in known))
        deepest_deg = max(limits.max_deg, *(one.max_deg for one in known))
        is_as_deep = (
            now.max_mm <= limits.depth_ratio * deepest_mm and now.max_deg <= limits.depth_ratio * deepest_deg
        )
        return ReferenceState.BREATHING if is_as_deep else ReferenceState.SWAYING

    def _may_be_breath(self, one: _Excursion) -> bool:
        limits = self._settings
        return (
            not one.is_fast
            and one.max_mm <= limits.max_breath_mm
            and one.max_deg <= limits.max_breath_deg
            and one.last_s - one.began_s <= limits.max_breath_s
        )

    def _end_excursion(self) -> None:
        ended = self._excursion
        if ended is not None and self._images >= self._settings.confirm_images and self._may_be_breath(ended):
            self._breaths.append(ended)
        self._excursion, self._images = None, 0

    def _is_fast(self, displacement: Array, at_s: float) -> bool:
        """Whether the reference moves faster than by breathing; its motion while it was not seen counts."""
        limits, recent = self._settings, self._recent
        recent.append((at_s, displacement))
        # One older image stays: after a gap it is compared with the newest ones.
        while len(recent) > 2 and at_s - recent[1][0] >= limits.speed_window_s:
            recent.popleft()
        middle_s = at_s - limits.speed_window_s / 2.0
        early = [(when, where) for when, where in recent if when <= middle_s]
        late = [(when, where) for when, where in recent if when > middle_s]
        if not early:
            return False
        apart_s = np.mean([when for when, _ in late]) - np.mean([when for when, _ in early])
        change = np.mean([where for _, where in late], axis=0) - np.mean(
            [where for _, where in early], axis=0
        )
        return bool(
            np.linalg.norm(change[:3]) > limits.max_speed_mm_s * apart_s
            or np.linalg.norm(change[3:]) > limits.max_speed_deg_s * apart_s
        )
