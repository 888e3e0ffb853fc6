"""Checkerboards: complete boards by OpenCV's detectors, parts by their corners."""

import cv2
import numpy as np
import numpy.typing as npt

from tracker.camera.boards import CheckerBoard
from tracker.camera.detection.blobs import GreyImage
from tracker.camera.detection.board_placement import place_on_board, trim_to_board
from tracker.camera.detection.corners import SADDLE_SMOOTHING_PX, quarter_signs, refined, saddles
from tracker.camera.detection.lattice import Cells, lattices, step_lengths_px
from tracker.camera.detection.view import BoardNotFound, BoardView, NotFoundReason, PlacementAmbiguity
from tracker.geometry import Array

# Without CALIB_CB_ACCURACY, which enlarges the image to place corners that `refined` places afterwards.
SECTOR_FLAGS = cv2.CALIB_CB_NORMALIZE_IMAGE | cv2.CALIB_CB_EXHAUSTIVE
QUAD_FLAGS = cv2.CALIB_CB_ADAPTIVE_THRESH | cv2.CALIB_CB_NORMALIZE_IMAGE | cv2.CALIB_CB_FAST_CHECK
MIN_CORNERS = 12
ENLARGEMENT, MAX_ENLARGED_PX = 1.5, 2_000_000
MIN_SIDE = 3
MAX_GRIDS = 4
MIN_REGULAR_RATIO, MIN_CONTRAST_RATIO = 0.75, 0.6
# Maximum ratio of corners of a partial board with wrong colours, as by glare.
MAX_ODD_RATIO = 0.05


def find_checker(grey: GreyImage, board: CheckerBoard) -> BoardView | BoardNotFound:
    """Return the inner corners of the board in an image, or why they are not found."""
    corners = _whole(grey, board)
    if corners is not None:
        return _whole_viewed(grey, board, corners)
    part = _in_part(grey, board)
    if isinstance(part, BoardView):
        return part
    enlarged = _whole_enlarged(grey, board)
    return part if enlarged is None else _whole_viewed(grey, board, enlarged)


def _whole_viewed(grey: GreyImage, board: CheckerBoard, corners: Array) -> BoardView | BoardNotFound:
    row, column = np.divmod(np.arange(len(corners)), board.columns)
    return _viewed(grey, board, corners, np.column_stack([column, row]), is_whole=True)


def _in_part(grey: GreyImage, board: CheckerBoard) -> BoardView | BoardNotFound:
    """Return the largest grid of corners that can be a part of the board."""
    best: BoardView | None = None
    other: BoardNotFound | None = None
    max_seen = 0
    for smoothing_px in SADDLE_SMOOTHING_PX:
        points = saddles(grey, smoothing_px=smoothing_px)
        for lattice in lattices(points, max_count=MAX_GRIDS):
            max_seen = max(max_seen, len(lattice.members))
            if len(lattice.members) < min(MIN_CORNERS, board.columns * board.rows):
                break
            seen = _part_viewed(grey, board, points[lattice.members], lattice.cells)
            if isinstance(seen, BoardNotFound):
                other = other or seen
            elif best is None or seen.ids.size > best.ids.size:
                best = seen
    if best is not None:
        return best
    return other or BoardNotFound(
        reason=NotFoundReason.TOO_FEW_POINTS if max_seen else NotFoundReason.NO_POINTS,
        sentence=f"{max_seen} corners of squares stand in a grid, at least {MIN_CORNERS} are needed",
        seen_points=max_seen,
    )


def _part_viewed(
    grey: GreyImage, board: CheckerBoard, points: Array, cells: Cells
) -> BoardView | BoardNotFound:
    """Return the view without corners whose squares do not alternate, and without stray border lines."""
    # Corners at the board's border have half the contrast, and those of noise hardly any.
    contrast = np.abs(_quarters(grey, points, cells))
    clear = contrast > MIN_CONTRAST_RATIO * np.percentile(contrast, 90)
    points, cells = points[clear], cells[clear]
    odd = (_corner_labels(grey, points, cells) + cells.sum(axis=1)) % 2
    usual = odd == round(float(odd.mean()))
    inside, retained = trim_to_board(cells[usual], board.columns, board.rows)
    seen = points[usual][retained]
    needed = min(MIN_CORNERS, board.columns * board.rows)
    if len(seen) < needed or usual.mean() < MIN_REGULAR_RATIO:
        few = f"{len(seen)} corners where dark and light take turns, at least {needed} are needed"
        mixed = (
            f"dark and light take turns at {100 * usual.mean():.0f} % of {len(points)} corners in a grid, "
            f"needed {100 * MIN_REGULAR_RATIO:.0f} %"
        )
        return BoardNotFound(
            reason=NotFoundReason.TOO_FEW_POINTS,
            sentence=few if len(seen) < needed else mixed,
            seen_points=len(seen),
        )
    return _viewed(grey, board, seen, inside)


