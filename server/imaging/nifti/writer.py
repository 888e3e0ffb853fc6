"""Writing of a volume in Hounsfield units and LPS mm as a compressed NIfTI file."""

import gzip

import nibabel as nib
import numpy as np

from tracker.plan import Volume

# Fast compression, because a person waits for the result.
COMPRESSION = 1
RAS_FROM_LPS = np.diag([-1.0, -1.0, 1.0, 1.0])


def nifti_bytes(volume: Volume) -> bytes:
    """Return the volume as the bytes of a .nii.gz: signed 16 bit, mm, with its position in scanner RAS."""
    # The slowest axis in memory is that of the slices; NIfTI stores columns fastest.
    voxels = np.asarray(volume.hu, dtype=np.int16).transpose(2, 1, 0)
    affine = RAS_FROM_LPS @ volume.lps_from_ijk
    image = nib.Nifti1Image(voxels, affine)
    image.set_sform(affine, code=1)
    image.set_qform(affine, code=1)
    image.header.set_xyzt_units("mm")
    return gzip.compress(image.to_bytes(), compresslevel=COMPRESSION, mtime=0)
