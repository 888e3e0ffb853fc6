"""Banded normal equations are solved like dense ones."""

import numpy as np
import pytest

from tracker.geometry.geometry_kernels import pose_rows, solve_banded, solve_positive

# 20 unknowns coupled to those less than 4 away, and 5 coupled to all.
BANDED, WIDE, REST = 20, 4, 5


def bordered_matrix() -> np.ndarray:
    random = np.random.default_rng(3)
    count = BANDED + REST
    slopes = np.zeros((6 * count, count))
    for row in slopes:
        first = random.integers(BANDED - WIDE + 1)
        row[first : first + WIDE] = random.standard_normal(WIDE)
        row[BANDED:] = random.standard_normal(REST)
    # Millimetres and radians together.
    units = 10.0 ** random.uniform(-2.0, 2.0, count)
    return np.asarray(slopes.T @ slopes * np.outer(units, units))


def test_what_is_banded_is_solved_by_its_band_alone() -> None:
    matrix = bordered_matrix()
    sides, out = np.arange(1.0, len(matrix) + 1.0), np.empty(len(matrix))
    upper = np.where(np.tri(len(matrix), k=-1), np.nan, matrix)
    upper[:BANDED, :BANDED][np.triu_indices(BANDED, WIDE)] = np.nan

    assert solve_banded(upper, (BANDED, WIDE), sides, out)

    units = np.sqrt(np.diag(matrix))
    assert out * units == pytest.approx(np.linalg.solve(matrix, sides) * units, rel=1e-5)


def test_a_matrix_that_is_not_positive_has_no_answer() -> None:
    assert not solve_positive(np.diag([1.0, -1.0]), np.ones(2), np.empty(2))
    assert not solve_positive(np.ones((2, 2)) - np.eye(2), np.ones(2), np.empty(2))


def test_the_rows_of_a_pose_do_not_depend_on_the_order_in_which_they_are_solved() -> None:
    matrix = np.roll(bordered_matrix(), (REST, REST), axis=(0, 1))
    count = len(matrix)
    illumination_first = np.roll(np.arange(count), -REST)

    rows, is_solved = pose_rows(matrix, illumination_first, (BANDED, WIDE), 0.0)

    assert is_solved
    assert rows == pytest.approx(pose_rows(matrix, np.arange(count), (0, 0), 0.0)[0], rel=1e-6)
    assert rows == pytest.approx(np.linalg.inv(matrix)[:6], rel=1e-6)
