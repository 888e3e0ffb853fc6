"""The pedicle model: distances to its wall, its derivatives, and the mean of a voxel."""

import numpy as np
import scipy

from tracker.geometry import Array
from tracker.plan.pedicle import tube_model

HALF_WIDTH_MM, HALF_HEIGHT_MM, CORTEX_MM = 3.5, 6.0, 1.2
SIDES_MM = np.array([0.6, 0.6, 3.0])


def parameters(**changes: float) -> Array:
    out = np.zeros(tube_model.COUNT)
    out[tube_model.AXES] = [np.log(HALF_WIDTH_MM), np.log(HALF_HEIGHT_MM), 0.0]
    out[tube_model.CORTEX], out[tube_model.MARROW] = 900.0, 150.0
    out[tube_model.THICKNESS] = np.log(CORTEX_MM)
    out[tube_model.BLURS] = np.log(0.05)
    out[tube_model.OUTSIDE.start] = 40.0
    for name, value in changes.items():
        out[getattr(tube_model, name)] = value
    return out


def outline_points(count: int = 4000) -> Array:
    angle = 2.0 * np.pi * np.arange(count) / count
    return np.stack([HALF_WIDTH_MM * np.cos(angle), HALF_HEIGHT_MM * np.sin(angle)], axis=1)


def exact_distance_mm(points: Array) -> Array:
    """Signed distance (n,) to the ellipse, by its nearest outline point."""
    nearest = scipy.spatial.KDTree(outline_points()).query(points)[0]
    inside = (points / [HALF_WIDTH_MM, HALF_HEIGHT_MM]) ** 2 @ np.ones(2) < 1.0
    return np.where(inside, -nearest, nearest)


def test_the_distance_to_an_elliptic_wall_is_exact_inside_and_outside() -> None:
    points = np.random.default_rng(1).uniform(-8.0, 8.0, (300, 2))
    found, _ = tube_model.wall_distance_mm(parameters(), np.zeros(300), points)
    np.testing.assert_allclose(found, exact_distance_mm(points), atol=5e-3)


def samples(rng: np.random.Generator, count: int) -> tube_model.Samples:
    columns = [
        rng.uniform(-1.0, 1.0, count),
        *rng.uniform(-8.0, 8.0, (2, count)),
        np.full(count, 0.6),
        np.full(count, 0.05),
        np.full(count, 0.1),
        rng.uniform(0.0, 1.0, count),
    ]
    offsets = np.array([[0.1, 0.2, -0.1], [-0.1, 0.1, 0.3]])
    return tube_model.Samples(rows=np.stack(columns, axis=1), offsets=offsets, hu=np.zeros(count))


def test_derivatives_are_those_of_differences() -> None:
    rng = np.random.default_rng(2)
    at = parameters(BLUR=np.log(0.3), SLICE_BLUR=np.log(0.4))
    at[tube_model.CENTRE] = [0.2, 0.3, 0.1, -0.1, 0.2, 0.1]
    at[tube_model.GROWTH], at[tube_model.SHAPE] = [0.02, 0.1, 0.03, 0.08], [0.03, -0.02, 0.02, 0.01]
    at[tube_model.OUTSIDE] = [40.0, 20.0, -10.0, 5.0, 3.0]
    at[tube_model.AROUND] = [0.2, -0.1]
    some = samples(rng, 400)
    _, jacobian = tube_model.model_hu(at, some)
    for n in range(tube_model.COUNT):
        step = 1e-5 * np.eye(tube_model.COUNT)[n]
        difference = (
            tube_model.model_hu(at + step, some)[0] - tube_model.model_hu(at - step, some)[0]
        ) / 2e-5
        off = np.linalg.norm(jacobian[:, n] - difference) / np.linalg.norm(difference)
        # Parts of second order are left out.
        assert off < 0.15, (n, off)


def test_a_coarse_voxel_at_a_curved_wall_is_the_mean_over_its_box() -> None:
    # Slices of 3 mm across the height: the wall is more curved than the voxel is thin.
    rng = np.random.default_rng(3)
    centres = 1.1 * outline_points()[rng.integers(0, 4000, 60)] * rng.uniform(0.7, 1.1, (60, 1))
    steps = [(np.arange(n) + 0.5) / n - 0.5 for n in (12, 60)]
    box = np.stack(np.meshgrid(*steps, indexing="ij"), axis=-1).reshape(-1, 2) * SIDES_MM[[0, 2]]
    depth = exact_distance_mm((centres[:, None] + box).reshape(-1, 2)).reshape(60, -1)
    true = np.where(depth > 0.0, 40.0, np.where(depth > -CORTEX_MM, 900.0, 150.0)).mean(axis=1)

    parts = 4
    _, angle = tube_model.wall_distance_mm(parameters(), np.zeros(60), centres)
    normal = np.stack([np.cos(angle) / HALF_WIDTH_MM, np.sin(angle) / HALF_HEIGHT_MM], axis=1)
    normal /= np.linalg.norm(normal, axis=1, keepdims=True)
    across = np.abs(normal) * [0.6, 3.0 / parts]
    beside = np.abs(normal[:, ::-1]) * [0.6, 3.0 / parts]
    widest = across.max(axis=1)
    rest = (across**2).sum(axis=1) / 12.0 - widest**2 / 12.0
    columns = [np.zeros(60), centres[:, 0], centres[:, 1], widest, rest]
    columns += [(beside**2).sum(axis=1) / 12.0, normal[:, 1] ** 2]
    offsets = np.zeros((parts, 3))
    offsets[:, 2] = 3.0 * ((np.arange(parts) + 0.5) / parts - 0.5)
    made = tube_model.Samples(rows=np.stack(columns, axis=1), offsets=offsets, hu=true)
    off = tube_model.model_hu(parameters(), made)[0] - true
    assert np.sqrt(np.mean(off**2)) < 12.0
    assert abs(np.mean(off)) < 5.0
