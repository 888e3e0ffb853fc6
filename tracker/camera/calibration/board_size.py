"""Detect a wrong number of columns and rows from what no view shows."""

from collections.abc import Sequence
from dataclasses import replace

import numpy as np

from tracker.camera.boards import Board, CheckerBoard, DotBoard
from tracker.camera.calibration.report import CalibrationReport, CalibrationWarning
from tracker.camera.detection.view import BoardView

MIN_EQUAL_VIEWS, MIN_EQUAL_VIEWS_RATIO = 3, 0.5


def with_board_size_warning(
    report: CalibrationReport, views: Sequence[BoardView], board: Board
) -> CalibrationReport:
    """The report, with a warning where the views of a board all end at the same smaller size.

    Someone who counts squares in place of inner corners says one column and one row too many; what is seen
    then passes as a part of the board, wherever it is put.
    """
    likely = likely_size(views, board)
    if likely is None:
        return report
    what = "inner corners" if isinstance(board, CheckerBoard) else "dots"
    hint = ", one fewer each way than squares" if isinstance(board, CheckerBoard) else ""
    warning = CalibrationWarning(
        code="BOARD_SIZE_UNLIKELY",
        message=f"no view shows more than {likely[0]} x {likely[1]} of the {board.columns} x {board.rows} "
        f"{what}, and most show just these",
        remedy=f"Count {what} again{hint}: the board seems to have {likely[0]} x {likely[1]}.",
    )
    return replace(report, warnings=(warning, *report.warnings))


def likely_size(views: Sequence[BoardView], board: Board) -> tuple[int, int] | None:
    """Columns and rows that the board seems to have, None where the views fit to what was said of it.

    Given where half of the views or more, and at least three, show one and the same whole rectangle, and none
    shows more of the board. A ChArUco board's corners are named by their markers, so its size is not given.
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
