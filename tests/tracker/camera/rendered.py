"""Renders boards through a lens with distortion, with known truth."""

import functools

import cv2
import numpy as np
import numpy.typing as npt

from tracker.camera import AprilGridBoard, Board, CameraModel, CharucoBoard, CheckerBoard, DotBoard
from tracker.geometry import Array, rotation_from_vector

SAMPLES = 2
BLUR_PX = 0.7
CHARUCO_PX_PER_MM = 12.0
CAMERA = CameraModel(
    matrix=np.array([[620.0, 0, 325.0], [0, 660.0, 236.0], [0, 0, 1]]),
    distortion=np.array([-0.22, 0.08, 0.001, -0.0008, 0.0]),
    size_wh_px=(640, 480),
)
Pose = tuple[tuple[float, float, float], tuple[float, float, float]]
# Rotation in degrees (about x, y, z), and position of the board's centre in mm.
POSES: tuple[Pose, ...] = (
    ((0, 0, 0), (0, 0, 260)),
    ((25, 0, 5), (-30, -20, 250)),
    ((-28, 8, -8), (35, 15, 270)),
    ((5, 30, 0), (-25, 25, 240)),
    ((0, -32, 12), (30, -22, 280)),
    ((20, 22, -20), (0, 10, 230)),
    ((-22, -20, 30), (10, 0, 300)),
)


@functools.cache
def _rays() -> Array:
    """Normalised directions (2, n) of all samples; arrays of this shape take half the time of (n, 2)."""
    width, height = CAMERA.size_wh_px
    step = (np.arange(SAMPLES) + 0.5) / SAMPLES - 0.5
    u = (np.arange(width)[:, None] + step).ravel()
    v = (np.arange(height)[:, None] + step).ravel()
    grid = np.stack(np.meshgrid(u, v), axis=-1).reshape(-1, 2)
    return np.ascontiguousarray(CAMERA.normalised_from_px(grid).T)


def placed_board(board: Board, pose: Pose) -> tuple[Array, Array]:
    """Rotation and translation, camera from board, with the board's centre at the pose's position."""
    (x, y, z), middle_mm = pose
    rotation = rotation_from_vector(np.radians([x, y, 0.0])) @ rotation_from_vector(np.radians([0.0, 0.0, z]))
    points = np.asarray(board.object_points_mm)
    return rotation, np.array(middle_mm) - rotation @ ((points.min(axis=0) + points.max(axis=0)) / 2.0)


def true_px(board: Board, pose: Pose) -> Array:
    """Image positions of the board's points."""
    rotation, translation = placed_board(board, pose)
    return CAMERA.px_from_camera(np.asarray(board.object_points_mm) @ rotation.T + translation)


@functools.cache
def picture(
    board: Board, pose: Pose, *, radius_mm: float = 2.0, large_mm: float = 3.2, seed: int = 1
) -> npt.NDArray[np.uint8]:
    """The board as the camera sees it, with slight blur and noise."""
    rotation, translation = placed_board(board, pose)
    along_x, along_y, along_normal = (
        column[0] * _rays()[0] + column[1] * _rays()[1] + column[2] for column in rotation.T
    )
    depth = (rotation[:, 2] @ translation) / along_normal
    x_mm = along_x * depth - rotation[:, 0] @ translation
    y_mm = along_y * depth - rotation[:, 1] @ translation
    light = _light(board, x_mm, y_mm, radius_mm, large_mm)
    width, height = CAMERA.size_wh_px
    image = light.reshape(height, SAMPLES, width, SAMPLES).mean(axis=(1, 3))
    image = cv2.GaussianBlur(40.0 + 180.0 * image, (0, 0), BLUR_PX)
    noise = np.random.default_rng(seed).normal(0.0, 2.0, image.shape)
    return np.asarray(np.clip(image + noise, 0, 255), dtype=np.uint8)


