"""The set-up scenes of the rehearsal agree with their ground truth."""

from collections.abc import Callable

import cv2
import numpy as np
import pytest

from tests.tracker.rehearsal.stills import STILLS
from tracker.camera import Board, CharucoBoard, CheckerBoard, DotBoard
from tracker.camera.board_collector import BoardCollector
from tracker.camera.detection import BoardView, find_board
from tracker.geometry import angle_between_deg
from tracker.rehearsal import BoardKind, Phase, Scene, Theatre, TheatreSettings
from tracker.rehearsal.board_renderer import BoardRenderer
from tracker.rehearsal.boards import BOARD_FROM_KIND, HOLD_S, MOVE_S, BoardHand, printed

TIMES_S = np.arange(0.0, 40.0, 0.25)
SIZE = (960, 540)


def board_theatre(kind: BoardKind) -> tuple[Theatre, BoardRenderer]:
    # In a smaller image OpenCV finds all ChArUco markers only by chance, however it is rendered.
    size = (1280, 720) if kind is BoardKind.CHARUCO else SIZE
    theatre = Theatre(TheatreSettings(seed=4, size_wh_px=size, scene=Scene.BOARD, board=kind))
    renderer = theatre.renderer(store=STILLS)
    assert isinstance(renderer, BoardRenderer)
    return theatre, renderer


def found_checkerboard(grey: np.ndarray, board: Board) -> np.ndarray:
    assert isinstance(board, CheckerBoard)
    found, corners = cv2.findChessboardCornersSB(grey, (board.columns, board.rows))
    assert found
    return np.asarray(corners, dtype=np.float64).reshape(-1, 2)


def found_dots(grey: np.ndarray, board: Board) -> np.ndarray:
    assert isinstance(board, DotBoard)
    found, centres = cv2.findCirclesGrid(grey, (board.columns, board.rows))
    assert found
    return np.asarray(centres, dtype=np.float64).reshape(-1, 2)


def found_charuco(grey: np.ndarray, board: Board) -> np.ndarray:
    assert isinstance(board, CharucoBoard)
    corners, ids, _, _ = cv2.aruco.CharucoDetector(board.opencv_board()).detectBoard(grey)
    assert len(ids) == (board.columns - 1) * (board.rows - 1)
    return np.asarray(corners, dtype=np.float64).reshape(-1, 2)[np.argsort(ids.ravel())]


def found_april_grid(grey: np.ndarray, board: Board) -> np.ndarray:
    view = find_board(grey, board)
    assert isinstance(view, BoardView), view
    assert view.ids.size == len(board.object_points_mm)
    return view.image_points_px


@pytest.mark.parametrize(
    ("kind", "found_in", "within_px"),
    [
        pytest.param(BoardKind.CHECKERBOARD, found_checkerboard, 0.06, id="checkerboard"),
        pytest.param(BoardKind.DOTS, found_dots, 0.02, id="dots"),
        pytest.param(BoardKind.CHARUCO, found_charuco, 0.06, id="charuco"),
        pytest.param(BoardKind.APRILGRID, found_april_grid, 0.06, id="april-grid"),
    ],
)
def test_a_board_is_seen_where_the_truth_has_it(
    kind: BoardKind, found_in: Callable[[np.ndarray, Board], np.ndarray], within_px: float
) -> None:
    theatre, renderer = board_theatre(kind)
    board = BOARD_FROM_KIND[kind]
    for place in (5,):
        at_s = place * (HOLD_S + MOVE_S) + HOLD_S / 2.0
        grey = cv2.cvtColor(renderer.image_at(at_s), cv2.COLOR_BGR2GRAY)
        truth = theatre.camera.px_from_camera(
            renderer.camera_from_board_at(at_s).move_points(board.object_points_mm)
        )
        seen = found_in(grey, board)
        off = np.abs(seen - truth)
        # A rotationally symmetric board may be read from its other end.
        turned = np.abs(seen[::-1] - truth)
        assert min(np.median(off), np.median(turned)) < within_px


def test_the_board_holds_still_then_moves_on_and_stays_in_the_image() -> None:
    theatre, renderer = board_theatre(BoardKind.DOTS)
    points = BOARD_FROM_KIND[BoardKind.DOTS].object_points_mm
    for place in range(16):
        times_s = [place * (HOLD_S + MOVE_S) + late_s for late_s in (0.1, 1.0)]
        px = [
            theatre.camera.px_from_camera(renderer.camera_from_board_at(at_s).move_points(points))
            for at_s in times_s
        ]
        assert np.abs(px[1] - px[0]).max() < 0.5
        assert (px[0] > 0).all()
        assert (px[0] < np.array(SIZE) - 1).all()


@pytest.mark.parametrize("seed", [1, 3])
def test_one_round_of_the_board_is_all_that_a_calibration_needs(seed: int) -> None:
    board = BOARD_FROM_KIND[BoardKind.CHECKERBOARD]
    theatre = Theatre(TheatreSettings(seed=seed, scene=Scene.BOARD, board=BoardKind.CHECKERBOARD))
    hand = BoardHand(printed(board), theatre.camera, seed)
    collector = BoardCollector(theatre.camera.size_wh_px)
    for at_s in np.arange(0.0, hand.cycle_s, 0.1):
        points = board.object_points_mm
        px = theatre.camera.px_from_camera(hand.camera_from_board_at(at_s).move_points(points))
        collector.offer(
            ids=np.arange(len(points)), object_points_mm=points, image_points_px=px, captured_at_s=at_s
        )
    assert collector.progress.missing == ()


def test_a_pivoting_tip_rests_while_the_tool_tilts_to_all_sides() -> None:
    theatre = Theatre(TheatreSettings(seed=2, scene=Scene.PIVOT))
    truths = [theatre.truth_at(at_s) for at_s in TIMES_S]
    tips = np.array([truth.camera_from_tool.translation_mm for truth in truths])
    assert np.linalg.norm(tips - tips.mean(axis=0), axis=1).max() < 0.05
    axes = np.array([truth.camera_from_tool.rotation[:, 2] for truth in truths])
    spread = np.linalg.svd(axes - axes.mean(axis=0), compute_uv=False)
    assert spread[1] > 0.5 * spread[0], "tilted in more than one plane"
    assert max(angle_between_deg(axes[0], axis) for axis in axes) > 20.0
    assert all(truth.marker_in_view for truth in truths)
    assert {truth.phase for truth in truths} == {Phase.CALIBRATE}


def test_a_spinning_tool_keeps_its_axis() -> None:
    theatre = Theatre(TheatreSettings(seed=2, scene=Scene.SPIN))
    truths = [theatre.truth_at(at_s) for at_s in TIMES_S]
    axes = np.array([truth.camera_from_tool.rotation[:, 2] for truth in truths])
    assert max(angle_between_deg(axes.mean(axis=0), axis) for axis in axes) < 0.5
    sides = np.array([truth.camera_from_tool.rotation[:, 0] for truth in truths])
    assert max(angle_between_deg(sides[0], side) for side in sides) > 40.0
    assert all(truth.marker_in_view for truth in truths)
