"""Calibration boards: positions of their points, and invalid boards."""

import numpy as np
import pytest

from tracker.camera import AprilGridBoard, CharucoBoard, CheckerBoard, DotBoard, DotLayout
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


APRIL_GRID = AprilGridBoard(columns=3, rows=2, tag_mm=10.0, gap_mm=3.0)


def test_corners_of_tags_count_row_by_row_from_the_top_left() -> None:
    points = APRIL_GRID.object_points_mm[:, :2].tolist()
    assert points[:6] == [[0, 0], [10, 0], [13, 0], [23, 0], [26, 0], [36, 0]]
    assert points[6:8] == [[0, 10], [10, 10]]
    assert points[-1] == [36, 23]


def test_tags_count_from_the_bottom_left_upwards_as_kalibr_counts_them() -> None:
    assert [APRIL_GRID.tag_at(column, 1) for column in range(3)] == [0, 1, 2]
    assert [APRIL_GRID.tag_at(column, 0) for column in range(3)] == [3, 4, 5]


def test_a_tag_reads_upright_as_the_published_code_of_its_family() -> None:
    # tag36h11 in the AprilTag library: bits row by row from the top left, 1 for white.
    for tag, code in ((0, 0xD5D628584), (1, 0xD97F18B49), (2, 0xDD280910E)):
        white = APRIL_GRID.white_modules(tag)
        assert not white[:2].any()
        assert not white[:, -2:].any()
        bits = "".join("1" if one else "0" for one in white[2:8, 2:8].ravel())
        assert int(bits, 2) == code


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
        pytest.param(
            lambda: AprilGridBoard(columns=6, rows=6, tag_mm=10, gap_mm=11), id="gap-wider-than-a-tag"
        ),
        pytest.param(
            lambda: AprilGridBoard(columns=30, rows=20, tag_mm=10, gap_mm=3), id="more-tags-than-the-family"
        ),
    ],
)
def test_what_cannot_be_a_board_is_rejected(make: object) -> None:
    with pytest.raises(InvalidInput) as reported:
        make()  # pyrefly: ignore[not-callable]  # a table of makers
    assert reported.value.code == "BOARD_INVALID"
