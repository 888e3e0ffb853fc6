"""Whether the patient's reference marker still stands where the registration had it.

A camera that moves takes nothing away: everything is measured from the reference. A reference that is bumped
looks just like a camera that moved, unless the scene around says that the camera did not.
"""

from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from tracker.geometry import Camera, Marker, Rigid, vector_from_rotation
from tracker.navigation.watch.scene import SceneState


class ReferenceState(StrEnum):
    """What can be told of the reference."""

    IN_PLACE = "in-place"  # where it was in the camera's picture
    WITH_CAMERA = "with-camera"  # it moved and so did all the scene: the camera was moved, nothing is lost
    MOVED = "moved"  # it moved and the scene did not: the patient moved, or it was bumped; check on anatomy
    CANNOT_TELL = "cannot-tell"  # it moved, and the scene says nothing


@dataclass(frozen=True, slots=True, kw_only=True)
class ReferenceSettings:
    """How far a patient's breath may move a reference.

    Attributes:
        max_mm: more is no breath.
        max_deg: likewise.
        confirmed_by: so many images in a row must say so.
    """

    max_mm: float = 4.0
    max_deg: float = 3.0
    confirmed_by: int = 5


@dataclass(frozen=True, slots=True, kw_only=True)
class ReferenceCheck:
    """What one image says of the reference.

    Attributes:
        state: what it means.
        moved_mm: from where it was in the camera's frame, at the registration or the last check on anatomy.
        turned_deg: likewise.
        images: how many in a row have it elsewhere.
    """

    state: ReferenceState
    moved_mm: float
    turned_deg: float
    images: int


class ReferenceWatch:
    """Watches the reference from a registration on. Mutable: how many images in a row had it elsewhere."""

    def __init__(
        self, camera_from_reference: Rigid[Camera, Marker], *, settings: ReferenceSettings | None = None
    ) -> None:
        """Start where the reference is now."""
        self._start = camera_from_reference
        self._settings = settings or ReferenceSettings()
        self._images = 0

    def check(self, camera_from_reference: Rigid[Camera, Marker], scene: SceneState) -> ReferenceCheck:
        """Judge the reference in an image, by what the scene said since it is elsewhere.

        After `MOVED` or `WITH_CAMERA` a new watch belongs to the new place, with a new `SceneWatch`: after a
        check on anatomy in the first case, at once in the second.
        """
        shift = camera_from_reference.translation_mm - self._start.translation_mm
        turn = vector_from_rotation(camera_from_reference.rotation @ self._start.rotation.T)
        moved_mm, turned_deg = float(np.linalg.norm(shift)), float(np.degrees(np.linalg.norm(turn)))
        elsewhere = moved_mm > self._settings.max_mm or turned_deg > self._settings.max_deg
        self._images = self._images + 1 if elsewhere else 0
        state = ReferenceState.IN_PLACE
        if self._images >= self._settings.confirmed_by:
            state = {
                SceneState.STILL: ReferenceState.MOVED,
                SceneState.MOVED: ReferenceState.WITH_CAMERA,
            }.get(scene, ReferenceState.CANNOT_TELL)
        return ReferenceCheck(state=state, moved_mm=moved_mm, turned_deg=turned_deg, images=self._images)
