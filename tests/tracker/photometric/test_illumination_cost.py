"""Cost of a photometric fit: residuals plus the prior on the illumination."""

from dataclasses import replace

import numpy as np
import pytest

from tests.tracker.scenes import Print, camera_of, code_model, facing_at_px, rendered
from tracker.photometric import textures_of
from tracker.photometric.equation_kernels import PLANAR_COUNT
from tracker.photometric.fit import fit_pose, robust_chi2_of
from tracker.photometric.illumination import select_illumination
from tracker.photometric.illumination_kernels import (
    ADDITIVE,
    MULTIPLICATIVE,
    PLANAR,
    from_planar,
    parameter_count,
)
from tracker.photometric.response_kernels import BLUR, ILLUMINATION
from tracker.photometric.samples import sample_pixels

CAMERA, MODEL = camera_of(), code_model()
SPLINE_NODES = 10


def test_of_two_fits_with_equal_residuals_the_one_with_unusual_illumination_costs_more() -> None:
    pose = facing_at_px(CAMERA, (330.0, 220.0), 40.0, tilt_deg=35.0, about_deg=20.0, roll_deg=50.0)
    image = rendered(CAMERA, [Print(picture=MODEL.image, pose=pose)])
    blur_px2 = np.array([0.45, 0.45, 0.0])
    # Nothing is seen of the right half.
    seen = sample_pixels(
        image,
        CAMERA.lens,
        textures_of(MODEL.square),
        pose,
        side_mm=MODEL.side_mm,
        step=1,
        blur_px2=blur_px2,
        occluded_at=lambda at_ratio: at_ratio[:, 0] > 0.0,
    )
    start = np.zeros(PLANAR_COUNT)
    start[BLUR : BLUR + 3] = blur_px2
    even = fit_pose(seen, pose.rotation, pose.translation_mm, start, illumination=(PLANAR, 0))
    assert even is not None
    illumination = (MULTIPLICATIVE, SPLINE_NODES)
    parameters = np.zeros(parameter_count(illumination))
    from_planar(even.parameters, illumination, parameters)
    usual = replace(even, illumination=illumination, parameters=parameters)
    strange = replace(usual, parameters=parameters.copy())
    # At the far right, in the middle of the height: half as bright again.
    strange.parameters[ILLUMINATION + SPLINE_NODES * (SPLINE_NODES // 2) + SPLINE_NODES - 1] *= 1.5
    scale = even.residual_sd_grey
    assert robust_chi2_of(seen, strange, scale) > robust_chi2_of(seen, usual, scale) + 5.0


@pytest.mark.parametrize(("kind", "dims", "adds"), [(MULTIPLICATIVE, 0.5, 0.0), (ADDITIVE, 0.0, 90.0)])
def test_a_shadow_is_distinguished_from_a_highlight(kind: int, dims: float, adds: float) -> None:
    pose = facing_at_px(CAMERA, (330.0, 220.0), 60.0, tilt_deg=35.0, about_deg=20.0, roll_deg=50.0)
    image = rendered(CAMERA, [Print(picture=MODEL.image, pose=pose)]).astype(np.float64)
    x, y = np.meshgrid(np.arange(image.shape[1]), np.arange(image.shape[0]))
    edge = 1.0 / (1.0 + np.exp((x - 330.0) / 3.0))
    spot = np.exp(-((x - 322.0) ** 2 + (y - 226.0) ** 2) / (2.0 * 12.0**2))
    dark_contrast = np.clip(np.round(0.6 * image * (1.0 - dims * edge) + adds * spot), 0, 255).astype(
        np.uint8
    )
    blur_px2 = np.array([0.45, 0.45, 0.0])
    seen = sample_pixels(
        dark_contrast,
        CAMERA.lens,
        textures_of(MODEL.square),
        pose,
        side_mm=MODEL.side_mm,
        step=1,
        blur_px2=blur_px2,
    )
    start = np.zeros(PLANAR_COUNT)
    start[BLUR : BLUR + 3] = blur_px2
    even = fit_pose(seen, pose.rotation, pose.translation_mm, start, illumination=(PLANAR, 0))
    assert even is not None
    (found,) = select_illumination(seen, [even], 2.0)
    assert found.illumination[0] == kind
    assert found.residual_sd_grey < 0.3 * even.residual_sd_grey
