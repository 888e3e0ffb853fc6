"""Rays from a section's centre end where the wall has fallen halfway to its outside."""

import numpy as np
import pytest
from scipy import ndimage

from tracker.geometry import Array
from tracker.plan.pedicle.wall_kernels import trilinear_at, walls_around

BLOCK = np.random.default_rng(4).normal(size=(5, 6, 7)).astype(np.float32)


def test_between_voxels_and_beyond_the_block_a_number_is_that_of_the_common_library() -> None:
    at = np.random.default_rng(5).uniform(-2.0, 9.0, size=(200, 3))
    own = [trilinear_at(BLOCK, *one) for one in at]
    common = ndimage.map_coordinates(BLOCK, at[:, ::-1].T, output=np.float64, order=1, mode="nearest")
    assert own == pytest.approx(common, abs=1e-9)


def _steps(profile: Array, *, start: float = 0.0, min_fall: float = 100.0, behind: int = 3) -> float:
    """Distance of the wall from `start` in half voxels, for a block that varies along x only."""
    block = np.tile(np.asarray(profile, np.float32), (2, 2, 1))
    out = np.empty((1, 1))
    centre, step = np.array([[start, 0.5, 0.5]]), np.array([[[0.5, 0.0, 0.0]]])
    walls_around(block, centre, step, 2 * len(profile), min_fall, behind, out)
    return float(0.5 * out[0, 0])


@pytest.mark.parametrize(
    ("profile", "expected"),
    [
        pytest.param([200, 200, 800, 800, 0, 0, 0], 3.5, id="halfway-between-wall-and-outside"),
        pytest.param([200, 200, 800, 800, 400, 0, 0], 4.0, id="over-two-voxels"),
        pytest.param([200, 200, 800, 650, 0, 0, 0], 3.0 + 250.0 / 650.0, id="first-below-half"),
        pytest.param([200, 200, 800, 800, 0, 0, 900], 3.5, id="another-bone-behind"),
        pytest.param([200, 800, 0, 900, 900, 900, 900], 1.5, id="lowest-and-not-last-behind-the-fall"),
        pytest.param([200, 240, 280, 320, 360, 400, 440], np.nan, id="never-falls"),
        pytest.param([200, 200, 290, 200, 200, 200, 200], np.nan, id="falls-too-little"),
        pytest.param([0, 0, 0, 0, 0, 0, 0], np.nan, id="no-bone"),
    ],
)
def test_a_wall_is_where_bone_has_fallen_halfway_to_its_outside(
    profile: list[float], expected: float
) -> None:
    assert _steps(np.array(profile, float)) == pytest.approx(expected, abs=1e-6, nan_ok=True)


def test_the_outside_is_looked_for_only_so_far_behind_the_first_fall() -> None:
    # A trough of 400, then further out one of -1000 that belongs to another bone.
    profile = np.array([800, 800, 400, 400, 400, 400, -1000, -1000], float)
    assert _steps(profile, behind=7) == pytest.approx(1.5)
    assert _steps(profile, behind=8) == pytest.approx(5.0 + 0.5 * 150.0 / 700.0)
    assert _steps(profile, behind=12) == pytest.approx(5.0 + 500.0 / 1400.0)


def test_the_edge_of_the_block_goes_on_and_is_no_wall() -> None:
    assert np.isnan(_steps(np.array([700.0, 800.0, 800.0]), start=1.0))
    assert np.isnan(_steps(np.array([700.0, 800.0, 800.0]), start=40.0))
