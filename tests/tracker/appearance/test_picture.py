"""What a pixel is said to see of a marker, against its picture blurred finely and directly."""

import cv2
import numpy as np
import pytest

from tests.tracker.scenes import camera_of, code_model, facing_at_px
from tracker.appearance import textures_of
from tracker.appearance.picture.kernels import predict

CAMERA = camera_of(distortion=())
MODEL = code_model()
FINE = 16  # texels of the direct picture in each pixel


@pytest.mark.parametrize("blur_px", [0.7, 1.05, 1.6])
def test_pixels_see_the_picture_at_their_blur(blur_px: float) -> None:
    side_px, reach_px = 40.0, 24
    pose = facing_at_px(CAMERA, (323.3, 237.3), side_px)
    count = int(side_px * FINE)
    square = (
        cv2.resize(MODEL.square, (count, count), interpolation=cv2.INTER_LINEAR).astype(np.float64) / 255.0
    )
    margin = (reach_px + 8) * FINE - count // 2
    paper = cv2.copyMakeBorder(square, *(margin,) * 4, cv2.BORDER_CONSTANT, value=(1.0,))
    direct = cv2.GaussianBlur(paper, (0, 0), blur_px * FINE)

    place = np.stack(np.meshgrid(*(np.arange(-20.0, 20.0, 0.37),) * 2), axis=-1).reshape(-1, 2)
    rays = (
        place / side_px * MODEL.side_mm / pose.translation_mm[2]
        + pose.translation_mm[:2] / pose.translation_mm[2]
    )
    rows, at = np.zeros((10, len(rays))), np.empty((len(rays), 2))
    blur = np.array([blur_px**2, blur_px**2, 0.0])
    assert predict(
        rays, CAMERA.lens, pose.rotation, pose.translation_mm, MODEL.side_mm, blur,
        textures_of(MODEL.square).arrays, rows, at, False,
    )  # fmt: skip
    x, y = (place.T * FINE + (direct.shape[0] - 1) / 2.0).astype(np.float32)
    expected = cv2.remap(direct, x, y, cv2.INTER_LINEAR).ravel()
    off = rows[0] - expected
    assert np.abs(off).max() < 0.006
