"""A grid on a tilted plane, and its image positions in a known camera."""

import numpy as np

from tracker.camera import CameraModel
from tracker.camera.displacements import Displacements
from tracker.geometry import Array, rotation_from_vector

MATRIX = np.array([[1000.0, 0.0, 640.0], [0.0, 1000.0, 360.0], [0.0, 0.0, 1.0]])
CAMERA = CameraModel(
    matrix=MATRIX, distortion=np.array([-0.25, 0.1, 0.001, -0.001, 0.0]), size_wh_px=(1280, 720)
)
TURN, MOVE = rotation_from_vector(np.array([0.45, -0.25, 0.1])), np.array([-60.0, -40.0, 320.0])
GRID = np.stack(np.meshgrid(np.arange(9) * 15.0, np.arange(7) * 15.0), axis=-1).reshape(-1, 2).astype(float)


def seen_at(points_mm: Array, camera: CameraModel = CAMERA) -> Array:
    points = np.concatenate([points_mm, np.zeros((points_mm.shape[0], 1))], axis=1)
    return camera.px_from_camera(points @ TURN.T + MOVE)


def rows(count: int = 12, *, noise_px: float = 0.0) -> Displacements:
    rng = np.random.default_rng(4)
    picked = rng.permutation(GRID.shape[0])[: 2 * count]
    px = seen_at(GRID) + rng.normal(0.0, noise_px, GRID.shape) if noise_px else seen_at(GRID)
    first, second = picked[:count], picked[count:]
    return Displacements(
        first_mm=GRID[first], second_mm=GRID[second], first_px=px[first], second_px=px[second]
    )
