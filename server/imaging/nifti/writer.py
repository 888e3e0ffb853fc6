"""Writing of a volume in Hounsfield units and LPS mm, or of its labels, as a compressed NIfTI file."""

import gzip

import nibabel as nib
import numpy as np
import numpy.typing as npt

from tracker.geometry import Array
from tracker.plan import Volume

# Fast compression, because a person waits for the result.
COMPRESSION = 1
RAS_FROM_LPS = np.diag([-1.0, -1.0, 1.0, 1.0])


def nifti_bytes(volume: Volume) -> bytes:
    """Return the volume as the bytes of a .nii.gz: signed 16 bit, mm, with its position in scanner RAS."""
    voxels = np.asarray(volume.hu, dtype=np.int16)
    return compressed_nifti(voxels, volume.lps_from_ijk, compression=COMPRESSION)


def compressed_nifti(
    voxels: npt.NDArray[np.int16] | npt.NDArray[np.uint8], lps_from_ijk: Array, *, compression: int
) -> bytes:
    """Return voxels as the bytes of a .nii.gz: mm, with their position in scanner RAS.

    Args:
        voxels: (slices, rows, columns); voxels[k, j, i] belongs to index (i, j, k).
        lps_from_ijk: (4, 4), affine of the voxel centres in mm.
        compression: level of gzip, 1 to 9.
    """
    affine = RAS_FROM_LPS @ lps_from_ijk
    # The slowest axis in memory is that of the slices; NIfTI stores columns fastest.
    image = nib.Nifti1Image(voxels.transpose(2, 1, 0), affine)
    image.set_sform(affine, code=1)
    image.set_qform(affine, code=1)
    image.header.set_xyzt_units("mm")
    return gzip.compress(image.to_bytes(), compresslevel=compression, mtime=0)
