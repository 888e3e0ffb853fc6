"""One image of labels, as read from a file."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.geometry import Array
from tracker.plan.labels import Labels


@dataclass(frozen=True, slots=True, kw_only=True)
class LabelImage:
    """Class numbers of vertebrae in the voxels of a file.

    Attributes:
        labels: (slices, rows, columns) uint8, class numbers of `CLASS_OF_LEVEL`; 0 is no vertebra.
        lps_from_ijk: (4, 4), affine of its voxel centres in mm.
        source: "nifti" or "dicom".
        is_named: whether the file or the request names its labels; otherwise the numbers of TotalSegmentator
            are assumed.
        others: number of labels that are no vertebra, and are not used.
    """

    labels: Labels
    lps_from_ijk: Array
    source: str
    is_named: bool
    others: int

    @property
    def spacing_mm(self) -> Array:
        """Return the distances (3,) between neighbouring voxels along i, j and k."""
        return np.asarray(np.linalg.norm(self.lps_from_ijk[:3, :3], axis=0))


def bounding_box(labels: npt.NDArray[np.uint8]) -> tuple[slice, slice, slice] | None:
    """Return the part of (slices, rows, columns) that has labels; None without any.

    One slice is looked at after the other, so that an array that is mostly zero stays small in memory.
    """
    slices = [k for k, one in enumerate(labels) if one.any()]
    if not slices:
        return None
    shadow = np.zeros(labels.shape[1:], dtype=bool)
    for k in slices:
        shadow |= labels[k] > 0
    rows, columns = np.flatnonzero(shadow.any(axis=1)), np.flatnonzero(shadow.any(axis=0))
    return (
        slice(slices[0], slices[-1] + 1),
        slice(int(rows[0]), int(rows[-1]) + 1),
        slice(int(columns[0]), int(columns[-1]) + 1),
    )
