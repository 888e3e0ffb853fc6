"""Trackers for the cameras and faces of the scenes, warmed up before timing."""

from collections.abc import Sequence

from tests.benchmarks.limits.evaluation import Claim, claim_of
from tests.benchmarks.scenes.faces import Face
from tests.benchmarks.scenes.placement import random_scene
from tests.benchmarks.scenes.rigs import Rig
from tests.benchmarks.scenes.scene import Scene, image_of
from tracker import Tracker


def tracker_of(rig: Rig, faces: Sequence[Face]) -> Tracker:
    """Return a new tracker for these faces."""
    return Tracker(camera=rig.camera, models=[face.model for face in faces])


class Searchers:
    """`Tracker.search` for one face at a time; trackers are cached, results are not."""

    def __init__(self) -> None:
        self._trackers: dict[tuple[Rig, str], Tracker] = {}

    def claim(self, scene: Scene) -> Claim | None:
        """Return the claim of a search for the scene's first marker."""
        face = scene.board.face
        key = (scene.rig, face.name)
        if key not in self._trackers:
            self._trackers[key] = tracker_of(scene.rig, [face])
        return claim_of(self._trackers[key].search(image_of(scene))[face.name])


def warm(rig: Rig, face: Face) -> Tracker:
    """Return a tracker after some steps and a search on an image that is not measured."""
    tracker = tracker_of(rig, [face])
    image = image_of(random_scene(rig, face, seed=10**6))
    for number in range(3):
        tracker.step(image, captured_at_s=number / 60.0)
    tracker.search(image)
    return tracker
