"""A browser renders the printed page with text and rulers, and OpenCV finds the board in it at true size."""

import cv2
import numpy as np
import numpy.typing as npt
import pytest
from cv2.typing import MatLike
from playwright.sync_api import Browser

from server.printing import board_sheet, svg_from_sheet
from tracker.camera.boards import AprilGridBoard, Board, CharucoBoard, CheckerBoard, DotBoard
from tracker.camera.detection import BoardView, find_board

pytestmark = pytest.mark.browser

CSS_PX_PER_MM = 96.0 / 25.4
ENLARGED = 2


def found_in(picture: MatLike, board: Board) -> npt.NDArray[np.float64]:
    if isinstance(board, CharucoBoard):
        corners, *_ = cv2.aruco.CharucoDetector(board.opencv_board()).detectBoard(picture)
        return np.asarray(corners, np.float64)
    if isinstance(board, AprilGridBoard):
        view = find_board(np.asarray(picture, dtype=np.uint8), board)
        assert isinstance(view, BoardView), view
        return view.image_points_px
    size = (board.columns, board.rows)
    if isinstance(board, CheckerBoard):
        _, corners = cv2.findChessboardCornersSB(picture, size)
        return np.asarray(corners, np.float64)
    _, centres = cv2.findCirclesGrid(picture, size, flags=cv2.CALIB_CB_SYMMETRIC_GRID)
    return np.asarray(centres, np.float64)


@pytest.mark.parametrize(
    "board",
    [
        pytest.param(DotBoard(columns=9, rows=11, pitch_mm=15.0), id="dots"),
        pytest.param(CheckerBoard(columns=9, rows=6, square_mm=25.0), id="checkerboard"),
        pytest.param(
            CharucoBoard(columns=8, rows=5, square_mm=30.0, marker_mm=22.0, dictionary="DICT_6X6_250"),
            id="charuco",
        ),
        pytest.param(AprilGridBoard(columns=6, rows=6, tag_mm=20.0, gap_mm=6.0), id="april-grid"),
    ],
)
def test_a_board_is_found_on_the_page_that_a_browser_draws(browser: Browser, board: Board) -> None:
    sheet = board_sheet(board)
    width, height = (int(np.ceil(size * CSS_PX_PER_MM)) for size in sheet.size_mm)
    context = browser.new_context(viewport={"width": width, "height": height}, device_scale_factor=ENLARGED)
    page = context.new_page()
    page.set_content(f"<style>body{{margin:0}}</style>{svg_from_sheet(sheet).split('?>')[1]}")
    picture = cv2.imdecode(np.frombuffer(page.screenshot(), np.uint8), cv2.IMREAD_GRAYSCALE)
    context.close()
    assert picture is not None
    found_mm = found_in(np.asarray(picture), board).reshape(-1, 2) / (CSS_PX_PER_MM * ENLARGED)
    wanted_mm = board.object_points_mm[:, :2]
    assert found_mm.shape == wanted_mm.shape
    # A grid with half-turn symmetry may be counted from its other end.
    found_mm = min(
        (found_mm, found_mm[::-1]), key=lambda points: float(np.ptp(points - wanted_mm, axis=0).max())
    )
    assert np.ptp(found_mm - wanted_mm, axis=0).max() < 0.15
