"""Boards detected in pictures with known truth."""

import cv2
import numpy as np
import pytest

from tests.tracker.camera.rendered import POSES, Pose, picture, true_px
from tracker.camera import (
    AprilGridBoard,
    Board,
    CharucoBoard,
    CharucoLayout,
    CheckerBoard,
    DotBoard,
    DotLayout,
)
from tracker.camera.detection import (
    BoardNotFound,
    BoardView,
    NotFoundReason,
    PlacementAmbiguity,
    april_grid,
    board_as_seen,
    find_board,
)
from tracker.camera.detection.corners import saddles
from tracker.errors import InvalidInput

DOTS = DotBoard(columns=12, rows=9, pitch_mm=9.0, fiducials=(26, 33, 62))
PLAIN_DOTS = DotBoard(columns=12, rows=9, pitch_mm=9.0)
ASYMMETRIC = DotBoard(columns=5, rows=11, pitch_mm=8.0, layout=DotLayout.ASYMMETRIC)
NARROW_ASYMMETRIC = DotBoard(columns=4, rows=11, pitch_mm=8.0, layout=DotLayout.ASYMMETRIC)
CHECKER = CheckerBoard(columns=9, rows=6, square_mm=12.0)
CHARUCO = CharucoBoard(columns=8, rows=6, square_mm=14.0, marker_mm=10.0, dictionary="DICT_4X4_50")
APRIL_GRID = AprilGridBoard(columns=6, rows=5, tag_mm=14.0, gap_mm=4.2)
OLDER = CharucoBoard(
    columns=8, rows=6, square_mm=14.0, marker_mm=10.0, dictionary="DICT_4X4_50", layout=CharucoLayout.OLDER
)


def found(board: Board, pose: int) -> BoardView:
    view = find_board(picture(board, POSES[pose]), board)
    assert isinstance(view, BoardView), view
    return view


@pytest.mark.parametrize(
    ("board", "within_px"),
    [
        pytest.param(DOTS, 0.25, id="dots-with-larger-ones"),
        pytest.param(CHECKER, 0.2, id="checkerboard"),
        pytest.param(CHARUCO, 0.35, id="charuco"),
        pytest.param(APRIL_GRID, 0.25, id="april-grid"),
        pytest.param(ASYMMETRIC, 0.25, id="asymmetric-dots"),
        pytest.param(NARROW_ASYMMETRIC, 0.25, id="asymmetric-dots-higher-than-wide"),
    ],
)
@pytest.mark.parametrize("pose", [0, 6], ids=["from-the-front", "tilted-and-turned"])
def test_every_point_is_where_and_which_it_is(board: Board, pose: int, within_px: float) -> None:
    view = found(board, pose)
    assert view.ambiguity is PlacementAmbiguity.NONE
    assert view.ids.size > 0.9 * len(board.object_points_mm)
    off = np.linalg.norm(view.image_points_px - true_px(board, POSES[pose])[view.ids], axis=1)
    # Larger than the noise of a corner, far smaller than a step: no point is mislabelled.
    assert off.max() < 6 * within_px
    assert np.median(off) < within_px


def test_corners_of_large_charuco_squares_are_placed_to_a_few_hundredths_of_a_pixel() -> None:
    wide, high = 8 * 61, 6 * 61
    drawn = CHARUCO.opencv_board().generateImage((wide, high), marginSize=0)
    around = cv2.copyMakeBorder(drawn, 20, 20, 20, 20, cv2.BORDER_CONSTANT, value=255)
    view = find_board(np.asarray(cv2.GaussianBlur(around, (0, 0), 1.0), dtype=np.uint8), CHARUCO)
    assert isinstance(view, BoardView), view
    truth_px = view.object_points_mm[:, :2] / CHARUCO.square_mm * 61 + 20 - 0.5
    assert np.linalg.norm(view.image_points_px - truth_px, axis=1).max() < 0.1


