"""Detect whether the patient's reference marker moved since the registration.

A camera motion invalidates nothing, because all poses are measured relative to the reference. A displaced
reference looks like a moving camera, unless the static scene shows that the camera did not move.
"""

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from tracker.geometry import Camera, Marker, Rigid, vector_from_rotation
from tracker.navigation.monitoring.scene_monitor import SceneState


class ReferenceState(StrEnum):
    """State of the reference."""

    IN_PLACE = "in-place"  # at its previous pose in the camera frame
    WITH_CAMERA = "with-camera"  # reference and scene moved together: the camera was moved
    MOVED = "moved"  # the reference moved and the scene did not: check on anatomy
    UNDETERMINED = "cannot-tell"  # the reference moved, and the state of the scene is unknown


@dataclass(frozen=True, slots=True, kw_only=True)
class ReferenceSettings:
    """Limits of the motion of a reference by breathing.

    Attributes:
        max_mm: maximum translation.
        max_deg: maximum rotation.
        confirm_images: number of consecutive images needed.
    """

    max_mm: float = 4.0
    max_deg: float = 3.0
    confirm_images: int = 5


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


class ReferenceMonitor:
    """Monitor the reference from a registration on. Mutable: number of consecutive displaced images."""

    def __init__(
        self, camera_from_reference: Rigid[Camera, Marker], *, settings: ReferenceSettings | None = None
    ) -> None:
        """Start at the present pose of the reference."""
        self._start = camera_from_reference
        self._settings = settings or ReferenceSettings()
        self._images = 0

    def check(self, camera_from_reference: Rigid[Camera, Marker], scene: SceneState) -> ReferenceCheck:
        """Check the reference in an image, given the state of the scene since its displacement.

        After `MOVED` or `WITH_CAMERA` create a new monitor for the new pose, with a new `SceneMonitor`: after
        a check on anatomy in the first case, at once in the second.
        """
        shift = camera_from_reference.translation_mm - self._start.translation_mm
        turn = vector_from_rotation(camera_from_reference.rotation @ self._start.rotation.T)
        moved_mm, rotated_deg = float(np.linalg.norm(shift)), float(np.degrees(np.linalg.norm(turn)))
        elsewhere = moved_mm > self._settings.max_mm or rotated_deg > self._settings.max_deg
        self._images = self._images + 1 if elsewhere else 0
        state = ReferenceState.IN_PLACE
        if self._images >= self._settings.confirm_images:
            state = {
                SceneState.STILL: ReferenceState.MOVED,
                SceneState.MOVED: ReferenceState.WITH_CAMERA,
            }.get(scene, ReferenceState.UNDETERMINED)
        return ReferenceCheck(state=state, moved_mm=moved_mm, rotated_deg=rotated_deg, images=self._images)
