"""AprilGrids: some tags are decoded, and the others are found beside them by saddle points at their corners.

OpenCV decodes only a part of the tags, because the black squares join the contours of adjacent tags.
"""

import cv2
import numpy as np

from tracker.camera.boards import APRIL_GRID_BORDER, APRIL_GRID_DICTIONARY, AprilGridBoard
from tracker.camera.detection.blobs import GreyImage
from tracker.camera.detection.corners import SADDLE_SMOOTHING_PX, refined, saddles
from tracker.camera.detection.plane import off_plane_px, plane_map
from tracker.camera.detection.view import BoardNotFound, BoardView, NotFoundReason
from tracker.geometry import Array

MIN_DECODED, MIN_TAGS = 2, 3
# Enlarged, tags of few pixels are decoded; reduced, large ones whose corners are blurred.
SCALES = (1.0, 2.0, 0.5)
# Maximum distance of a saddle from a predicted corner, in gaps; the next corner is a whole gap away. OpenCV's
# corners lie 2 to 3 px inside of a decoded tag: 0.3 rejects all tags of a view with gaps of 9 px.
MAX_OFF_GAP_RATIO = 0.45
# Half size of the refinement window: as a ratio of a tag's side, below its border of a fifth, and of the gap.
WINDOW_SIDE_RATIO, WINDOW_GAP_RATIO = 0.15, 0.6
# A tag whose corners lie farther than this, in sides of a tag, from the plane of the others is misread.
OFF_PLANE_RATIO = 0.15

Tags = dict[int, Array]
"""Corners (4, 2) in pixels by the number of the tag, in the order of `AprilGridBoard.corner_ids`."""


def find_april_grid(grey: GreyImage, board: AprilGridBoard) -> BoardView | BoardNotFound:
    """Return the corners of the tags, or why they are not found."""
    decoded = _on_plane(_decoded(grey, board), board)
    tags: Tags = {}
    if len(decoded) >= MIN_DECODED:
        for smoothing_px in SADDLE_SMOOTHING_PX:
            grown = _consistent(_grown(decoded, saddles(grey, smoothing_px=smoothing_px), board), board)
            tags = max(tags, grown, key=len)
    if len(tags) < MIN_TAGS:
        return BoardNotFound(
            reason=NotFoundReason.TOO_FEW_POINTS if decoded else NotFoundReason.NO_POINTS,
            sentence=f"{len(decoded)} tags of {APRIL_GRID_DICTIONARY} are read, and {len(tags)} have all of "
            f"their corners between squares, at least {MIN_TAGS} are needed",
            seen_points=4 * len(tags),
        )
    ids = np.array([board.corner_ids(tag) for tag in tags], dtype=np.int64).ravel()
    sides_px = np.repeat([_shortest_side_px(corners) for corners in tags.values()], 4)
    ratio = min(WINDOW_SIDE_RATIO, WINDOW_GAP_RATIO * board.gap_mm / board.tag_mm)
    return BoardView(
        ids=ids,
        object_points_mm=board.object_points_mm[ids],
        image_points_px=refined(grey, np.concatenate(list(tags.values())), sides_px, window_ratio=ratio),
    )


