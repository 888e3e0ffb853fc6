"""Extraction of the voxels for surface reconstruction: cropped from the CT and downsampled if too many."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.geometry import Array
from tracker.plan.bone.region import Region
from tracker.plan.volume import Volume

# 100 MB as float32, and as much again during marching cubes.
MAX_VOXELS = 24_000_000


@dataclass(frozen=True, slots=True, kw_only=True)
class Block:
    """A cropped part of a CT, padded for marching cubes.

    Attributes:
        hu: (slices, rows, columns) float32.
        first_ijk: (3,) index in the CT of its first voxel.
        averaged_ijk: (3,) downsampling factor along i, j and k.
        cut_ijk: (2, 3) bool, whether its first and its last layer along i, j, k are the ends of the CT.
    """

    hu: npt.NDArray[np.float32]
    first_ijk: npt.NDArray[np.int64]
    averaged_ijk: npt.NDArray[np.int64]
    cut_ijk: npt.NDArray[np.bool_]

    def index_in_volume(self, index_kji: Array) -> Array:
        """Convert block indexes (n, 3) as k, j, i to CT indexes (n, 3) as i, j, k."""
        # The centre of an averaged voxel is the mean of its source voxels' centres.
        own = index_kji[:, ::-1] * self.averaged_ijk + (self.averaged_ijk - 1) / 2.0
        return np.asarray(own + self.first_ijk)


def block_of(volume: Volume, region: Region | None, *, max_voxels: int = MAX_VOXELS) -> Block:
    """Return the voxels of a region, or of the whole CT; average neighbours until `max_voxels` is met.

    Only these voxels are read, some slices at a time, so that a mapped CT stays on disk.

    Raises:
        PlanError: REGION_OUTSIDE.
    """
    size = np.array(volume.shape_ijk)
    first, last = (np.zeros(3, dtype=np.int64), size) if region is None else region.indexes_in(volume)
    averaged = _averaged(last - first, volume.spacing_mm, max_voxels)
    # The remainder at the end of an axis, less than one averaged voxel, is dropped.
    shape = (last - first) // averaged
    last = first + shape * averaged
    hu = np.empty(tuple(shape[::-1]), dtype=np.float32)
    for k in range(shape[2]):
        start = first[2] + k * averaged[2]
        part = volume.hu[start : start + averaged[2], first[1] : last[1], first[0] : last[0]]
        if (averaged == 1).all():
            hu[k] = part[0]
        else:
            cells = part.reshape(averaged[2], shape[1], averaged[1], shape[0], averaged[0])
            hu[k] = cells.mean(axis=(0, 2, 4), dtype=np.float32)
    return Block(
        hu=hu, first_ijk=first, averaged_ijk=averaged, cut_ijk=np.stack([first == 0, last > size - averaged])
    )


def _averaged(shape_ijk: npt.NDArray[np.int64], spacing_mm: Array, maximum: int) -> npt.NDArray[np.int64]:
    """Return the downsampling factor of each axis; the finest axis is averaged first."""
    averaged = np.ones(3, dtype=np.int64)
    while np.prod(shape_ijk // averaged) > maximum:
        can = shape_ijk // (averaged + 1) >= 2
        spacing = np.where(can, spacing_mm * averaged, np.inf)
        averaged[int(spacing.argmin())] += 1
    return averaged
