"""A board moving in front of a rolling-shutter camera: points and rendered images."""

from collections.abc import Callable
from functools import cache

import numpy as np

from tracker.camera import CameraModel, DotBoard
from tracker.camera.detection import BoardView
from tracker.camera.readout_time import TimedView
from tracker.geometry import Array

CAMERA = CameraModel(
    matrix=np.array([[620.0, 0, 319.5], [0, 620.0, 239.5], [0, 0, 1]]),
    distortion=np.array([-0.12, 0.05, 0.0005, -0.0004, 0.0]),
    size_wh_px=(640, 480),
)
PITCH_MM = 15.0
BOARD = DotBoard(columns=9, rows=7, pitch_mm=PITCH_MM, fiducials=(21, 24, 38))
RATE_HZ = 30.0
# Rotations (n, 3, 3) and translations (n, 3) in mm at times (n,).
Motion = Callable[[Array], tuple[Array, Array]]


def shaken(
    *,
    sideways_mm: float = 0.0,
    upwards_mm: float = 0.0,
    tilt_deg: float = 8.0,
    hz: float = 1.8,
    rotation_deg: float = 0.0,
) -> Motion:
    """A hand that shakes the board to and fro, with small motion along the other axes."""

    middle_mm = np.asarray(BOARD.object_points_mm).mean(axis=0)

    def at(at_s: Array) -> tuple[Array, Array]:
        phase = 2.0 * np.pi * hz * at_s
        turns = [
            tilt_deg + 3.0 * np.sin(0.7 * phase),
            4.0 * np.sin(0.9 * phase + 1.0),
            rotation_deg * np.sin(phase),
        ]
        rotations = _rotations(np.radians(np.stack(turns, axis=1)))
        shift = [
            sideways_mm * np.sin(phase),
            upwards_mm * np.sin(0.83 * phase + 0.6),
            230.0 + 5.0 * np.sin(0.5 * phase),
        ]
        return rotations, np.stack(shift, axis=1) - rotations @ middle_mm

    return at


def _rotations(vectors_rad: Array) -> Array:
    """Rotation matrices (n, 3, 3) of rotation vectors (n, 3) that are not zero, by Rodrigues' formula."""
    angle = np.linalg.norm(vectors_rad, axis=1)[:, None, None]
    x, y, z = (vectors_rad / angle[:, :, 0]).T
    zero = np.zeros_like(x)
    axis = np.stack([zero, -z, y, z, zero, -x, -y, x, zero], axis=1).reshape(-1, 3, 3)
    return np.asarray(np.eye(3) + np.sin(angle) * axis + (1.0 - np.cos(angle)) * (axis @ axis))


def drifting(speed_mm_s: float) -> Motion:
    """A board that moves in one direction only."""
    still = shaken()

    def at(at_s: Array) -> tuple[Array, Array]:
        rotations, translations = still(np.zeros_like(at_s))
        return rotations, translations + np.outer(speed_mm_s * (at_s - 0.4), [1.0, 0.0, 0.0])

    return at


def seen_views(
    motion: Motion,
    *,
    readout_s: float,
    images: int = 45,
    noise_px: float = 0.1,
    seed: int = 1,
    rate_hz: float = RATE_HZ,
    bow_mm: float = 0.0,
) -> list[TimedView]:
    """Detected points of the board in each image, each at the time when its row is read."""
    random, views = np.random.default_rng(seed), []
    points = np.asarray(BOARD.object_points_mm, dtype=np.float64)
    across = points[:, 0] / points[:, 0].max()
    bent = points + np.outer(bow_mm * 4.0 * across * (1.0 - across), [0.0, 0.0, 1.0])
    for number in range(images):
        at_s = number / rate_hz
        px = _px(motion, bent, np.full(len(points), at_s))
        for _ in range(2):
            px = _px(motion, bent, at_s + readout_s * px[:, 1] / CAMERA.size_wh_px[1])
        noisy = px + noise_px * random.standard_normal(px.shape)
        view = BoardView(ids=np.arange(len(points)), object_points_mm=points, image_points_px=noisy)
        views.append(TimedView(at_s=at_s, view=view))
    return views


def _px(motion: Motion, points: Array, at_s: Array) -> Array:
    rotations, shifts = motion(at_s)
    return CAMERA.px_from_camera(np.einsum("nij,nj->ni", rotations, points) + shifts)


@cache
def _rays() -> Array:
    width, height = CAMERA.size_wh_px
    u, v = np.meshgrid(np.arange(width), np.arange(height))
    flat = CAMERA.normalised_from_px(np.stack([u, v], axis=-1).reshape(-1, 2).astype(float))
    return np.column_stack([flat, np.ones(len(flat))]).reshape(height, width, 3)


def image_at(motion: Motion, at_s: float, *, readout_s: float) -> np.ndarray:
    """The board in grey, each row at the time when it is read."""
    height = CAMERA.size_wh_px[1]
    rotations, shifts = motion(at_s + readout_s * np.arange(height) / height)
    normals = rotations[:, :, 2]
    depth = (normals * shifts).sum(axis=1)[:, None] / np.einsum("rci,ri->rc", _rays(), normals)
    on_board = np.einsum("rci,rij->rcj", _rays() * depth[..., None] - shifts[:, None], rotations)[..., :2]
    points = np.asarray(BOARD.object_points_mm)[:, :2]
    cell = np.clip(np.rint(on_board / PITCH_MM), 0, [BOARD.columns - 1, BOARD.rows - 1]).astype(int)
    is_large = np.isin(cell[..., 1] * BOARD.columns + cell[..., 0], BOARD.fiducials)
    off_mm = np.hypot(*np.moveaxis(on_board - PITCH_MM * cell, -1, 0)) - np.where(is_large, 5.0, 3.2)
    ink = np.clip(0.5 - off_mm * CAMERA.matrix[0, 0] / (1.6 * shifts[0, 2]), 0.0, 1.0)
    edges = points.min(axis=0) - PITCH_MM, points.max(axis=0) + PITCH_MM
    is_paper = ((on_board > edges[0]) & (on_board < edges[1])).all(axis=-1)
    return np.asarray(np.rint(np.where(is_paper, 210.0 - 170.0 * ink, 90.0)), dtype=np.uint8)
