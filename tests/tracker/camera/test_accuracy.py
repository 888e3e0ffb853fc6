"""Errors of a calibrated camera's measurements on a plane are true errors, which no fit hides."""

import numpy as np
import pytest

from tests.tracker.camera.seen_grids import CAMERA, GRID, MATRIX, MOVE, TURN, rows, seen_at
from tracker.camera import CameraModel
from tracker.camera.accuracy import (
    accuracy_left_out,
    accuracy_of_grid,
    accuracy_of_ruler,
    accuracy_on_plane,
)
from tracker.camera.displacements import Displacements
from tracker.camera.ruler import Ruler
from tracker.errors import CalibrationError, InvalidInput, NavigationError
from tracker.geometry import Array


def test_a_true_camera_has_no_error_whatever_way_the_plane_lies() -> None:
    fit = GRID + 3.5
    report = accuracy_on_plane(CAMERA, rows(), fit_mm=fit, fit_px=seen_at(fit))
    assert report.maximum_error_mm < 1e-4
    assert report.fit_points == 63
    assert report.fit_rms_px < 1e-4
    middle = np.append(rows().points_mm.mean(axis=0), 0.0)
    assert report.plane_distance_mm == pytest.approx(np.linalg.norm(TURN @ middle + MOVE), abs=1e-2)
    assert accuracy_left_out(CAMERA, rows()).maximum_error_mm < 1e-4
    assert accuracy_of_grid(CAMERA, GRID, seen_at(GRID)).maximum_error_mm < 1e-4


def test_columns_of_a_table_are_points_too() -> None:
    table = np.concatenate([GRID, seen_at(GRID)], axis=1)
    assert accuracy_of_grid(CAMERA, table[:, :2], table[:, 2:]).maximum_error_mm < 1e-4


def test_a_lens_left_out_shows_in_millimetres() -> None:
    without = CameraModel(matrix=MATRIX, distortion=np.zeros(5), size_wh_px=(1280, 720))
    report = accuracy_of_grid(without, GRID, seen_at(GRID))
    assert report.maximum_error_mm > 0.2
    assert 0.1 < report.rms_error_mm < report.maximum_error_mm
    assert report.fit_rms_px > 0.3


def test_noise_of_pixels_is_measured_at_its_size() -> None:
    """At 3 px/mm, two ends with 0.3 px noise each give about 0.14 mm, more where the plane recedes."""
    report = accuracy_left_out(CAMERA, rows(25, noise_px=0.3))
    assert 0.08 < report.rms_error_mm < 0.25
    assert report.errors_mm == pytest.approx(report.measured_mm - report.known_mm)
    assert report.maximum_error_mm == pytest.approx(np.abs(report.errors_mm).max())
    assert report.rms_error_mm == pytest.approx(np.sqrt((report.errors_mm**2).mean()))


def test_what_is_measured_is_never_what_the_plane_was_fitted_to() -> None:
    """One wrong point: a fit that included it would hide part of its error."""
    displaced = rows(6)
    px = displaced.first_px.copy()
    px[2] += [8.0, 0.0]
    wrong = Displacements(
        first_mm=displaced.first_mm, second_mm=displaced.second_mm, first_px=px, second_px=displaced.second_px
    )
    alone = accuracy_on_plane(CAMERA, wrong, fit_mm=GRID + 3.5, fit_px=seen_at(GRID + 3.5))
    left_out = accuracy_left_out(CAMERA, wrong)
    assert left_out.errors_mm[2] == pytest.approx(alone.errors_mm[2], abs=1e-3)
    assert abs(left_out.errors_mm[2]) > 1.0


def test_points_that_displacements_share_are_left_out_of_the_fit() -> None:
    chain = Displacements(
        first_mm=GRID[:8], second_mm=GRID[1:9], first_px=seen_at(GRID[:8]), second_px=seen_at(GRID[1:9])
    )
    # Nine points on a line: no plane, however many rows are stated.
    with pytest.raises(CalibrationError, match="one line"):
        accuracy_left_out(CAMERA, chain)
    ring = np.array([0, 8, 62, 54, 31])
    first, second = GRID[ring], GRID[np.roll(ring, 1)]
    around = Displacements(
        first_mm=first, second_mm=second, first_px=seen_at(first), second_px=seen_at(second)
    )
    # Of five corners, two are measured, and three are no plane.
    with pytest.raises(CalibrationError, match="it has 3 points"):
        accuracy_left_out(CAMERA, around)


