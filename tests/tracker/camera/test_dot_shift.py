"""Dots seen obliquely: the centroid of a dot's image is not the image of its centre."""

import numpy as np
import pytest

from tests.tracker.camera.rendered import CAMERA, POSES, Pose, placed_board
from tracker.camera import DotBoard
from tracker.camera.calibration import CalibrationSettings, calibrate
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
    """Computed from fine cells of the image that show the dot, minus the image of its centre."""
    rotation, place = rotation_from_vector(turn_rad), np.array([5.0, -3.0, 120.0])
    middle = (CAMERA.matrix @ place)[:2] / place[2]
    u, v = np.meshgrid(np.arange(-45, 45, 0.1), np.arange(-45, 45, 0.1))
    px = np.stack([u.ravel(), v.ravel(), np.zeros(u.size)], axis=1) + np.append(middle, 1.0)
    rays = px @ np.linalg.inv(CAMERA.matrix).T
    normal = rotation[:, 2]
    at = (rays * ((normal @ place) / (rays @ normal))[:, None] - place) @ rotation
    return np.asarray(px[(at[:, :2] ** 2).sum(axis=1) < 36.0][:, :2].mean(axis=0) - middle)


@pytest.mark.parametrize("rotation_deg", [(0, 0, 0), (40, 0, 0), (-25, 30, 10)])
def test_the_shift_is_what_counting_cells_gives(rotation_deg: tuple[float, float, float]) -> None:
    turn = np.radians(rotation_deg)
    fit, view = one_dot(turn)
    np.testing.assert_allclose(dot_shifts_px(fit, 0, view)[0], middle_of_image(turn), atol=0.01)


def test_a_tilted_dot_is_off_by_more_than_its_noise() -> None:
    fit, view = one_dot(np.radians([40.0, 0.0, 0.0]))
    assert np.linalg.norm(dot_shifts_px(fit, 0, view)) > 0.5


def view_of_large_dots(pose: Pose) -> BoardView:
    """Centroids of nearly touching dots, almost without noise, one of them displaced by glare."""
    board = DotBoard(columns=8, rows=6, pitch_mm=30.0)
    rotation, translation = placed_board(board, pose)
    around = np.linspace(0.0, 2.0 * np.pi, 4000, endpoint=False)
    radii = 13.0 * np.sqrt((np.arange(10) + 0.5) / 10)
    disc = radii[:, None, None] * np.stack([np.cos(around), np.sin(around), 0 * around], axis=1)[::100]
    spots = np.asarray(board.object_points_mm)[:, None, :] + disc.reshape(-1, 3)
    px = CAMERA.px_from_camera(spots.reshape(-1, 3) @ rotation.T + translation).reshape(len(spots), -1, 2)
    depth = (spots @ rotation[2] + translation[2])[..., None]
    # The nearer a part of a dot, the larger its image.
    middles = (px / depth**3).sum(axis=1) / (1.0 / depth**3).sum(axis=1)
    rng = np.random.default_rng(round(10.0 * sum(pose[0]) + 1000.0))
    middles += rng.normal(0.0, 0.01, middles.shape)
    middles[0] += 2.0
    return BoardView(
        ids=np.arange(len(spots)),
        object_points_mm=board.object_points_mm,
        image_points_px=middles,
        dot_radii_mm=np.full(len(spots), 13.0),
    )


def test_points_are_judged_where_the_shift_has_put_them() -> None:
    """Without the correction, most of these would be off by many times their noise."""
    views = [view_of_large_dots((turn, (x, y, 2.0 * z))) for turn, (x, y, z) in POSES[1:]]
    report = calibrate(views, size_wh_px=CAMERA.size_wh_px, settings=CalibrationSettings(coefficients=5))
    assert report.views_used == len(views)
    assert all(1 <= view.dropped_points <= 3 for view in report.views)
    assert report.rms_px < 0.03
    assert report.camera.matrix[0, 0] == pytest.approx(CAMERA.matrix[0, 0], rel=2e-4)