def _light(board: Board, x_mm: Array, y_mm: Array, radius_mm: float, large_mm: float) -> Array:
    """1 for white and 0 for black at points of the board's plane."""
    if isinstance(board, DotBoard):
        return _dots_light(board, x_mm, y_mm, radius_mm, large_mm)
    if isinstance(board, CheckerBoard):
        column, row = (np.floor(at_mm / board.square_mm).astype(int) for at_mm in (x_mm, y_mm))
        inside = _is_within(column + 1, board.columns + 1) & _is_within(row + 1, board.rows + 1)
        return np.where(inside & ((column + row) % 2 == 0), 0.0, 1.0)
    if isinstance(board, AprilGridBoard):
        return _april_grid_light(board, x_mm, y_mm)
    return _charuco_light(board, x_mm, y_mm)


def _is_within(index: npt.NDArray[np.int_], count: int) -> npt.NDArray[np.bool_]:
    return np.asarray((index >= 0) & (index < count))


def _dots_light(board: DotBoard, x_mm: Array, y_mm: Array, radius_mm: float, large_mm: float) -> Array:
    steps = np.rint(board.object_points_mm[:, :2] / board.pitch_mm).astype(int)
    radii = np.zeros(steps.max(axis=0) + 3)
    radii[steps[:, 0] + 1, steps[:, 1] + 1] = radius_mm
    large = steps[list(board.fiducials)]
    radii[large[:, 0] + 1, large[:, 1] + 1] = large_mm
    column, row = (np.rint(at_mm / board.pitch_mm) for at_mm in (x_mm, y_mm))
    off_mm = np.hypot(x_mm - column * board.pitch_mm, y_mm - row * board.pitch_mm)
    x, y = (
        np.clip(index.astype(int) + 1, 0, count - 1)
        for index, count in zip((column, row), radii.shape, strict=True)
    )
    return np.where(off_mm < radii[x, y], 0.0, 1.0)


def _charuco_light(board: CharucoBoard, x_mm: Array, y_mm: Array) -> Array:
    size = np.array([board.columns, board.rows]) * board.square_mm
    wide, high = (int(count) for count in np.rint(size * CHARUCO_PX_PER_MM))
    drawn = board.opencv_board().generateImage((wide, high), marginSize=0)
    x, y = (np.floor(at_mm * CHARUCO_PX_PER_MM).astype(int) for at_mm in (x_mm, y_mm))
    inside = _is_within(x, wide) & _is_within(y, high)
    return np.where(inside, drawn[np.clip(y, 0, high - 1), np.clip(x, 0, wide - 1)] / 255.0, 1.0)


def _april_grid_light(board: AprilGridBoard, x_mm: Array, y_mm: Array) -> Array:
    pitch_mm, module_mm = board.tag_mm + board.gap_mm, board.tag_mm / 10.0
    # From the top left corner of the first gap.
    (column, x_in_cell), (row, y_in_cell) = (
        np.divmod(at_mm + board.gap_mm, pitch_mm) for at_mm in (x_mm, y_mm)
    )
    column, row = column.astype(int), row.astype(int)
    x_gap, y_gap = x_in_cell < board.gap_mm, y_in_cell < board.gap_mm
    ink = x_gap & y_gap & _is_within(column, board.columns + 1) & _is_within(row, board.rows + 1)
    is_tag = ~x_gap & ~y_gap & _is_within(column, board.columns) & _is_within(row, board.rows)
    modules = np.array(
        [[board.white_modules(board.tag_at(c, r)) for r in range(board.rows)] for c in range(board.columns)]
    )
    x, y = (
        np.clip(((at_mm[is_tag] - board.gap_mm) / module_mm).astype(int), 0, 9)
        for at_mm in (x_in_cell, y_in_cell)
    )
    ink[is_tag] = ~modules[column[is_tag], row[is_tag], y, x]
    return np.where(ink, 0.0, 1.0)
