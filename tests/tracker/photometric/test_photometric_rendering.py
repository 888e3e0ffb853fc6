"""Predicted pixel values against a directly blurred high-resolution image."""

import cv2
import numpy as np
import pytest

from tests.tracker.scenes import camera_of, code_model, facing_at_px
from tracker.geometry import Array
from tracker.photometric import textures_of
from tracker.photometric.render_kernels import predict

CAMERA = camera_of(distortion=())
MODEL = code_model()
FINE = 16  # texels of the direct picture in each pixel


SIDE_PX, REACH_PX = 40.0, 24
POSE = facing_at_px(CAMERA, (323.3, 237.3), SIDE_PX)
# Where pixels look, in px from the marker's centre.
PLACES = np.stack(np.meshgrid(*(np.arange(-20.0, 20.0, 0.37),) * 2), axis=-1).reshape(-1, 2)


def _seen(blur_px2: list[float]) -> Array:
    """Return the prediction and its derivatives (10, n) for these pixels."""
    focus = POSE.translation_mm[:2] / POSE.translation_mm[2]
    rays = PLACES / SIDE_PX * MODEL.side_mm / POSE.translation_mm[2] + focus
    rows, at = np.zeros((10, len(rays))), np.empty((len(rays), 2))
    assert predict(
        rays, CAMERA.lens, POSE.rotation, POSE.translation_mm, MODEL.side_mm, np.array(blur_px2),
        textures_of(MODEL.square).arrays, rows, at, True,
    )  # fmt: skip
    return rows


def _direct(blur_px: float, *, drawn_px: tuple[float, float] = (0.0, 0.0)) -> Array:
    """Return the pixel values of a high-resolution image blurred by defocus and motion."""
    count = int(SIDE_PX * FINE)
    square = (
        cv2.resize(MODEL.square, (count, count), interpolation=cv2.INTER_LINEAR).astype(np.float64) / 255.0
    )
    margin = (REACH_PX + 8) * FINE - count // 2
    paper = cv2.copyMakeBorder(square, *(margin,) * 4, cv2.BORDER_CONSTANT, value=(1.0,))
    blurred = cv2.GaussianBlur(paper, (0, 0), blur_px * FINE)
    middle = (blurred.shape[0] - 1) / 2.0
    moments = (np.arange(100) + 0.5) / 100 - 0.5 if any(drawn_px) else np.zeros(1)
    looks = []
    for moment in moments:
        x, y = ((PLACES + moment * np.array(drawn_px)).T * FINE + middle).astype(np.float32)
        looks.append(cv2.remap(blurred, x, y, cv2.INTER_LINEAR).ravel())
    return np.asarray(np.mean(looks, axis=0), dtype=np.float64)


@pytest.mark.parametrize("blur_px", [0.7, 1.05, 1.6])
def test_prediction_matches_the_blurred_image(blur_px: float) -> None:
    off = _seen([blur_px**2, blur_px**2, 0.0])[0] - _direct(blur_px)
    assert np.abs(off).max() < 0.006


@pytest.mark.parametrize("drawn_px", [(3.0, 0.0), (-4.0, 5.0), (6.0, 11.0)])
def test_motion_blur_is_a_box_along_a_line(
    drawn_px: tuple[float, float],
) -> None:
    """A Gaussian of equal variance would be off by a tenth of the contrast."""
    blur_px, (x, y) = 0.7, drawn_px
    blur_px2 = [blur_px**2 + x * x / 12.0, blur_px**2 + y * y / 12.0, x * y / 12.0]
    off = _seen(blur_px2)[0] - _direct(blur_px, drawn_px=drawn_px)
    assert np.abs(off).max() < 0.012


@pytest.mark.parametrize("which", [0, 1, 2])
def test_blur_derivatives_match_finite_differences_under_motion_blur(which: int) -> None:
    blur_px2 = np.array([2.1, 3.3, 1.2])
    more = np.eye(3)[which] * 0.03
    change = (_seen([*(blur_px2 + more)])[0] - _seen([*(blur_px2 - more)])[0]) / 0.06
    said = _seen([*blur_px2])[7 + which]
    assert float(np.linalg.norm(said - change)) < 0.2 * float(np.linalg.norm(change))
