"""The file of labels in a case: a compressed NIfTI of the part of the CT that has labels.

Its numbers are those of TotalSegmentator v2, so that other programs can show it.
"""

import gzip
from pathlib import Path

import nibabel as nib
import numpy as np

from server.imaging.nifti.affine import LPS_FROM_RAS, MIN_VOXEL_MM
from server.imaging.nifti.header import BAD_NIFTI
from server.imaging.nifti.writer import compressed_nifti
from tracker.errors import InvalidInput
from tracker.plan.labels import LabelVolume

COMPRESSION = 6
# The part of the largest CT that vertebrae can take; a damaged file must not take more memory.
MAX_BYTES = 2**29


def label_file_bytes(volume: LabelVolume) -> bytes:
    """Return labels as the bytes of a .nii.gz."""
    return compressed_nifti(volume.labels, volume.lps_from_ijk, compression=COMPRESSION)


def load_label_file(path: Path, *, voxel_mm: float) -> LabelVolume:
    """Return the labels of a file of `label_file_bytes`.

    Raises:
        InvalidInput: LABELS_DAMAGED.
    """
    try:
        with gzip.open(path) as file:
            content = file.read(MAX_BYTES + 1)
        image = nib.Nifti1Image.from_bytes(content[:MAX_BYTES])
        labels = np.asarray(image.dataobj)
        affine = LPS_FROM_RAS @ np.asarray(image.header.get_sform(), dtype=np.float64)
    except (*BAD_NIFTI, OSError):
        raise labels_damaged() from None
    voxel_mm3 = float(np.abs(np.linalg.det(affine[:3, :3]))) if np.isfinite(affine).all() else 0.0
    if labels.ndim != 3 or labels.dtype != np.uint8 or voxel_mm3 < MIN_VOXEL_MM**3:
        raise labels_damaged()
    return LabelVolume(
        labels=np.ascontiguousarray(labels.transpose(2, 1, 0)), lps_from_ijk=affine, voxel_mm=voxel_mm
    )


def labels_damaged() -> InvalidInput:
    """Return the error for labels of a case that cannot be read."""
    return InvalidInput(
        "LABELS_DAMAGED", "the file of the labels in the case is damaged", "Send the segmentation again."
    )
