"""Dots seen from aside: the middle of the image of a dot is not the image of its middle."""

import numpy as np
import pytest

from tests.tracker.camera.rendered import CAMERA
from tracker.camera.calibration.dot_shift import dot_shifts_px
from tracker.camera.calibration.fit import Fit
from tracker.camera.detection import BoardView
from tracker.geometry import Array, rotation_from_vector


def one_dot(turn_rad: Array) -> tuple[Fit, BoardView]:
    fit = Fit(
        matrix=CAMERA.matrix,
        distortion=np.zeros(5),
        rotations_rad=turn_rad[None],
        translations_mm=np.array([[5.0, -3.0, 120.0]]),
        residuals_px=(np.zeros((1, 2)),),
    )
    view = BoardView(
        ids=np.arange(1),
        object_points_mm=np.zeros((1, 3)),
        image_points_px=np.zeros((1, 2)),
        dot_radii_mm=np.array([6.0]),
    )
    return fit, view


def middle_of_image(turn_rad: Array) -> Array:
    """By counting fine cells of the image that show the dot, minus the image of its middle."""
    rotation, place = rotation_from_vector(turn_rad), np.array([5.0, -3.0, 120.0])
    middle = (CAMERA.matrix @ place)[:2] / place[2]
    u, v = np.meshgrid(np.arange(-45, 45, 0.1), np.arange(-45, 45, 0.1))
    px = np.stack([u.ravel(), v.ravel(), np.zeros(u.size)], axis=1) + np.append(middle, 1.0)
    rays = px @ np.linalg.inv(CAMERA.matrix).T
    normal = rotation[:, 2]
    at = (rays * ((normal @ place) / (rays @ normal))[:, None] - place) @ rotation
    return np.asarray(px[(at[:, :2] ** 2).sum(axis=1) < 36.0][:, :2].mean(axis=0) - middle)


@pytest.mark.parametrize("turn_deg", [(0, 0, 0), (40, 0, 0), (-25, 30, 10)])
def test_the_shift_is_what_counting_cells_gives(turn_deg: tuple[float, float, float]) -> None:
    turn = np.radians(turn_deg)
    fit, view = one_dot(turn)
    np.testing.assert_allclose(dot_shifts_px(fit, 0, view)[0], middle_of_image(turn), atol=0.01)


def test_a_tilted_dot_is_off_by_more_than_its_noise() -> None:
    fit, view = one_dot(np.radians([40.0, 0.0, 0.0]))
    assert np.linalg.norm(dot_shifts_px(fit, 0, view)) > 0.5
