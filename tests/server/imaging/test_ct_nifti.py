"""A NIfTI file is read to the voxel, whatever its axes, numbers and units."""

import gzip
import itertools
import zipfile
from pathlib import Path

import nibabel as nib
import numpy as np
import pytest

from server.imaging.ct_reader import read_ct
from tests.server.imaging.made_ct import nifti_of
from tracker.geometry import rotation_from_vector

HU = np.random.default_rng(5).integers(-1000, 2000, (6, 7, 20)).astype(np.int16)
LPS = np.array([-1.0, -1.0, 1.0])


def stored(path: Path, content: bytes) -> Path:
    path.write_bytes(content)
    return path


@pytest.mark.parametrize("signs", list(itertools.product((1, -1), repeat=3)), ids=str)
@pytest.mark.parametrize("order", list(itertools.permutations(range(3))), ids=str)
def test_any_order_and_direction_of_axes(
    tmp_path: Path, order: tuple[int, ...], signs: tuple[int, ...]
) -> None:
    affine = np.eye(4)
    affine[:3, :3] = np.eye(3)[:, order] * np.array(signs) * [0.5, 0.75, 2.0]
    affine[:3, 3] = [-100.0, 30.0, 700.0]
    volume = read_ct(stored(tmp_path / "ct.nii", nifti_of(HU, affine))).volume
    for i, j, k in ((0, 0, 0), (5, 6, 19), (2, 3, 4)):
        assert volume.hu[k, j, i] == HU[i, j, k]
        ras = (affine @ [i, j, k, 1.0])[:3]
        assert volume.lps_from_index([i, j, k]) == pytest.approx(ras * LPS, abs=1e-4)
    assert np.array_equal(volume.hu, HU.transpose(2, 1, 0))


def test_an_oblique_and_packed_file(tmp_path: Path) -> None:
    affine = np.eye(4)
    affine[:3, :3] = rotation_from_vector(np.array([0.2, 0.3, -0.1])) * 0.8
    path = stored(tmp_path / "ct.nii.gz", gzip.compress(nifti_of(HU, affine)))
    volume = read_ct(path, into=tmp_path / "ct.npy").volume
    assert np.array_equal(volume.hu, HU.transpose(2, 1, 0))
    assert volume.spacing_mm == pytest.approx([0.8, 0.8, 0.8])


@pytest.mark.parametrize("kind", ["uint8", "int16", "uint16", "int32", "float32", "float64", ">i2", ">f4"])
def test_any_kind_of_number(tmp_path: Path, kind: str) -> None:
    numbers = np.clip(HU, 0, 255).astype(kind)
    volume = read_ct(stored(tmp_path / "ct.nii", nifti_of(numbers, np.eye(4)))).volume
    assert np.array_equal(volume.hu, numbers.astype(np.int16).transpose(2, 1, 0))


def test_scaled_numbers_are_scaled(tmp_path: Path) -> None:
    image = nib.Nifti1Image(HU, np.eye(4))
    image.header.set_slope_inter(0.5, -24.25)
    image.header.set_data_dtype(np.int16)
    content = bytearray(image.to_bytes())
    content[112:120] = np.array([0.5, -24.25], "<f4").tobytes()
    content[352:] = HU.tobytes(order="F")
    volume = read_ct(stored(tmp_path / "ct.nii", bytes(content))).volume
    assert np.array_equal(volume.hu, np.rint(HU.transpose(2, 1, 0) * 0.5 - 24.25))


def test_nifti_2(tmp_path: Path) -> None:
    content = nib.Nifti2Image(HU, np.diag([2.0, 2.0, 2.0, 1.0])).to_bytes()
    volume = read_ct(stored(tmp_path / "ct.nii", content)).volume
    assert np.array_equal(volume.hu, HU.transpose(2, 1, 0))
    assert volume.lps_from_index([1, 1, 1]) == pytest.approx([-2.0, -2.0, 2.0])


def test_a_fourth_axis_of_one_is_no_series(tmp_path: Path) -> None:
    volume = read_ct(stored(tmp_path / "ct.nii", nifti_of(HU[..., None], np.eye(4)))).volume
    assert np.array_equal(volume.hu, HU.transpose(2, 1, 0))


def test_metres_become_millimetres_and_are_reported(tmp_path: Path) -> None:
    content = nifti_of(
        HU, np.diag([0.001, 0.001, 0.002, 1.0]), change=lambda one: one.set_xyzt_units("meter")
    )
    ct = read_ct(stored(tmp_path / "ct.nii", content))
    assert ct.volume.spacing_mm == pytest.approx([1.0, 1.0, 2.0])
    assert any("metres" in said.message for said in ct.warnings)


def test_what_is_no_number_is_air_and_reported(tmp_path: Path) -> None:
    numbers = HU.astype(np.float32)
    numbers[2, 3, 4:7] = np.nan
    numbers[0, 0, 0] = np.inf
    ct = read_ct(stored(tmp_path / "ct.nii", nifti_of(numbers, np.eye(4))))
    assert (ct.volume.hu[4:7, 3, 2] == -1024).all()
    assert ct.volume.hu[0, 0, 0] == 32767
    assert any("3 voxels are NaN" in said.message for said in ct.warnings)
    assert any("1 voxels were outside" in said.message for said in ct.warnings)


def test_two_affines_that_place_differently_are_reported(tmp_path: Path) -> None:
    moved = np.eye(4)
    moved[:3, 3] = [3.0, 4.0, 0.0]
    content = nifti_of(
        HU, np.eye(4), change=lambda one: (one.set_sform(np.eye(4), 1), one.set_qform(moved, 1))
    )
    ct = read_ct(stored(tmp_path / "ct.nii", content))
    assert any("differ by up to 5.0 mm" in said.message for said in ct.warnings)


@pytest.mark.parametrize(
    ("hu", "said"),
    [
        pytest.param(np.clip(HU, 0, 2000), "no air", id="no-air"),
        pytest.param(np.clip(HU, -1000, 150), "no bone", id="no-bone"),
        pytest.param(np.full((4, 4, 4), 7, np.int16), "this CT is empty", id="empty"),
    ],
)
def test_numbers_that_are_no_body_are_reported(tmp_path: Path, hu: np.ndarray, said: str) -> None:
    ct = read_ct(stored(tmp_path / "ct.nii", nifti_of(hu, np.eye(4))))
    assert any(said in one.message for one in ct.warnings)


def test_a_nifti_in_a_zip(tmp_path: Path) -> None:
    with zipfile.ZipFile(tmp_path / "ct.zip", "w", zipfile.ZIP_DEFLATED) as archive:
        archive.writestr("patient/ct.nii.gz", gzip.compress(nifti_of(HU, np.eye(4))))
    assert np.array_equal(read_ct(tmp_path / "ct.zip").volume.hu, HU.transpose(2, 1, 0))
