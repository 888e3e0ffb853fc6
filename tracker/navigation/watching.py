"""All watches of one theatre, fed image by image.

What moved stays moved until a new registration; a check on one landmark clears it only beside a reference,
because a rotation about that landmark is not seen there. A registration that was disturbed by a cable must
be repeated, however small the shift. While hands cover the scene there is no answer, and that state is
reported as such.
"""

from collections.abc import Mapping

import cv2
import numpy as np
import numpy.typing as npt

from tracker.geometry import Array
from tracker.navigation.snapshot import Setup, Watched
from tracker.navigation.watch import (
    JumpWatch,
    LastSight,
    ReferenceState,
    ReferenceWatch,
    SceneState,
    SceneWatch,
)
from tracker.pose import Seen, Sighting

SCENE_EVERY_S = 0.2
# While the reference is elsewhere, the scene alone tells what moved: it is asked soon.
SCENE_SOON_S = 0.1
# Around a marker's outline, in sides of it: the hand and the handpiece move with it.
ROOM_SIDES = 3.0


class Watching:
    """What no image says alone. Mutable: a jump watch for each marker, one for the scene and the reference.

    The scene and the reference are watched from the first image on, so that a camera that moves between two
    touched landmarks is noticed, too: a registration counts from when its first landmark was touched. What
    moved is said until another registration takes its place.
    """

    def __init__(self) -> None:
        self._lens: Array = np.zeros(0)
        self._jumps: dict[str, JumpWatch] = {}
        self._sight = LastSight()
        self._scene: SceneWatch | None = None
        self._scene_state = SceneState.UNSURE
        self._looked_at_s = -np.inf
        self._reference: ReferenceWatch | None = None
        self._in_place_at_s = -np.inf
        self._reference_is_elsewhere = False
        self._camera_moved_at_s = -np.inf
        self._reference_moved_at_s = -np.inf
        self._holds_from_s = -np.inf

    def begin(self, *, from_s: float | None, now_s: float) -> None:
        """Another registration stands from the next image on, or the same after a check on anatomy.

        Args:
            from_s: when its first landmark was touched, or it was checked on anatomy for the last time; None
                where that was before this watch began.
            now_s: the same clock.
        """
        self._holds_from_s = now_s if from_s is None else from_s

    def take(
        self,
        setup: Setup,
        image: npt.NDArray[np.uint8],
        sightings: Mapping[str, Sighting],
        *,
        at_s: float,
    ) -> Watched:
        """What is known with one more image, (h, w) or (h, w, 3)."""
        if not np.array_equal(self._lens, setup.camera.lens):
            # Another camera model places what stands still elsewhere: nothing has moved or jumped by that.
            self._lens = setup.camera.lens
            self._jumps, self._reference, self._reference_is_elsewhere = {}, None, False
        jumped = frozenset(
            name
            for name, seen in sightings.items()
            if isinstance(seen, Seen) and not self._believed(name, seen, at_s)
        )
        self._sight = self._sight.after(sightings, at_s=at_s)
        every_s = SCENE_SOON_S if self._reference_is_elsewhere else SCENE_EVERY_S
        if at_s - self._looked_at_s >= every_s:
            self._looked_at_s = at_s
            self._look_at_scene(image, sightings, at_s)
        reference = sightings.get(setup.reference)
        if isinstance(reference, Seen) and setup.reference not in jumped:
            self._look_at_reference(reference, at_s)
        return Watched(
            jumped=jumped,
            camera_moved=self._camera_moved_at_s > self._holds_from_s,
            reference_moved=self._reference_moved_at_s > self._holds_from_s,
            scene=self._scene_state,
            unseen_s=self._sight.ages_s(sightings, at_s=at_s),
        )

    def _believed(self, name: str, seen: Seen, at_s: float) -> bool:
        watch = self._jumps.setdefault(name, JumpWatch())
        return watch.take(seen.camera_from_marker, at_s=at_s).believed

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
            # It moved, or seems to: the next image says which, while wrong numbers may be shown.
            self._looked_at_s = -np.inf
        if self._scene_state is SceneState.MOVED:
            self._camera_moved_at_s = at_s
            # From here on it is watched where it stands now; what stood on the old place is lost already.
            self._keep_scene(grey, sightings)
            # Or the reference, elsewhere in a scene that is still from now on, would seem to have moved.
            self._reference = None

    def _keep_scene(self, grey: npt.NDArray[np.uint8], sightings: Mapping[str, Sighting]) -> None:
        moving = [_roomy(seen.corners_px) for seen in sightings.values() if isinstance(seen, Seen)]
        self._scene = SceneWatch(grey, leave_out_px=tuple(moving))

    def _look_at_reference(self, seen: Seen, at_s: float) -> None:
        if self._reference is None:
            self._reference = ReferenceWatch(seen.camera_from_marker)
            self._reference_is_elsewhere = False
            self._in_place_at_s = at_s
            return
        # What the scene said before the reference was elsewhere says nothing of what moved it.
        is_new = self._looked_at_s > self._in_place_at_s
        check = self._reference.check(
            seen.camera_from_marker, self._scene_state if is_new else SceneState.UNSURE
        )
        self._reference_is_elsewhere = check.images > 0
        if not self._reference_is_elsewhere:
            self._in_place_at_s = at_s
        if check.state is ReferenceState.MOVED:
            self._reference_moved_at_s = at_s
        if check.state in {ReferenceState.MOVED, ReferenceState.WITH_CAMERA}:
            self._reference = ReferenceWatch(seen.camera_from_marker)
            self._reference_is_elsewhere = False
            self._in_place_at_s = at_s


def _roomy(corners_px: Array) -> Array:
    middle = corners_px.mean(axis=0)
    return np.asarray(middle + ROOM_SIDES * (corners_px - middle))
