"""What a fit costs: what it leaves of the pixels, and how strange the light is that it needs."""

from dataclasses import replace

import numpy as np
import pytest

from tests.tracker.scenes import Print, camera_of, code_model, facing_at_px, rendered
from tracker.appearance import textures_of
from tracker.appearance.equations.kernels import EVEN
from tracker.appearance.fit import cost_of, fitted
from tracker.appearance.light.fields.kernels import GLARING, PLAIN, SHADED, from_plain, numbers_of
from tracker.appearance.light.kernels import BLUR, LIGHT
from tracker.appearance.samples import samples_of
from tracker.appearance.uneven import in_light_that_explains

CAMERA, MODEL = camera_of(), code_model()
NODES = 10


def test_of_two_fits_that_leave_as_much_the_one_in_stranger_light_costs_more() -> None:
    pose = facing_at_px(CAMERA, (330.0, 220.0), 40.0, tilt_deg=35.0, about_deg=20.0, roll_deg=50.0)
    image = rendered(CAMERA, [Print(picture=MODEL.image, pose=pose)])
    blur_px2 = np.array([0.45, 0.45, 0.0])
    # Nothing is seen of the right half.
    seen = samples_of(
        image,
        CAMERA.lens,
        textures_of(MODEL.square),
        pose,
        side_mm=MODEL.side_mm,
        step=1,
        blur_px2=blur_px2,
        covered_at=lambda at_ratio: at_ratio[:, 0] > 0.0,
    )
    start = np.zeros(EVEN)
    start[BLUR : BLUR + 3] = blur_px2
    even = fitted(seen, pose.rotation, pose.translation_mm, start, light=(PLAIN, 0))
    assert even is not None
    light = (SHADED, NODES)
    numbers = np.zeros(numbers_of(light))
    from_plain(even.numbers, light, numbers)
    usual = replace(even, light=light, numbers=numbers)
    strange = replace(usual, numbers=numbers.copy())
    # At the far right, in the middle of the height: half as bright again.
    strange.numbers[LIGHT + NODES * (NODES // 2) + NODES - 1] *= 1.5
    scale = even.scale_grey
    assert cost_of(seen, strange, scale) > cost_of(seen, usual, scale) + 5.0


@pytest.mark.parametrize(("kind", "dims", "adds"), [(SHADED, 0.5, 0.0), (GLARING, 0.0, 90.0)])
def test_a_shadow_is_told_from_a_highlight(kind: int, dims: float, adds: float) -> None:
    pose = facing_at_px(CAMERA, (330.0, 220.0), 60.0, tilt_deg=35.0, about_deg=20.0, roll_deg=50.0)
    image = rendered(CAMERA, [Print(picture=MODEL.image, pose=pose)]).astype(np.float64)
    x, y = np.meshgrid(np.arange(image.shape[1]), np.arange(image.shape[0]))
    edge = 1.0 / (1.0 + np.exp((x - 330.0) / 3.0))
    spot = np.exp(-((x - 322.0) ** 2 + (y - 226.0) ** 2) / (2.0 * 12.0**2))
    lit = np.clip(np.round(0.6 * image * (1.0 - dims * edge) + adds * spot), 0, 255).astype(np.uint8)
    blur_px2 = np.array([0.45, 0.45, 0.0])
    seen = samples_of(
        lit, CAMERA.lens, textures_of(MODEL.square), pose, side_mm=MODEL.side_mm, step=1, blur_px2=blur_px2
    )
    start = np.zeros(EVEN)
    start[BLUR : BLUR + 3] = blur_px2
    even = fitted(seen, pose.rotation, pose.translation_mm, start, light=(PLAIN, 0))
    assert even is not None
    (found,) = in_light_that_explains(seen, [even], 2.0)
    assert found.light[0] == kind
    assert found.scale_grey < 0.3 * even.scale_grey
