"""A board with a wrongly counted size, which looks like a partly visible one, is detected."""

import numpy as np
import pytest

from tests.tracker.camera.rendered import POSES, picture
from tracker.camera import Board, CheckerBoard, DotBoard
from tracker.camera.calibration import calibrate, with_board_size_warning
from tracker.camera.calibration.board_size import likely_size
from tracker.camera.detection import BoardView, find_board

SHOWN = CheckerBoard(columns=9, rows=6, square_mm=12.0)
SQUARES = CheckerBoard(columns=10, rows=7, square_mm=12.0)
DOTS = DotBoard(columns=13, rows=9, pitch_mm=9.0)


def part(board: Board, columns: int, rows: int) -> BoardView:
    """A view in which this part of the board is found."""
    ids = np.arange(board.columns * board.rows)
    ids = ids[(ids % board.columns < columns) & (ids // board.columns < rows)]
    points = np.asarray(board.object_points_mm)[ids]
    return BoardView(ids=ids, object_points_mm=points, image_points_px=points[:, :2].copy())


def test_squares_counted_in_place_of_inner_corners_are_reported_with_the_likely_size() -> None:
    found = [find_board(picture(SHOWN, pose), SQUARES) for pose in POSES[:3]]
    views = [one for one in found if isinstance(one, BoardView)]
    report = with_board_size_warning(calibrate(views, size_wh_px=(640, 480)), views, SQUARES)
    reported = report.warnings[0]
    assert reported.code == "BOARD_SIZE_UNLIKELY"
    assert "no view shows more than 9 x 6 of the 10 x 7 inner corners" in reported.message
    assert reported.remedy == (
        "Count inner corners again, one fewer each way than squares: the board seems to have 9 x 6."
    )


@pytest.mark.parametrize(
    ("board", "sizes", "likely"),
    [
        pytest.param(SHOWN, [(9, 6)] * 5, None, id="counted-well"),
        pytest.param(SHOWN, [(9, 6), *[(8, 5)] * 9], None, id="seen-whole-once"),
        pytest.param(SQUARES, [(9, 6)] * 5, (9, 6), id="squares-counted"),
        pytest.param(SQUARES, [(9, 6), (9, 6), (9, 6), (9, 4), (7, 6)], (9, 6), id="now-and-then-cut-off"),
        pytest.param(DOTS, [(12, 9)] * 4, (12, 9), id="a-column-of-dots-too-many"),
        pytest.param(SHOWN, [(9, 5), (8, 6), (8, 6), (8, 6)], None, id="cut-off-here-and-there"),
        pytest.param(SHOWN, [(8, 6), (8, 6), (7, 5), (6, 4)], None, id="two-views-are-too-few-to-say"),
        pytest.param(SHOWN, [(8, 6)] * 3 + [(7, 6)] * 4, None, id="most-are-cut-off-otherwise"),
        pytest.param(SHOWN, [], None, id="not-seen-at-all"),
    ],
)
def test_the_likely_size_is_where_all_views_end(
    board: Board, sizes: list[tuple[int, int]], likely: tuple[int, int] | None
) -> None:
    assert likely_size([part(board, *size) for size in sizes], board) == likely
