"""The surface of a real vertebra: between its neighbours, at a threshold that a radiologist would choose."""

import nibabel
import numpy as np

from tests.real_data import real_data_file
from tracker.plan import Volume
from tracker.plan.bone import BoneSettings, Region, bone_surface

L3_LABEL = 29
LPS_FROM_RAS = np.diag([-1.0, -1.0, 1.0, 1.0])


def test_a_lumbar_vertebra_is_cut_out_of_a_real_scan() -> None:
    scan = nibabel.Nifti1Image.from_filename(real_data_file("ct", "lumbar-3mm", "ct.nii.gz"))
    labels = nibabel.Nifti1Image.from_filename(real_data_file("ct", "lumbar-3mm", "automatic-labels.nii.gz"))
    hu = np.ascontiguousarray(np.asarray(scan.dataobj).astype(np.int16).transpose(2, 1, 0))
    volume = Volume(hu=hu, lps_from_ijk=LPS_FROM_RAS @ scan.affine)
    voxels = volume.lps_from_index(np.argwhere(np.asarray(labels.dataobj) == L3_LABEL))
    region = Region.around(voxels, reach_mm=3.0)
    made = bone_surface(volume, BoneSettings(region=region))
    assert 150.0 < made.threshold_hu < 300.0
    assert 0.0 < made.proposal.surroundings_hu < 60.0
    assert made.averaged_ijk == (1, 1, 1)
    assert made.cut_at == ()
    # About as large as segmented automatically; thin processes vanish in voxels of 3 mm.
    for ends in (np.min, np.max):
        assert np.abs(ends(made.surface.vertices_mm, axis=0) - ends(voxels, axis=0)).max() < 15.0
    assert made.surface.volume_ml > 0.0