@pytest.mark.parametrize(
    "pose",
    [
        pytest.param(((15.0, -10.0, 8.0), (95.0, -40.0, 250.0)), id="partly-out-of-view"),
        pytest.param(((10.0, 5.0, 180.0), (0.0, 0.0, 260.0)), id="upside-down"),
    ],
)
def test_tags_name_the_corners_of_a_part_and_of_a_board_upside_down(pose: Pose) -> None:
    view = find_board(picture(APRIL_GRID, pose), APRIL_GRID)
    assert isinstance(view, BoardView), view
    assert view.ids.size > 0.6 * len(APRIL_GRID.object_points_mm)
    off = np.linalg.norm(view.image_points_px - true_px(APRIL_GRID, pose)[view.ids], axis=1)
    assert off.max() < 1.0


@pytest.mark.parametrize("read", [(3,), (3, 18)])
def test_a_misread_tag_never_mislabels_corners(
    monkeypatch: pytest.MonkeyPatch, read: tuple[int, ...]
) -> None:
    truth_px = true_px(APRIL_GRID, POSES[0])
    image = picture(APRIL_GRID, POSES[0])
    right = {tag: truth_px[list(APRIL_GRID.corner_ids(tag))] for tag in read}
    seen_px = truth_px[list(APRIL_GRID.corner_ids(22))]
    # Its neighbours, and others all over the board.
    for number in {16, 21, 23, 28, *range(0, 30, 4)} - {*read, 22}:
        monkeypatch.setattr(april_grid, "_decoded", lambda *_, wrong=number: {**right, wrong: seen_px})
        view = find_board(image, APRIL_GRID)
        if isinstance(view, BoardView):
            assert np.linalg.norm(view.image_points_px - truth_px[view.ids], axis=1).max() < 1.5
        else:
            assert len(read) == 1


def test_a_hand_on_an_april_grid_costs_only_the_tags_that_it_touches() -> None:
    seed = 1
    image = picture(APRIL_GRID, POSES[seed]).astype(np.float64)
    hand = cv2.ellipse(np.zeros(image.shape), (250, 430), (40, 170), 20, 0, 360, 1.0, -1)
    grain = cv2.GaussianBlur(np.random.default_rng(seed).normal(0.0, 9.0, image.shape), (0, 0), 1.5)
    spoilt = np.asarray(np.clip(np.where(hand > 0, 130.0, image) + grain, 0, 255), dtype=np.uint8)
    view = find_board(spoilt, APRIL_GRID)
    assert isinstance(view, BoardView), view
    truth_px = true_px(APRIL_GRID, POSES[seed])
    touched = cv2.dilate(hand, np.ones((9, 9))) > 0
    x, y = np.rint(truth_px).astype(int).T
    free = [tag for tag in range(30) if not touched[y, x][list(APRIL_GRID.corner_ids(tag))].any()]
    seen = set(view.ids.tolist())
    whole = [tag for tag in free if set(APRIL_GRID.corner_ids(tag)) <= seen]
    assert len(whole) >= 0.85 * len(free)
    off = np.linalg.norm(view.image_points_px - truth_px[view.ids], axis=1)
    assert off.max() < 2.0


def test_a_symmetric_dot_grid_is_reported_as_ambiguous_by_half_a_turn() -> None:
    assert found(PLAIN_DOTS, 1).ambiguity is PlacementAmbiguity.HALF_TURN


def test_larger_dots_tell_a_board_that_is_upside_down() -> None:
    upside_down = ((10.0, 5.0, 180.0), (0.0, 0.0, 260.0))
    view = find_board(picture(DOTS, upside_down), DOTS)
    assert isinstance(view, BoardView)
    off = np.linalg.norm(view.image_points_px - true_px(DOTS, upside_down)[view.ids], axis=1)
    assert off.max() < 2.0


@pytest.mark.parametrize("board", [DOTS, CHECKER], ids=["dots", "checkerboard"])
def test_a_board_partly_out_of_view_gives_what_is_seen(board: Board) -> None:
    aside = ((15.0, -10.0, 8.0), (95.0, -40.0, 250.0))
    view = find_board(picture(board, aside), board)
    assert isinstance(view, BoardView), view
    assert 12 <= view.ids.size < len(board.object_points_mm)
    if view.ambiguity is PlacementAmbiguity.NONE:
        off = np.linalg.norm(view.image_points_px - true_px(board, aside)[view.ids], axis=1)
        assert off.max() < 2.0
    else:
        assert isinstance(board, CheckerBoard)


