"""Fits that all converged to one planar solution although both were started."""

import numpy as np
import pytest

from tests.benchmarks.limits.evaluation import Outcome, evaluate
from tests.benchmarks.limits.finders import Searchers
from tests.benchmarks.scenes.conditions import Condition
from tests.benchmarks.scenes.faces import SAIL
from tests.benchmarks.scenes.placement import random_scene
from tests.benchmarks.scenes.rigs import RIGS
from tests.tracker.scenes import Print, camera_of, code_model, facing_at_px, rendered
from tracker.geometry import Array, Camera, Marker, Rigid, vector_from_rotation
from tracker.photometric import textures_of
from tracker.photometric.fit import FitResult, fit_pose, with_mirror_solution
from tracker.photometric.illumination_kernels import PLANAR
from tracker.photometric.samples import Samples, sample_pixels
from tracker.pose import flipped_pose

CAMERA = camera_of()
MODEL = code_model()
FOCUS_PX2 = np.array([0.4, 0.4, 0.0])
TRUE: Rigid[Camera, Marker] = facing_at_px(
    CAMERA, (330.0, 220.0), 60.0, tilt_deg=10.0, about_deg=20.0, roll_deg=50.0
)
OTHER = flipped_pose(TRUE)
# Light that makes it hard to tell which way a marker is tilted that all but faces the camera.
UNCLEAR = Condition(
    name="unclear",
    blur_px=1.5,
    motion_px=5.0,
    read_noise_grey=4.0,
    illumination_ratio=0.5,
    shadow_ratio=0.4,
    glare_ratio=0.3,
    jpeg_quality=70,
    tilt_deg=(0.0, 8.0),
)


def _seen() -> Samples:
    return sample_pixels(
        rendered(CAMERA, [Print(picture=MODEL.image, pose=TRUE)], background=170.0),
        CAMERA.lens,
        textures_of(MODEL.square),
        TRUE,
        side_mm=MODEL.side_mm,
        step=1,
        blur_px2=FOCUS_PX2,
    )


def _fit(seen: Samples, start: Rigid[Camera, Marker]) -> FitResult:
    parameters = np.zeros(16)
    parameters[6:9] = FOCUS_PX2
    fit = fit_pose(seen, start.rotation, start.translation_mm, parameters, illumination=(PLANAR, 0))
    assert fit is not None
    return fit


def _off_deg(fit: FitResult) -> float:
    turn: Array = vector_from_rotation(fit.rotation @ TRUE.rotation.T)
    return float(np.degrees(np.linalg.norm(turn)))


def test_the_mirrored_solution_of_a_start_is_fitted_too() -> None:
    seen = _seen()
    wrong = _fit(seen, OTHER)
    assert _off_deg(wrong) > 10.0
    both = with_mirror_solution(seen, [wrong], [TRUE.rotation, OTHER.rotation])
    assert both[0] is wrong
    assert [_off_deg(one) < 0.5 for one in both] == [False, True]


@pytest.mark.parametrize(("starts", "fits"), [([OTHER], [OTHER]), ([TRUE, OTHER], [TRUE, OTHER])])
def test_nothing_is_added_without_a_start_or_with_both_solutions_present(
    starts: list[Rigid[Camera, Marker]], fits: list[Rigid[Camera, Marker]]
) -> None:
    seen = _seen()
    there = [_fit(seen, one) for one in fits]
    assert with_mirror_solution(seen, there, [one.rotation for one in starts]) == there


@pytest.mark.parametrize("seed", [6, 12])
def test_under_difficult_illumination_a_frontal_marker_keeps_its_tilt(seed: int) -> None:
    scene = random_scene(RIGS["B"], SAIL, UNCLEAR, seed=seed)
    found = evaluate(scene, Searchers().claim(scene))
    assert found.outcome is Outcome.CORRECT
    assert all(found.covered)
