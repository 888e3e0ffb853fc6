"""What a pixel is said to see of a marker, against its picture blurred finely and directly."""

import cv2
import numpy as np
import pytest

from tests.tracker.scenes import camera_of, code_model, facing_at_px
from tracker.appearance import textures_of
from tracker.appearance.picture.kernels import predict
from tracker.geometry import Array

CAMERA = camera_of(distortion=())
MODEL = code_model()
FINE = 16  # texels of the direct picture in each pixel


SIDE_PX, REACH_PX = 40.0, 24
POSE = facing_at_px(CAMERA, (323.3, 237.3), SIDE_PX)
# Where pixels look, in px from the marker's centre.
PLACES = np.stack(np.meshgrid(*(np.arange(-20.0, 20.0, 0.37),) * 2), axis=-1).reshape(-1, 2)


def _seen(blur_px2: list[float]) -> Array:
    """What the loops say that these pixels see: the picture, and how it changes (10, n)."""
    focus = POSE.translation_mm[:2] / POSE.translation_mm[2]
    rays = PLACES / SIDE_PX * MODEL.side_mm / POSE.translation_mm[2] + focus
    rows, at = np.zeros((10, len(rays))), np.empty((len(rays), 2))
    assert predict(
        rays, CAMERA.lens, POSE.rotation, POSE.translation_mm, MODEL.side_mm, np.array(blur_px2),
        textures_of(MODEL.square).arrays, rows, at, True,
    )  # fmt: skip
    return rows


def _direct(blur_px: float, *, drawn_px: tuple[float, float] = (0.0, 0.0)) -> Array:
    """What they see of a finely made picture, blurred and drawn along a line."""
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
def test_pixels_see_the_picture_at_their_blur(blur_px: float) -> None:
    off = _seen([blur_px**2, blur_px**2, 0.0])[0] - _direct(blur_px)
    assert np.abs(off).max() < 0.006


@pytest.mark.parametrize("drawn_px", [(3.0, 0.0), (-4.0, 5.0), (6.0, 11.0)])
def test_while_the_shutter_is_open_the_picture_is_drawn_evenly_along_a_line(
    drawn_px: tuple[float, float],
) -> None:
    """As a bell of the same variance it would be off by a tenth of the contrast."""
    blur_px, (x, y) = 0.7, drawn_px
    blur_px2 = [blur_px**2 + x * x / 12.0, blur_px**2 + y * y / 12.0, x * y / 12.0]
    off = _seen(blur_px2)[0] - _direct(blur_px, drawn_px=drawn_px)
    assert np.abs(off).max() < 0.012


@pytest.mark.parametrize("which", [0, 1, 2])
def test_how_a_smeared_picture_changes_by_its_blur_is_what_a_little_more_of_it_does(which: int) -> None:
    blur_px2 = np.array([2.1, 3.3, 1.2])
    more = np.eye(3)[which] * 0.03
    change = (_seen([*(blur_px2 + more)])[0] - _seen([*(blur_px2 - more)])[0]) / 0.06
    said = _seen([*blur_px2])[7 + which]
    assert float(np.linalg.norm(said - change)) < 0.2 * float(np.linalg.norm(change))
