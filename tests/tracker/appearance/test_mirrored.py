"""Fits that all ended at one planar solution, where both were asked for."""

import numpy as np
import pytest

from tests.benchmarks.limits.finders import Searchers
from tests.benchmarks.limits.judging import Outcome, judged
from tests.benchmarks.scenes.conditions import Condition
from tests.benchmarks.scenes.faces import SAIL
from tests.benchmarks.scenes.placing import random_scene
from tests.benchmarks.scenes.rigs import RIGS
from tests.tracker.scenes import Print, camera_of, code_model, facing_at_px, rendered
from tracker.appearance import textures_of
from tracker.appearance.fit import Fitted, fitted
from tracker.appearance.light.fields.kernels import PLAIN
from tracker.appearance.mirrored import with_mirrored
from tracker.appearance.samples import Samples, samples_of
from tracker.geometry import Array, Camera, Marker, Rigid, vector_from_rotation
from tracker.pose import other_solution

CAMERA = camera_of()
MODEL = code_model()
FOCUS_PX2 = np.array([0.4, 0.4, 0.0])
TRUE: Rigid[Camera, Marker] = facing_at_px(
    CAMERA, (330.0, 220.0), 60.0, tilt_deg=10.0, about_deg=20.0, roll_deg=50.0
)
OTHER = other_solution(TRUE)
# Light that makes it hard to tell which way a marker is tilted that all but faces the camera.
UNCLEAR = Condition(
    name="unclear",
    blur_px=1.5,
    motion_px=5.0,
    read_noise_grey=4.0,
    light_ratio=0.5,
    shadow_ratio=0.4,
    glare_ratio=0.3,
    jpeg_quality=70,
    tilt_deg=(0.0, 8.0),
)


def _seen() -> Samples:
    return samples_of(
        rendered(CAMERA, [Print(picture=MODEL.image, pose=TRUE)], background=170.0),
        CAMERA.lens,
        textures_of(MODEL.square),
        TRUE,
        side_mm=MODEL.side_mm,
        step=1,
        blur_px2=FOCUS_PX2,
    )


def _fit(seen: Samples, start: Rigid[Camera, Marker]) -> Fitted:
    numbers = np.zeros(16)
    numbers[6:9] = FOCUS_PX2
    fit = fitted(seen, start.rotation, start.translation_mm, numbers, light=(PLAIN, 0))
    assert fit is not None
    return fit


def _off_deg(fit: Fitted) -> float:
    turn: Array = vector_from_rotation(fit.rotation @ TRUE.rotation.T)
    return float(np.degrees(np.linalg.norm(turn)))


def test_the_side_that_was_asked_for_is_fitted_too() -> None:
    seen = _seen()
    wrong = _fit(seen, OTHER)
    assert _off_deg(wrong) > 10.0
    both = with_mirrored(seen, [wrong], [TRUE.rotation, OTHER.rotation])
    assert both[0] is wrong
    assert [_off_deg(one) < 0.5 for one in both] == [False, True]


@pytest.mark.parametrize(("starts", "fits"), [([OTHER], [OTHER]), ([TRUE, OTHER], [TRUE, OTHER])])
def test_nothing_is_added_where_nobody_asked_or_both_are_there(
    starts: list[Rigid[Camera, Marker]], fits: list[Rigid[Camera, Marker]]
) -> None:
    seen = _seen()
    there = [_fit(seen, one) for one in fits]
    assert with_mirrored(seen, there, [one.rotation for one in starts]) == there


@pytest.mark.parametrize("seed", [6, 12])
def test_in_hard_light_a_marker_that_faces_the_camera_is_not_taken_for_its_mirror_image(seed: int) -> None:
    scene = random_scene(RIGS["B"], SAIL, UNCLEAR, seed=seed)
    found = judged(scene, Searchers().claim(scene))
    assert found.outcome is Outcome.RIGHT
    assert all(found.covered)