def test_a_fit_to_the_measured_points_is_rejected() -> None:
    measured = rows(4)
    fit = np.concatenate([GRID + 3.5, measured.first_mm[:2]])
    with pytest.raises(InvalidInput, match="2 of the 65") as reported:
        accuracy_on_plane(CAMERA, measured, fit_mm=fit, fit_px=seen_at(fit))
    assert reported.value.code == "ACCURACY_NOT_INDEPENDENT"


def test_a_grid_is_split_into_what_fits_and_what_is_measured() -> None:
    report = accuracy_of_grid(CAMERA, GRID, seen_at(GRID))
    assert report.fit_points == 32
    assert report.known_mm.size == 15
    assert report.known_mm.min() > 30.0


def test_the_ruler_in_the_form_of_table_2() -> None:
    ruler = Ruler(vertical_mm=560.0, horizontal_mm=770.0, focal_length_px=1028.2)
    report = accuracy_of_ruler(
        ruler,
        Displacements(
            first_mm=[[164.0, 106.0], [150.0, 119.0]],  # pyrefly: ignore[bad-argument-type]  # lists will do
            second_mm=[[150.0, 94.0], [140.0, 102.0]],  # pyrefly: ignore[bad-argument-type]
            first_px=[[422.0, 429.0], [405.0, 416.0]],  # pyrefly: ignore[bad-argument-type]
            second_px=[[406.0, 441.0], [393.0, 433.0]],  # pyrefly: ignore[bad-argument-type]
        ),
    )
    assert report.errors_mm == pytest.approx([0.08, -0.45], abs=0.005)
    assert report.pixels_per_mm == pytest.approx([1.085, 1.055], abs=0.001)
    assert report.plane_distance_mm == pytest.approx(952.1, abs=0.1)
    assert (report.fit_points, report.fit_rms_px) == (0, 0.0)


@pytest.mark.parametrize(
    ("fit", "said"),
    [
        pytest.param(GRID[:3] + 1.0, "3 points", id="three-points"),
        pytest.param(GRID[:9] + 1.0, "one line", id="on-a-line"),
        pytest.param(np.zeros((6, 2)) + 1.0, "1 points", id="all-in-one-point"),
        pytest.param(GRID[:, :1], "needed", id="one-coordinate"),
        pytest.param(GRID * np.nan, "finite", id="no-numbers"),
    ],
)
def test_points_that_give_no_plane_are_rejected(fit: Array, said: str) -> None:
    px = seen_at(fit) if fit.shape[1] == 2 and np.isfinite(fit).all() else np.zeros(fit.shape)
    with pytest.raises(NavigationError, match=said):
        accuracy_on_plane(CAMERA, rows(4), fit_mm=fit, fit_px=px)


def test_points_of_another_image_size_are_rejected() -> None:
    matrix = np.array(MATRIX)
    matrix[:2, 2] = 319.5, 239.5
    small = CameraModel(matrix=matrix, distortion=np.zeros(5), size_wh_px=(640, 480))
    with pytest.raises(InvalidInput, match="640x480"):
        accuracy_left_out(small, rows())


@pytest.mark.parametrize(
    ("first", "second", "said"),
    [
        pytest.param(np.zeros((0, 2)), np.zeros((0, 2)), "none", id="none"),
        pytest.param(np.zeros((2, 2)), np.ones((3, 2)), "alike", id="not-as-many"),
        pytest.param(
            np.zeros((2, 2)), np.array([[1.0, 1.0], [0.0, 0.0]]), "number 2 is 0 mm", id="no-motion"
        ),
        pytest.param(np.zeros((1, 2)), np.full((1, 2), np.inf), "finite", id="beyond"),
    ],
)
def test_displacements_that_cannot_be_are_rejected(first: Array, second: Array, said: str) -> None:
    with pytest.raises(InvalidInput, match=said):
        Displacements(first_mm=first, second_mm=second, first_px=first, second_px=first)
