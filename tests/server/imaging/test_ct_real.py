"""Files of real scanners are read to the voxel and the micrometre."""

import nibabel as nib
import numpy as np
import pydicom

from server.imaging.ct_reader import list_series, read_ct
from tests.real_data import real_data_file


def test_every_voxel_of_a_scanners_slices_is_at_its_stated_position() -> None:
    folder = real_data_file("ct", "thoracic-dicom")
    ct = read_ct(folder)
    slices = sorted(
        (pydicom.dcmread(path) for path in folder.glob("*.dcm")),
        key=lambda one: float(one.ImagePositionPatient[2]),
    )
    assert ct.volume.shape_ijk == (512, 512, 20)
    for k, one in enumerate(slices):
        assert np.array_equal(ct.volume.hu[k], one.pixel_array.astype(np.int32) - 1024)
        last = np.add(one.ImagePositionPatient, [511 * 0.9765625, 511 * 0.9765625, 0.0])
        assert np.abs(ct.volume.lps_from_index([511, 511, k]) - last).max() < 1e-9


def test_a_scanners_series_is_described() -> None:
    (series,) = list_series(real_data_file("ct", "thoracic-dicom"))
    assert (series.kind, series.modality, series.images, series.problem) == ("dicom", "CT", 20, "")
    assert series.pixel_mm == (0.9765625, 0.9765625)
    assert series.thickness_mm == 3.0
    assert "JPEG 2000" in series.compression


def test_every_voxel_of_a_nifti_is_where_nibabel_places_it() -> None:
    path = real_data_file("ct", "lumbar-3mm", "ct.nii.gz")
    ct = read_ct(path)
    image = nib.Nifti1Image.from_filename(path)
    assert np.array_equal(ct.volume.hu, np.asarray(image.dataobj).transpose(2, 1, 0))
    ras = image.affine @ [7.0, 50.0, 100.0, 1.0]
    assert np.abs(ct.volume.lps_from_index([7, 50, 100]) - [-ras[0], -ras[1], ras[2]]).max() < 1e-9
