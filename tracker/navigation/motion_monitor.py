"""All motion monitors of one theatre, updated image by image.

A detected motion persists until a new registration. A check on one landmark resets it only with a reference,
because a rotation about that landmark is not observable there. A registration disturbed by a cable must be
repeated, however small the shift. While hands occlude the scene the state is undetermined and reported as
such. A reference that sways as a breath may do withholds the registration only while it is displaced, until a
rhythm is known.
"""

from collections.abc import Mapping

import cv2
import numpy as np
import numpy.typing as npt

from tracker.geometry import Array
from tracker.navigation.monitoring import (
    LastSeen,
    PoseJumpDetector,
    ReferenceMonitor,
    ReferenceState,
    SceneMonitor,
    SceneState,
)
from tracker.navigation.snapshot import MotionState, Setup
from tracker.pose import Seen, Sighting

SCENE_PERIOD_S = 0.2
# While the reference is displaced, only the scene can identify the moving object, so it is checked more
# often.
SCENE_URGENT_PERIOD_S = 0.1
# Size of the masked region around a marker, in multiples of its side, because hand and handpiece move with
# it.
MASK_SIDES = 3.0


class MotionMonitor:
    """Detect pose jumps and motion of camera and reference over time. Mutable.

    Scene and reference are monitored from the first image on, so that a camera motion between two landmark
    captures is detected too: a registration is valid from the capture of its first landmark. A motion is
    reported until another registration replaces the disturbed one.
    """

    def __init__(self) -> None:
        self._lens: Array = np.zeros(0)
        self._jumps: dict[str, PoseJumpDetector] = {}
        self._sight = LastSeen()
        self._scene: SceneMonitor | None = None
        self._scene_state = SceneState.UNSURE
        self._looked_at_s = -np.inf
        self._reference: ReferenceMonitor | None = None
        self._in_place_at_s = -np.inf
        self._reference_is_elsewhere = self._reference_sways = False
        self._camera_moved_at_s = -np.inf
        self._reference_moved_at_s = -np.inf
        self._holds_from_s = -np.inf

    def begin(self, *, from_s: float | None, now_s: float) -> None:
        """Reset for another registration, or for the same one after a check on anatomy.

        Args:
            from_s: time of the first landmark capture or of the last check on anatomy; None if that was
                before this monitor started.
            now_s: on the same clock.
        """
        self._holds_from_s = now_s if from_s is None else from_s

    def take(
        self,
        setup: Setup,
        image: npt.NDArray[np.uint8],
        sightings: Mapping[str, Sighting],
        *,
        at_s: float,
    ) -> MotionState:
        """Return the motion state after one more image, (h, w) or (h, w, 3)."""
        if not np.array_equal(self._lens, setup.camera.lens):
            # Another camera model changes all poses without any motion.
            self._lens = setup.camera.lens
            self._jumps, self._reference = {}, None
            self._reference_is_elsewhere = self._reference_sways = False
        jumped = frozenset(
            name
            for name, seen in sightings.items()
            if isinstance(seen, Seen) and not self._believed(name, seen, at_s)
        )
        self._sight = self._sight.after(sightings, at_s=at_s)
        every_s = SCENE_URGENT_PERIOD_S if self._reference_is_elsewhere else SCENE_PERIOD_S
        if setup.has_images and at_s - self._looked_at_s >= every_s:
            self._looked_at_s = at_s
            self._look_at_scene(image, sightings, at_s)
        reference = sightings.get(setup.reference)
        if isinstance(reference, Seen) and setup.reference not in jumped:
            self._look_at_reference(reference, at_s, has_images=setup.has_images)
        return MotionState(
            jumped=jumped,
            camera_moved=self._camera_moved_at_s > self._holds_from_s,
            reference_moved=self._reference_sways or self._reference_moved_at_s > self._holds_from_s,
            scene=self._scene_state,
            unseen_s=self._sight.ages_s(sightings, at_s=at_s),
        )

    def _believed(self, name: str, seen: Seen, at_s: float) -> bool:
        watch = self._jumps.setdefault(name, PoseJumpDetector())
        return watch.take(seen.camera_from_marker, at_s=at_s).accepted

    def _look_at_scene(
        self, image: npt.NDArray[np.uint8], sightings: Mapping[str, Sighting], at_s: float
    ) -> None:
        grey = image if image.ndim == 2 else np.asarray(cv2.cvtColor(image, cv2.COLOR_BGR2GRAY), np.uint8)
        if self._scene is None:
            self._keep_scene(grey, sightings)
            return
        check = self._scene.check(grey)
        self._scene_state = check.state
        if check.state is SceneState.UNSURE and check.moved_px > self._scene.max_px:
            # Check the next image at once, because wrong numbers may be displayed.
            self._looked_at_s = -np.inf
        if self._scene_state is SceneState.MOVED:
            self._camera_moved_at_s = at_s
            # Monitor the new position from here on; the old registration is already invalid.
            self._keep_scene(grey, sightings)
            # Otherwise the reference would seem to have moved in the new, static scene.
            self._reference, self._reference_sways = None, False

    def _keep_scene(self, grey: npt.NDArray[np.uint8], sightings: Mapping[str, Sighting]) -> None:
        moving = [_roomy(seen.corners_px) for seen in sightings.values() if isinstance(seen, Seen)]
        self._scene = SceneMonitor(grey, exclude_px=tuple(moving))

    def _look_at_reference(self, seen: Seen, at_s: float, *, has_images: bool) -> None:
        if self._reference is None:
            self._begin_reference(seen, at_s)
            return
        # Only a scene check after the displacement can identify the moving object. Nothing shows a motion of
        # an external tracker: each displacement is supposed to be the reference's.
        is_new = self._looked_at_s > self._in_place_at_s
        scene = self._scene_state if is_new else SceneState.UNSURE
        scene = scene if has_images else SceneState.STILL
        check = self._reference.check(seen.camera_from_marker, scene, at_s=at_s)
        self._reference_is_elsewhere = check.images > 0
        if check.state is not ReferenceState.UNDETERMINED:
            self._reference_sways = check.state is ReferenceState.SWAYING
        if not self._reference_is_elsewhere:
            self._in_place_at_s = at_s
        if check.state is ReferenceState.MOVED:
            self._reference_moved_at_s = at_s
        if check.state in {ReferenceState.MOVED, ReferenceState.WITH_CAMERA}:
            self._begin_reference(seen, at_s)

    def _begin_reference(self, seen: Seen, at_s: float) -> None:
        self._reference = ReferenceMonitor(seen.camera_from_marker)
        self._reference_is_elsewhere = self._reference_sways = False
        self._in_place_at_s = at_s


def _roomy(corners_px: Array) -> Array:
    middle = corners_px.mean(axis=0)
    return np.asarray(middle + MASK_SIDES * (corners_px - middle))
