"""ChArUco boards: markers identify every corner, so a part of the board suffices."""

from collections.abc import Sequence

import cv2
import numpy as np

from tracker.camera.boards import CharucoBoard, CharucoLayout
from tracker.camera.detection.blobs import GreyImage
from tracker.camera.detection.corners import refined
from tracker.camera.detection.lattice import Cells, step_lengths_px
from tracker.camera.detection.plane import off_plane_px
from tracker.camera.detection.view import BoardNotFound, BoardView, NotFoundReason, PlacementAmbiguity
from tracker.geometry import Array

MIN_CORNERS, MIN_MARKERS = 6, 4
# A corner farther than this, in sides of a square, from its position by its neighbours is an outlier.
OFF_NEIGHBOURS_RATIO = 0.15
# Part of the margin between a square and its marker that is free of the blur of the marker's edge.
MARGIN_PART = 0.8
MIN_WINDOW_PX = 3.0


def find_charuco(grey: GreyImage, board: CharucoBoard) -> BoardView | BoardNotFound:
    """Return the corners of the board, or why they are not found; a missing layout is estimated."""
    layout = board.layout
    ambiguity = PlacementAmbiguity.NONE
    if layout is None:
        misfits = layout_misfits(grey, board)
        layout = charuco_layout([misfits])
        # A part in the middle of the board is equal in both layouts up to a shift by one square.
        if board.rows % 2 == 0 and min(misfits) > 0.5 * max(misfits):
            ambiguity = PlacementAmbiguity.PLACE
    ids, corners, max_markers = _detected(grey, board, layout)
    if len(ids) < MIN_CORNERS:
        return BoardNotFound(
            reason=NotFoundReason.TOO_FEW_POINTS if max_markers else NotFoundReason.NO_POINTS,
            sentence=f"{max_markers} markers of {board.dictionary} and {len(ids)} corners between them "
            f"are seen, at least {MIN_CORNERS} corners are needed",
            seen_points=len(ids),
        )
    return BoardView(
        ids=ids, object_points_mm=board.object_points_mm[ids], image_points_px=corners, ambiguity=ambiguity
    )


def charuco_layout(misfits: list[tuple[float, float]]) -> CharucoLayout:
    """Return the layout with the smaller total misfit; `misfits`: results of `layout_misfits`."""
    as_newer, as_older = (sum(one[axis] for one in misfits) for axis in (0, 1))
    return CharucoLayout.OLDER if as_older < as_newer else CharucoLayout.NEWER


def layout_misfits(grey: GreyImage, board: CharucoBoard) -> tuple[float, float]:
    """Return the median deviation of markers from a flat board [px] for the newer and the older layout."""
    corners, ids, _ = cv2.aruco.ArucoDetector(board.opencv_dictionary).detectMarkers(grey)
    if _count(ids) < MIN_MARKERS:
        return 0.0, 0.0
    named = [int(one) for one in np.asarray(ids).ravel()]
    as_newer, as_older = (
        _misfit(corners, named, board.opencv_board(layout))
        for layout in (CharucoLayout.NEWER, CharucoLayout.OLDER)
    )
    return as_newer, as_older


def _misfit(corners: Sequence[object], ids: list[int], board: cv2.aruco.CharucoBoard) -> float:
    place_of = {
        int(one): np.asarray(at)
        for one, at in zip(np.ravel(board.getIds()), board.getObjPoints(), strict=True)
    }
    both = [(place_of[one], np.asarray(px)) for one, px in zip(ids, corners, strict=True) if one in place_of]
    if len(both) < MIN_MARKERS:
        return 0.0
    points = np.concatenate([at.reshape(-1, 3)[:, :2] for at, _ in both]).astype(np.float64)
    seen = np.concatenate([px.reshape(-1, 2) for _, px in both]).astype(np.float64)
    off = off_plane_px(points, seen, is_robust=True)
    return 0.0 if off is None else float(np.median(np.linalg.norm(off, axis=1)))


def _detected(
    grey: GreyImage, board: CharucoBoard, layout: CharucoLayout | None
) -> tuple[np.ndarray[tuple[int], np.dtype[np.int64]], Array, int]:
    """Return ids, corners (n, 2) and the number of markers for one layout."""
    detector = cv2.aruco.CharucoDetector(board.opencv_board(layout))
    found, ids, _, marker_ids = detector.detectBoard(grey)
    markers = _count(marker_ids)
    if not _count(ids) and markers >= MIN_CORNERS:
        # A single misread marker makes OpenCV reject all; wrong corners are removed below.
        unchecked = cv2.aruco.CharucoParameters()
        unchecked.checkMarkers = False
        detector.setCharucoParameters(unchecked)
        found, ids, _, marker_ids = detector.detectBoard(grey)
    if _count(ids) < MIN_CORNERS:
        return np.zeros(0, dtype=np.int64), np.zeros((0, 2)), markers
    named = np.asarray(ids, dtype=np.int64).ravel()
    px = np.asarray(found, dtype=np.float64).reshape(-1, 2)
    row, column = np.divmod(named, board.columns - 1)
    cells = np.column_stack([column, row])
    retained = _with_neighbours(px, cells)
    named, px, cells = named[retained], px[retained], cells[retained]
    if len(named) < MIN_CORNERS:
        return np.zeros(0, dtype=np.int64), np.zeros((0, 2)), markers
    return named, _placed_finely(grey, px, cells, board), markers


def _placed_finely(grey: GreyImage, px: Array, cells: Cells, board: CharucoBoard) -> Array:
    """Return refined corners (n, 2), because OpenCV stops at a tenth of a pixel; unchanged for small squares.

    The window excludes the edges of the markers.
    """
    window_ratio = MARGIN_PART * 0.5 * (1.0 - board.marker_mm / board.square_mm)
    sides_px, _ = step_lengths_px(px, cells)
    large = window_ratio * sides_px >= MIN_WINDOW_PX
    return np.where(large[:, None], refined(grey, px, sides_px, window_ratio=window_ratio), px)


def _count(found: object) -> int:
    """Return the length; OpenCV returns None for no result, contrary to its type annotations."""
    return 0 if found is None else len(np.asarray(found))


def _with_neighbours(px: Array, cells: Cells) -> np.ndarray[tuple[int], np.dtype[np.bool_]]:
    """Return the mask of corners that fit the homography of the others."""
    retained = np.ones(len(px), dtype=bool)
    for _ in range(4):
        off = _off_map(px[retained], cells[retained])
        side, _ = step_lengths_px(px[retained], cells[retained])
        bad = off > OFF_NEIGHBOURS_RATIO * np.median(side) + 3.0 * np.median(off)
        if not bad.any() or retained.sum() - bad.sum() < MIN_CORNERS:
            return retained
        retained[np.flatnonzero(retained)[bad]] = False
    return retained


def _off_map(px: Array, cells: Cells) -> Array:
    off = off_plane_px(cells.astype(np.float64), px, is_robust=True)
    return np.zeros(len(px)) if off is None else np.asarray(np.linalg.norm(off, axis=1))
