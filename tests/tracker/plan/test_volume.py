"""Voxel positions of a volume for any direction of its axes."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tracker.errors import PlanError
from tracker.geometry import rotation_from_vector
from tracker.plan import Volume

SHEARED = np.array([[0.5, 0.0, 0.0, -40.0], [0.0, 0.5, -0.6, 12.0], [0.0, 0.0, 2.0, 700.0], [0, 0, 0, 1.0]])


def ramp(affine: np.ndarray) -> Volume:
    """HU is 1 i + 10 j + 100 k: linear, so that reading between voxels is exact."""
    k, j, i = np.meshgrid(np.arange(5), np.arange(6), np.arange(7), indexing="ij")
    return Volume(hu=(i + 10 * j + 100 * k).astype(np.int16), lps_from_ijk=affine)


def test_a_point_reads_the_voxel_whose_centre_it_is() -> None:
    volume = ramp(SHEARED)
    assert volume.shape_ijk == (7, 6, 5)
    assert volume.sample_hu(volume.lps_from_index([3, 2, 4])) == pytest.approx(423.0)


def test_between_voxels_it_is_linear() -> None:
    volume = ramp(SHEARED)
    points = volume.lps_from_index([[0.5, 0.0, 0.0], [1.25, 2.5, 3.5]])
    assert volume.sample_hu(points) == pytest.approx([0.5, 1.25 + 25.0 + 350.0])


def test_outside_there_is_air() -> None:
    volume = ramp(np.eye(4))
    points = [[-1.0, 0.0, 0.0], [3.0, 3.0, 40.0], [6.0, 5.0, 4.0]]
    assert volume.sample_hu(points) == pytest.approx([-1024.0, -1024.0, 456.0])
    assert volume.contains(points).tolist() == [False, False, True]


def test_the_outermost_voxels_are_inside_however_they_are_rounded() -> None:
    volume = ramp(np.eye(4))
    assert volume.sample_hu([[-1e-12, 0.0, 4.0 + 1e-12], [6.0 + 1e-12, 5.0, 0.0]]) == pytest.approx(
        [400.0, 56.0]
    )


def test_a_tilted_gantry_keeps_its_voxel_size() -> None:
    volume = ramp(SHEARED)
    assert volume.spacing_mm == pytest.approx([0.5, 0.5, np.hypot(0.6, 2.0)])
    assert volume.voxel_mm3 == pytest.approx(0.5)


@given(
    turn=st.tuples(*[st.floats(-3.0, 3.0)] * 3),
    index=st.tuples(*[st.floats(-50.0, 50.0)] * 3),
    spacing=st.tuples(*[st.floats(0.2, 5.0)] * 3),
)
def test_index_and_millimetre_undo_each_other(
    turn: tuple[float, ...], index: tuple[float, ...], spacing: tuple[float, ...]
) -> None:
    affine = np.eye(4)
    affine[:3, :3] = rotation_from_vector(np.array(turn)) @ np.diag(spacing)
    affine[:3, 3] = [10.0, -200.0, 1300.0]
    volume = ramp(affine)
    assert volume.index_from_lps(volume.lps_from_index(index)) == pytest.approx(index, abs=1e-8)


@pytest.mark.parametrize(
    ("hu", "affine", "said"),
    [
        pytest.param(np.zeros((1, 4, 4), np.int16), np.eye(4), "shape", id="a-single-slice"),
        pytest.param(np.zeros((4, 4, 4), np.float32), np.eye(4), "float32", id="not-whole-numbers"),
        pytest.param(np.zeros((4, 4, 4), np.int16), np.diag([1.0, 1.0, 0.0, 1.0]), "flat", id="no-thickness"),
        pytest.param(np.zeros((4, 4, 4), np.int16), np.full((4, 4), np.nan), "finite", id="no-numbers"),
    ],
)
def test_what_is_no_volume_is_rejected(hu: np.ndarray, affine: np.ndarray, said: str) -> None:
    with pytest.raises(PlanError, match=said):
        Volume(hu=hu, lps_from_ijk=affine)


def test_the_axes_are_put_in_the_patients_order_whatever_that_of_the_file() -> None:
    truth = ramp(SHEARED)
    # As in a file whose first axis runs to the head and whose last runs to the left.
    turned = Volume(hu=truth.hu.transpose(2, 1, 0).copy(), lps_from_ijk=SHEARED[:, [2, 1, 0, 3]])
    seen = turned.in_patient_order()
    assert np.array_equal(seen.hu, truth.hu)
    assert seen.lps_from_ijk == pytest.approx(truth.lps_from_ijk)
    cyclic = Volume(hu=truth.hu.transpose(1, 2, 0).copy(), lps_from_ijk=SHEARED[:, [2, 0, 1, 3]])
    assert np.array_equal(cyclic.in_patient_order().hu, truth.hu)
    assert truth.in_patient_order() is truth
