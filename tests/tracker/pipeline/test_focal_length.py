"""The focal length by the perspective of a marker, against a camera model with a known error."""

from functools import cache

import numpy as np
import pytest

from tests.benchmarks.scenes.conditions import conditions_of
from tests.benchmarks.scenes.faces import FACES
from tests.benchmarks.scenes.hand import hand_scenes
from tests.benchmarks.scenes.rigs import Rig
from tests.benchmarks.scenes.scene import image_of
from tests.tracker.small_scenes import Image
from tracker import CameraModel, MarkerModel, Tracker
from tracker.photometric import FocalLengthError

RIG = Rig(name="near", size_wh_px=(320, 240), focal_px=500.0, depth_mm=(200.0, 300.0))
FACE = FACES[0]
# A hand at 60 Hz, of which the camera takes every third image.
SCENES, TAKEN = 180, 3


@cache
def _images(condition: str) -> tuple[tuple[float, Image], ...]:
    scenes = hand_scenes(RIG, FACE, "fast", seed=3, count=SCENES, condition=conditions_of(RIG)[condition])
    return tuple((at_s, image_of(scene)) for k, (at_s, scene) in enumerate(scenes) if k % TAKEN == 0)


def _by_marker(
    condition: str = "base", *, stated_error: float = 0.0, images: int = SCENES
) -> FocalLengthError | None:
    """Return the error by a marker in a hand, where the stated focal length is wrong by this ratio."""
    matrix = np.array(RIG.matrix)
    matrix[[0, 1], [0, 1]] *= 1.0 + stated_error
    camera = CameraModel(matrix=matrix, distortion=np.zeros(5), size_wh_px=RIG.size_wh_px)
    tracker = Tracker(camera=camera, models=[FACE.model])
    for at_s, image in _images(condition)[:images]:
        tracker.step(image, captured_at_s=at_s)
    return tracker.focal_length.error


@pytest.mark.parametrize("stated_error", [0.0, 0.02, -0.03])
def test_its_error_is_within_three_standard_deviations(stated_error: float) -> None:
    error = _by_marker(stated_error=stated_error)
    assert error is not None
    assert abs(error.ratio - stated_error) < 3.0 * error.sd
    assert error.sd < 0.003


def test_few_views_do_not_determine_it() -> None:
    assert _by_marker(images=10) is None


def test_an_occluded_marker_does_not_determine_it() -> None:
    assert _by_marker("cover20") is None


def test_a_new_set_up_of_the_same_camera_keeps_it() -> None:
    def tracker(*, focal_ratio: float = 1.0, side_ratio: float = 1.0) -> Tracker:
        matrix = np.array(RIG.matrix)
        matrix[0, 0] *= focal_ratio
        camera = CameraModel(matrix=matrix, distortion=np.zeros(5), size_wh_px=RIG.size_wh_px)
        model = MarkerModel.from_image(FACE.image, side_mm=FACE.side_mm * side_ratio, name=FACE.name)
        return Tracker(camera=camera, models=[model])

    before = tracker()
    for at_s, image in _images("base"):
        before.step(image, captured_at_s=at_s)
    assert before.focal_length.error is not None
    errors = []
    for after in (tracker(), tracker(focal_ratio=1.01), tracker(side_ratio=2.0)):
        after.focal_length.adopt(before.focal_length)
        errors.append(after.focal_length.error)
    assert errors == [before.focal_length.error, None, None]
