"""Trackers for the cameras and faces of the scenes, and a warm one before anything is timed."""

from collections.abc import Sequence

from tests.benchmarks.limits.judging import Claim, claim_of
from tests.benchmarks.scenes.faces import Face
from tests.benchmarks.scenes.placing import random_scene
from tests.benchmarks.scenes.rigs import Rig
from tests.benchmarks.scenes.scene import Scene, image_of
from tracker import Tracker


def tracker_of(rig: Rig, faces: Sequence[Face]) -> Tracker:
    """A new tracker that knows these faces."""
    return Tracker(camera=rig.camera, models=[face.model for face in faces])


class Searchers:
    """`Tracker.search` for one face at a time: trackers are kept, what they find is not."""

    def __init__(self) -> None:
        self._kept: dict[tuple[Rig, str], Tracker] = {}

    def claim(self, scene: Scene) -> Claim | None:
        """What a search of the scene's image says of its first marker."""
        face = scene.board.face
        key = (scene.rig, face.name)
        if key not in self._kept:
            self._kept[key] = tracker_of(scene.rig, [face])
        return claim_of(self._kept[key].search(image_of(scene))[face.name])


def warm(rig: Rig, face: Face) -> Tracker:
    """A tracker that has searched and stepped through an image that is none of those to come."""
    tracker = tracker_of(rig, [face])
    image = image_of(random_scene(rig, face, seed=10**6))
    for number in range(3):
        tracker.step(image, captured_at_s=number / 60.0)
    tracker.search(image)
    return tracker
