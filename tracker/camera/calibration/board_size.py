"""Detect a wrong number of columns and rows from the extent of the detected grids."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from tracker.camera.boards import Board, CheckerBoard, DotBoard
from tracker.camera.calibration.report import CalibrationReport
from tracker.camera.detection.view import BoardView
from tracker.errors import Remark

MIN_EQUAL_VIEWS, MIN_EQUAL_VIEWS_RATIO = 3, 0.5


def with_board_size_warning(
    report: CalibrationReport, views: Sequence[BoardView], board: Board
) -> CalibrationReport:
    """Return the report, with a warning where all views of a board end at the same smaller size.

    A user who counts squares instead of inner corners enters one column and one row too many; the detected
    grid is then accepted as a part of the board at an arbitrary position.
    """
    likely = likely_size(views, board)
    if likely is None:
        return report
    what = "inner corners" if isinstance(board, CheckerBoard) else "dots"
    hint = ", one fewer each way than squares" if isinstance(board, CheckerBoard) else ""
    warning = Remark(
        code="BOARD_SIZE_UNLIKELY",
        message=f"no view shows more than {likely[0]} x {likely[1]} of the {board.columns} x {board.rows} "
        f"{what}, and most show just these",
        remedy=f"Count {what} again{hint}: the board seems to have {likely[0]} x {likely[1]}.",
        context={
            "columns": likely[0],
            "rows": likely[1],
            "board_columns": board.columns,
            "board_rows": board.rows,
            "board_points": what,
            "count_hint": hint,
        },
    )
    return replace(report, warnings=(warning, *report.warnings))


def likely_size(views: Sequence[BoardView], board: Board) -> tuple[int, int] | None:
    """Return the probable columns and rows of the board; None where the views agree with the given size.

    A size is returned if half of the views or more, and at least three, contain the same complete rectangle,
    and none contains more of the board. None for a ChArUco board, whose corners are identified by their
    markers.
    """
    if not isinstance(board, DotBoard | CheckerBoard) or not views:
        return None
    spans = []
    for view in views:
        row, column = np.divmod(view.ids, board.columns)
        spans.append((int(np.ptp(column)) + 1, int(np.ptp(row)) + 1))
    maximum = max(wide for wide, _ in spans), max(high for _, high in spans)
    equal_views = sum(
        span == maximum and view.ids.size == maximum[0] * maximum[1]
        for span, view in zip(spans, views, strict=True)
    )
    if maximum == (board.columns, board.rows) or equal_views < max(
        MIN_EQUAL_VIEWS, MIN_EQUAL_VIEWS_RATIO * len(views)
    ):
        return None
    return maximum