def test_a_finger_on_a_checkerboard_costs_only_the_corners_that_it_hides() -> None:
    seed = 1
    image = picture(CHECKER, POSES[seed]).astype(np.float64)
    finger = cv2.ellipse(np.zeros(image.shape), (250, 430), (40, 170), 20, 0, 360, 1.0, -1)
    grain = cv2.GaussianBlur(np.random.default_rng(seed).normal(0.0, 9.0, image.shape), (0, 0), 1.5)
    image = np.where(finger > 0, 130.0, image) + grain
    view = find_board(np.asarray(np.clip(image, 0, 255), dtype=np.uint8), CHECKER)
    assert isinstance(view, BoardView), view
    truth_px = true_px(CHECKER, POSES[seed])
    points = saddles(np.asarray(np.clip(image, 0, 255), dtype=np.uint8), smoothing_px=1.5)
    near = np.linalg.norm(points[:, None] - truth_px[None], axis=2).min(axis=1) < 3.0
    # The rest are where squares meet the paper, and not the grain.
    assert near.mean() > 0.5
    hidden = np.array([finger[round(y), round(x)] > 0 for x, y in truth_px])
    assert view.ids.size >= 0.85 * (~hidden).sum()
    off = np.linalg.norm(view.image_points_px[:, None] - truth_px[None], axis=2).min(axis=1)
    assert np.median(off) < 0.2


def test_larger_dots_and_charuco_layout_are_found_by_themselves() -> None:
    pictures = [picture(DOTS, POSES[index]) for index in (0, 1)]
    assert board_as_seen(pictures, PLAIN_DOTS) == DOTS
    pictures = [picture(OLDER, POSES[index]) for index in (0, 1)]
    seen = board_as_seen(pictures, CHARUCO)
    assert isinstance(seen, CharucoBoard)
    assert seen.layout is CharucoLayout.OLDER


def test_columns_and_rows_the_other_way_round_are_seen_by_the_larger_dots() -> None:
    swapped = DOTS.transposed
    assert board_as_seen([picture(DOTS, POSES[0])], swapped) == DOTS


@pytest.mark.parametrize(
    ("shown", "board", "reason"),
    [
        pytest.param(None, DOTS, NotFoundReason.NO_POINTS, id="empty-image"),
        pytest.param(None, CHECKER, NotFoundReason.NO_POINTS, id="empty-image-checkerboard"),
        pytest.param(None, CHARUCO, NotFoundReason.NO_POINTS, id="empty-image-charuco"),
        pytest.param(None, APRIL_GRID, NotFoundReason.NO_POINTS, id="empty-image-april-grid"),
        pytest.param(CHECKER, APRIL_GRID, NotFoundReason.NO_POINTS, id="squares-are-no-tags"),
        pytest.param(CHECKER, PLAIN_DOTS, NotFoundReason.NO_POINTS, id="squares-are-no-dots"),
        pytest.param(
            PLAIN_DOTS,
            DotBoard(columns=8, rows=7, pitch_mm=9.0),
            NotFoundReason.OTHER_SIZE,
            id="more-dots-than-the-board-has",
        ),
        pytest.param(
            DOTS,
            DotBoard(columns=12, rows=9, pitch_mm=9.0, fiducials=(0, 1, 2, 3)),
            NotFoundReason.OTHER_FIDUCIALS,
            id="larger-dots-elsewhere",
        ),
    ],
)
def test_what_is_not_the_board_is_not_found(
    shown: Board | None, board: Board, reason: NotFoundReason
) -> None:
    image = np.full((480, 640), 128, np.uint8) if shown is None else picture(shown, POSES[1])
    seen = find_board(image, board)
    assert isinstance(seen, BoardNotFound), seen
    assert seen.reason is reason
    assert seen.sentence


def test_noise_alone_is_no_board() -> None:
    noise = np.random.default_rng(3).integers(0, 255, (120, 160)).astype(np.uint8)
    for board in (DOTS, CHECKER, CHARUCO, APRIL_GRID):
        assert isinstance(find_board(noise, board), BoardNotFound)


def test_what_is_no_image_is_rejected() -> None:
    with pytest.raises(InvalidInput) as reported:
        find_board(np.zeros((4, 4), np.uint8), DOTS)
    assert reported.value.code == "IMAGE_INVALID"