def _decoded(grey: GreyImage, board: AprilGridBoard) -> Tags:
    parameters = cv2.aruco.DetectorParameters()
    parameters.markerBorderBits = APRIL_GRID_BORDER
    detector = cv2.aruco.ArucoDetector(board.opencv_dictionary, parameters)
    tags: Tags = {}
    for scale in SCALES:
        scaled = grey if scale == 1.0 else cv2.resize(grey, None, fx=scale, fy=scale)
        corners, ids, _ = detector.detectMarkers(scaled)
        # OpenCV returns None for no result, contrary to its type annotations.
        for tag, seen in zip(np.ravel([] if ids is None else ids).tolist(), corners, strict=True):
            if tag < board.columns * board.rows:
                px = (np.asarray(seen, dtype=np.float64).reshape(4, 2) + 0.5) / scale - 0.5
                tags.setdefault(int(tag), px)
        if len(tags) >= max(MIN_DECODED, board.columns * board.rows // 3):
            break
    return tags


def _grown(decoded: Tags, saddles_px: Array, board: AprilGridBoard) -> Tags:
    """Return the tags with a saddle at each corner: decoded ones, and those beside tags already returned."""
    tags: Tags = {}
    predicted = decoded
    while True:
        found = {tag: _at_saddles(corners_px, saddles_px, board) for tag, corners_px in predicted.items()}
        added = {tag: corners_px for tag, corners_px in found.items() if corners_px is not None}
        if not added:
            return tags
        tags |= added
        predicted = {}
        for tag in set(range(board.columns * board.rows)) - set(tags):
            near = {other: px for other, px in tags.items() if _are_neighbours(tag, other, board)}
            corners_px = _predicted(tag, near, board) if near else None
            if corners_px is not None:
                predicted[tag] = corners_px


def _consistent(tags: Tags, board: AprilGridBoard) -> Tags:
    """Return the tags that lie where their neighbours predict them.

    A tag found early was predicted from few, distant ones, and may have taken a wrong saddle.
    """
    out: Tags = {}
    for tag, corners_px in tags.items():
        near = {other: px for other, px in tags.items() if _are_neighbours(tag, other, board)}
        predicted_px = _predicted(tag, near, board) if near else None
        if predicted_px is not None:
            off_px = float(np.linalg.norm(corners_px - predicted_px, axis=1).max())
            if off_px <= _max_off_px(predicted_px, board):
                out[tag] = corners_px
    return out


def _are_neighbours(tag: int, other: int, board: AprilGridBoard) -> bool:
    (row, column), (other_row, other_column) = divmod(tag, board.columns), divmod(other, board.columns)
    return max(abs(row - other_row), abs(column - other_column)) == 1


def _predicted(tag: int, near: Tags, board: AprilGridBoard) -> Array | None:
    """Return the corners of a tag by the homography of its neighbours, or None where there is none.

    A homography of the whole board would miss by the lens distortion.
    """
    found = plane_map(_corners_mm(list(near), board), np.concatenate(list(near.values())), is_robust=False)
    if found is None:
        return None
    corners_mm = _corners_mm([tag], board).reshape(-1, 1, 2)
    corners_px: Array = np.asarray(cv2.perspectiveTransform(corners_mm, found), dtype=np.float64)
    return corners_px.reshape(4, 2)


def _at_saddles(corners_px: Array, saddles_px: Array, board: AprilGridBoard) -> Array | None:
    """Return the saddle nearest to each corner, or None if one is too far."""
    if not len(saddles_px):
        return None
    distances_px = np.linalg.norm(corners_px[:, None] - saddles_px[None], axis=2)
    if (distances_px.min(axis=1) > _max_off_px(corners_px, board)).any():
        return None
    return np.asarray(saddles_px[distances_px.argmin(axis=1)])


def _max_off_px(corners_px: Array, board: AprilGridBoard) -> float:
    return MAX_OFF_GAP_RATIO * board.gap_mm / board.tag_mm * _shortest_side_px(corners_px)


def _corners_mm(tags: list[int], board: AprilGridBoard) -> Array:
    """Return the corners of tags on the board (4 n, 2)."""
    ids = np.ravel([board.corner_ids(tag) for tag in tags])
    return np.asarray(board.object_points_mm[ids, :2])


def _shortest_side_px(corners_px: Array) -> float:
    return float(np.linalg.norm(np.roll(corners_px, -1, axis=0) - corners_px, axis=1).min())


def _on_plane(tags: Tags, board: AprilGridBoard) -> Tags:
    """Return the tags that fit the homography of the others; of two that contradict each other, none."""
    if len(tags) < MIN_DECODED:
        return tags
    # Of two tags, either may be misread: a robust fit would follow one of them.
    is_robust = len(tags) > MIN_DECODED
    off = off_plane_px(
        _corners_mm(list(tags), board), np.concatenate(list(tags.values())), is_robust=is_robust
    )
    if off is None:
        return {}
    deviations_px = np.linalg.norm(off, axis=1).reshape(-1, 4).max(axis=1)
    side_px = float(np.median([_shortest_side_px(corners) for corners in tags.values()]))
    max_off_px = OFF_PLANE_RATIO * side_px
    if is_robust:
        max_off_px += 3.0 * float(np.median(deviations_px))
    return {one: tags[one] for one, off_px in zip(tags, deviations_px, strict=True) if off_px <= max_off_px}
