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
    width, height = CAMERA.size_wh_px
    step = (np.arange(SAMPLES) + 0.5) / SAMPLES - 0.5
    u = (np.arange(width)[:, None] + step).ravel()
    v = (np.arange(height)[:, None] + step).ravel()
    grid = np.stack(np.meshgrid(u, v), axis=-1).reshape(-1, 2)
    return CAMERA.normalised_from_px(grid)


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
    rays = _rays()
    normal = rotation[:, 2]
    depth = (normal @ translation) / (rays @ normal[:2] + normal[2])
    in_board = (np.column_stack([rays * depth[:, None], depth]) - translation) @ rotation[:, :2]
    light = _light(board, in_board, radius_mm, large_mm)
    width, height = CAMERA.size_wh_px
    image = light.reshape(height, SAMPLES, width, SAMPLES).mean(axis=(1, 3))
    image = cv2.GaussianBlur(40.0 + 180.0 * image, (0, 0), BLUR_PX)
    noise = np.random.default_rng(seed).normal(0.0, 2.0, image.shape)
    return np.asarray(np.clip(image + noise, 0, 255), dtype=np.uint8)


def _light(board: Board, at_mm: Array, radius_mm: float, large_mm: float) -> Array:
    """1 for white and 0 for black at points (n, 2) of the board's plane."""
    if isinstance(board, DotBoard):
        return _dots_light(board, at_mm, radius_mm, large_mm)
    if isinstance(board, CheckerBoard):
        square = np.floor(at_mm / board.square_mm).astype(int)
        inside = ((square >= -1) & (square < [board.columns, board.rows])).all(axis=1)
        return np.where(inside & (square.sum(axis=1) % 2 == 0), 0.0, 1.0)
    if isinstance(board, AprilGridBoard):
        return _april_grid_light(board, at_mm)
    return _charuco_light(board, at_mm)


def _dots_light(board: DotBoard, at_mm: Array, radius_mm: float, large_mm: float) -> Array:
    steps = np.rint(board.object_points_mm[:, :2] / board.pitch_mm).astype(int)
    radii = np.zeros(steps.max(axis=0) + 3)
    radii[steps[:, 0] + 1, steps[:, 1] + 1] = radius_mm
    large = steps[list(board.fiducials)]
    radii[large[:, 0] + 1, large[:, 1] + 1] = large_mm
    nearest = np.rint(at_mm / board.pitch_mm)
    x, y = np.clip(nearest.astype(int) + 1, 0, np.array(radii.shape) - 1).T
    off = np.linalg.norm(at_mm - nearest * board.pitch_mm, axis=1)
    return np.where(off < radii[x, y], 0.0, 1.0)


def _charuco_light(board: CharucoBoard, at_mm: Array) -> Array:
    size = np.array([board.columns, board.rows]) * board.square_mm
    wide, high = np.rint(size * CHARUCO_PX_PER_MM).astype(int)
    drawn = board.opencv_board().generateImage((int(wide), int(high)), marginSize=0)
    px = np.floor(at_mm * CHARUCO_PX_PER_MM).astype(int)
    inside = ((px >= 0) & (px < [wide, high])).all(axis=1)
    x, y = np.clip(px, 0, [wide - 1, high - 1]).T
    return np.where(inside, drawn[y, x] / 255.0, 1.0)


def _april_grid_light(board: AprilGridBoard, at_mm: Array) -> Array:
    pitch_mm, module_mm = board.tag_mm + board.gap_mm, board.tag_mm / 10.0
    # From the top left corner of the first gap.
    cell, within_mm = np.divmod(at_mm + board.gap_mm, pitch_mm)
    within_mm = within_mm - board.gap_mm
    size = np.array([board.columns, board.rows])
    in_gap = within_mm < 0.0
    ink = np.asarray(in_gap.all(axis=1) & ((cell >= 0) & (cell <= size)).all(axis=1))
    in_tag = (~in_gap).all(axis=1) & ((cell >= 0) & (cell < size)).all(axis=1)
    for column in range(board.columns):
        for row in range(board.rows):
            here = in_tag & (cell == [column, row]).all(axis=1)
            x, y = np.clip((within_mm[here] / module_mm).astype(int), 0, 9).T
            ink[here] = ~board.white_modules(board.tag_at(column, row))[y, x]
    return np.where(ink, 0.0, 1.0)
