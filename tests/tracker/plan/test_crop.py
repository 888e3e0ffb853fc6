"""Part of a CT around some points: the same voxels at the same positions, with limited size."""

import numpy as np
import pytest

from tracker.errors import PlanError
from tracker.geometry import rotation_from_vector
from tracker.plan import Volume
from tracker.plan.crop import cropped_around

HU_PER_MM = np.array([3.0, -2.0, 1.0])
CHANNEL = [[15.0, 14.0, 2.0], [8.0, -30.0, 3.0]]


def ramp() -> Volume:
    """An oblique CT with HU linear in position, so that every average is known."""
    affine = np.eye(4)
    affine[:3, :3] = rotation_from_vector([0.1, -0.05, 0.2]) @ np.diag([1.0, 1.25, 2.0])
    shape = (120, 140, 130)
    affine[:3, 3] = -affine[:3, :3] @ (np.array(shape) / 2.0)
    index = np.stack(np.meshgrid(*[np.arange(n) for n in shape], indexing="ij"), axis=-1)
    hu = (index @ affine[:3, :3].T + affine[:3, 3]) @ HU_PER_MM
    return Volume(hu=np.rint(hu).astype(np.int16).T.copy(), lps_from_ijk=affine)


def test_the_part_has_the_same_hu_at_the_same_places() -> None:
    whole = ramp()
    part = cropped_around(whole, CHANNEL)
    places = np.random.default_rng(1).uniform([-10, -55, -20], [40, 40, 25], (500, 3))
    assert part.contains(places).all()
    np.testing.assert_allclose(part.sample_hu(places), whole.sample_hu(places), atol=1e-6)
    assert part.hu.nbytes < whole.hu.nbytes / 4


def test_a_part_that_is_too_large_is_averaged_where_its_voxels_are_finest() -> None:
    whole = ramp()
    part = cropped_around(whole, CHANNEL, max_bytes=300_000)
    assert part.hu.nbytes <= 300_000
    np.testing.assert_allclose(part.spacing_mm, [2.0, 2.5, 2.0], rtol=1e-9)
    places = np.random.default_rng(1).uniform([-5, -50, -20], [35, 35, 20], (500, 3))
    # A voxel is rounded in each of the two steps, and in the CT itself.
    assert np.abs(part.sample_hu(places) - places @ HU_PER_MM).max() < 1.5


def test_channels_beside_the_ct_are_rejected_with_numbers() -> None:
    with pytest.raises(PlanError, match="needed 2 along each axis") as rejected:
        cropped_around(ramp(), [[500.0, 0.0, 0.0], [510.0, 0.0, 0.0]])
    assert rejected.value.code == "CROP_OUTSIDE_CT"
