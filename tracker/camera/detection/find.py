"""Common entry point of all board detectors."""

from collections import Counter
from collections.abc import Sequence
from dataclasses import replace

import cv2
import numpy as np
import numpy.typing as npt

from tracker.camera.boards import AprilGridBoard, Board, CharucoBoard, CheckerBoard, DotBoard
from tracker.camera.detection.april_grid import find_april_grid
from tracker.camera.detection.blobs import GreyImage
from tracker.camera.detection.charuco import charuco_layout, find_charuco, layout_misfits
from tracker.camera.detection.checker import find_checker
from tracker.camera.detection.dots import find_dots, larger_dots
from tracker.camera.detection.view import BoardNotFound, BoardView, NotFoundReason
from tracker.errors import InvalidInput


def find_board(image: npt.NDArray[np.uint8], board: Board) -> BoardView | BoardNotFound:
    """Return the points of a board in an image (h, w) or (h, w, 3), or why they are not found.

    Raises:
        InvalidInput: IMAGE_INVALID, the array is no image of 8 bits.
    """
    grey = _grey(image)
    if isinstance(board, DotBoard):
        return find_dots(grey, board)
    if isinstance(board, CheckerBoard):
        return find_checker(grey, board)
    if isinstance(board, AprilGridBoard):
        return find_april_grid(grey, board)
    return find_charuco(grey, board)


def board_as_seen(images: Sequence[npt.NDArray[np.uint8]], board: Board) -> Board:
    """Return the board with parameters that its description leaves open, estimated from images.

    For a ChArUco board the layout; for a dot board the larger dots if none are given, and exchanged columns
    and rows if the given ones are detected only so. A few images suffice.
    """
    if isinstance(board, CharucoBoard) and board.layout is None:
        return replace(
            board, layout=charuco_layout([layout_misfits(_grey(image), board) for image in images])
        )
    if isinstance(board, DotBoard):
        return _dots_as_seen([_grey(image) for image in images], board)
    return board


def _dots_as_seen(greys: list[GreyImage], board: DotBoard) -> DotBoard:
    if not board.fiducials:
        views = [find_dots(grey, board) for grey in greys]
        whole = [
            v for v in views if isinstance(v, BoardView) and v.ids.size > 0.9 * board.columns * board.rows
        ]
        last = board.columns * board.rows - 1
        # A board rotated by 180 degrees has other indexes; the smaller of both is used.
        seen = [tuple(int(i) for i in larger_dots(view)) for view in whole]
        named = Counter(min(ids, tuple(sorted(last - i for i in ids))) for ids in seen if ids)
        if named and named.most_common(1)[0][1] * 2 > len(whole):
            return replace(board, fiducials=named.most_common(1)[0][0])
        return board
    if board.columns == board.rows:
        return board
    swapped = board.transposed
    fits = [sum(_fits(grey, one) for grey in greys) for one in (board, swapped)]
    return swapped if fits[1] > fits[0] else board


def _fits(grey: GreyImage, board: DotBoard) -> bool:
    found = find_dots(grey, board)
    return not (isinstance(found, BoardNotFound) and found.reason is NotFoundReason.OTHER_FIDUCIALS)


def _grey(image: npt.NDArray[np.uint8]) -> GreyImage:
    array = np.asarray(image)
    fits = array.ndim == 2 or (array.ndim == 3 and array.shape[2] == 3)
    if not fits or array.dtype != np.uint8 or min(array.shape[:2]) < 16:
        raise InvalidInput(
            "IMAGE_INVALID",
            f"an image has shape {array.shape} and type {array.dtype}, needed (h, w) or (h, w, 3) of 8 bits, "
            "at least 16 x 16",
            "Give the image as the camera made it.",
            {"shape": str(array.shape), "dtype": str(array.dtype)},
        )
    return array if array.ndim == 2 else np.asarray(cv2.cvtColor(array, cv2.COLOR_BGR2GRAY), dtype=np.uint8)