def _whole(grey: GreyImage, board: CheckerBoard) -> Array | None:
    size = (board.columns, board.rows)
    if min(size) < MIN_SIDE:
        return None
    found, corners = cv2.findChessboardCornersSB(grey, size, flags=SECTOR_FLAGS)
    if not found:
        found, corners = cv2.findChessboardCorners(grey, size, flags=QUAD_FLAGS)
    return np.asarray(corners, dtype=np.float64).reshape(-1, 2) if found else None


def _whole_enlarged(grey: GreyImage, board: CheckerBoard) -> Array | None:
    """Return the corners of a small board beside other boards, from an enlarged image.

    `cv2.findChessboardCorners` separates squares by morphology, which requires squares of some pixels.
    """
    size = (board.columns, board.rows)
    if min(size) < MIN_SIDE or grey.size > MAX_ENLARGED_PX:
        return None
    larger = cv2.resize(grey, None, fx=ENLARGEMENT, fy=ENLARGEMENT, interpolation=cv2.INTER_CUBIC)
    found, corners = cv2.findChessboardCorners(larger, size, flags=QUAD_FLAGS & ~cv2.CALIB_CB_FAST_CHECK)
    if not found:
        return None
    # The centre of the first pixel is (0, 0) in both images.
    return (np.asarray(corners, dtype=np.float64).reshape(-1, 2) + 0.5) / ENLARGEMENT - 0.5


def _viewed(
    grey: GreyImage, board: CheckerBoard, corners_px: Array, cells: Cells, *, is_whole: bool = False
) -> BoardView | BoardNotFound:
    """Return the view with sub-pixel corners and the grid placed on the board by its colours."""
    sides_px, _ = step_lengths_px(corners_px, cells)
    corners = refined(grey, corners_px, sides_px)
    if _is_mirrored(cells, corners):
        cells = np.column_stack([cells[:, 0], cells[:, 1].max() - cells[:, 1]])
    wide, high = (int(v) + 1 for v in cells.max(axis=0))
    row, column = np.divmod(np.arange(board.columns * board.rows), board.columns)
    names = (column + row) % 2
    grid = np.arange(board.columns * board.rows).reshape(board.rows, board.columns)
    place = None
    if min(wide, high) >= min(MIN_SIDE, board.columns, board.rows):
        # If the placement is ambiguous, the outermost square at the first corner is assumed dark.
        labels = _corner_labels(grey, corners, cells)
        place = place_on_board(cells, corners, labels, grid, names, quarter_turn_swaps_labels=True)
    if place is None:
        return BoardNotFound(
            reason=NotFoundReason.OTHER_SIZE,
            sentence=f"a grid of {wide} x {high} corners, and the board has {board.columns} x {board.rows}",
            seen_points=len(cells),
        )
    if not is_whole and place.misfits > MAX_ODD_RATIO * len(cells):
        return BoardNotFound(
            reason=NotFoundReason.TOO_FEW_POINTS,
            sentence=f"{len(cells)} corners stand in a grid, and dark and light do not take turns at "
            f"{place.misfits} of them",
            seen_points=len(cells),
        )
    return BoardView(
        ids=place.ids,
        object_points_mm=board.object_points_mm[place.ids],
        image_points_px=corners,
        # A spurious or missing line at the border shifts all ids by one step.
        ambiguity=place.ambiguity if is_whole else PlacementAmbiguity.PLACE,
    )


def _corner_labels(grey: GreyImage, corners: Array, cells: Cells) -> npt.NDArray[np.int64]:
    """Return the label of each corner: 0 if the square towards the next column and row is dark, else 1."""
    return np.asarray(_quarters(grey, corners, cells) > 0, dtype=np.int64)


def _quarters(grey: GreyImage, corners: Array, cells: Cells) -> Array:
    design = np.column_stack([cells, np.ones(len(cells))])
    affine, *_ = np.linalg.lstsq(design, corners, rcond=None)
    a, b = (np.broadcast_to(affine[axis], corners.shape) for axis in (0, 1))
    return quarter_signs(grey, corners, a, b)


def _is_mirrored(cells: Cells, corners: Array) -> bool:
    design = np.column_stack([cells, np.ones(len(cells))])
    affine, *_ = np.linalg.lstsq(design, corners, rcond=None)
    return bool(affine[0, 0] * affine[1, 1] - affine[0, 1] * affine[1, 0] < 0)
