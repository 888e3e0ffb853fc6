"""Calibration boards: positions of their points, and invalid boards."""

import numpy as np
import pytest

from tracker.camera import CharucoBoard, CheckerBoard, DotBoard, DotLayout
from tracker.errors import InvalidInput


def test_points_count_row_by_row_from_the_top_left() -> None:
    board = DotBoard(columns=3, rows=2, pitch_mm=4.0)
    assert board.object_points_mm.tolist() == [
        [0, 0, 0], [4, 0, 0], [8, 0, 0],
        [0, 4, 0], [4, 4, 0], [8, 4, 0],
    ]  # fmt: skip


def test_each_second_row_of_an_asymmetric_board_is_shifted_by_the_pitch() -> None:
    board = DotBoard(columns=2, rows=3, pitch_mm=5.0, layout=DotLayout.ASYMMETRIC)
    assert board.object_points_mm[:, :2].tolist() == [[0, 0], [10, 0], [5, 5], [15, 5], [0, 10], [10, 10]]


@pytest.mark.parametrize(("columns", "rows"), [(5, 7), (6, 4), (3, 4)])
def test_charuco_corners_are_those_of_opencv(columns: int, rows: int) -> None:
    board = CharucoBoard(columns=columns, rows=rows, square_mm=10, marker_mm=7, dictionary="DICT_6X6_250")
    np.testing.assert_allclose(board.object_points_mm, board.opencv_board().getChessboardCorners())


def test_odd_by_even_corners_tell_which_way_up() -> None:
    assert CheckerBoard(columns=9, rows=6, square_mm=1).has_unique_orientation
    assert not CheckerBoard(columns=8, rows=6, square_mm=1).has_unique_orientation


@pytest.mark.parametrize(
    "make",
    [
        pytest.param(lambda: DotBoard(columns=1, rows=9, pitch_mm=1), id="one-column"),
        pytest.param(lambda: DotBoard(columns=4, rows=4, pitch_mm=0), id="no-pitch"),
        pytest.param(lambda: DotBoard(columns=4, rows=4, pitch_mm=1, fiducials=(16,)), id="dot-beyond"),
        pytest.param(lambda: CheckerBoard(columns=9, rows=6, square_mm=float("nan")), id="nan"),
        pytest.param(lambda: CheckerBoard(columns=900, rows=600, square_mm=1), id="huge"),
        pytest.param(
            lambda: CharucoBoard(columns=5, rows=7, square_mm=5, marker_mm=5, dictionary="DICT_4X4_50"),
            id="marker-as-large-as-its-square",
        ),
        pytest.param(
            lambda: CharucoBoard(columns=5, rows=7, square_mm=5, marker_mm=4, dictionary="DICT_9X9"),
            id="no-such-dictionary",
        ),
        pytest.param(
            lambda: CharucoBoard(columns=15, rows=17, square_mm=5, marker_mm=4, dictionary="DICT_4X4_50"),
            id="more-markers-than-the-dictionary-holds",
        ),
    ],
)
def test_what_cannot_be_a_board_is_rejected(make: object) -> None:
    with pytest.raises(InvalidInput) as reported:
        make()  # type: ignore[operator]  # a table of makers
    assert reported.value.code == "BOARD_INVALID"
