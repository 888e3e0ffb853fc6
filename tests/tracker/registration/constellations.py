"""Random landmarks with a known truth, for tests of registration."""

from dataclasses import dataclass

import numpy as np

from tracker.geometry import Anchor, Array, Rigid, Vertebra

# Left and right facet, left and right transverse process, spinous process, lamina: as on a lumbar vertebra.
VERTEBRA = np.array(
    [
        [18.0, -2.0, 12.0],
        [-17.0, -1.0, 11.0],
        [38.0, -8.0, 1.0],
        [-36.0, -6.0, 2.0],
        [1.0, 28.0, -9.0],
        [9.0, 8.0, -3.0],
    ]
)


@dataclass(frozen=True, slots=True, kw_only=True)
class Truth:
    """Landmarks on the CT (n, 3), the captured tips, and the true pose of the CT."""

    fixed_mm: Array
    moving_mm: Array
    fixed_from_moving: Rigid[Vertebra, Anchor]


def any_pose(rng: np.random.Generator) -> Rigid[Vertebra, Anchor]:
    return Rigid.from_vector(rng.normal(size=3), rng.uniform(-200.0, 200.0, 3))


def touched(fixed_mm: Array, rng: np.random.Generator, noise: Array | float = 0.0) -> Truth:
    """Tips on these landmarks, with noise of this sd in mm or of this covariance (3, 3)."""
    pose = any_pose(rng)
    root = np.linalg.cholesky(noise) if isinstance(noise, np.ndarray) else noise * np.eye(3)
    moving = pose.inverse.move_points(fixed_mm) + rng.normal(size=fixed_mm.shape) @ root.T
    return Truth(fixed_mm=fixed_mm, moving_mm=moving, fixed_from_moving=pose)


def random_landmarks(rng: np.random.Generator, count: int) -> Array:
    """Landmarks not in a line (second extent at least a quarter of the first) and 5 mm apart."""
    while True:
        points = rng.uniform(-30.0, 30.0, (count, 3))
        sizes = np.linalg.svd(points - points.mean(axis=0), compute_uv=False)
        apart = np.linalg.norm(points[:, None] - points[None], axis=2) + 99.0 * np.eye(count)
        if sizes[1] > 0.25 * sizes[0] and apart.min() > 5.0:
            return np.asarray(points + np.array([12.0, -40.0, 60.0]))
