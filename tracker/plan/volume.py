"""A CT volume of Hounsfield units with its affine in the patient."""

import itertools
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import scipy

from tracker.errors import PlanError
from tracker.geometry import Array

# Outside the scanned block the HU are unknown; air prevents a false detection of bone.
OUTSIDE_HU = -1024.0
BORDER_VOXELS = 1e-6


@dataclass(frozen=True, slots=True, kw_only=True)
class Volume:
    """A CT: Hounsfield units of the voxels, and the affine of the voxel centres in the patient.

    The array may be mapped from a file; it is never copied here.

    Attributes:
        hu: (slices, rows, columns) int16, in HU; hu[k, j, i] belongs to index (i, j, k).
        lps_from_ijk: (4, 4) affine, takes an index (i, j, k) to LPS in mm (the vertebra's frame). It may be
            oblique or sheared (a tilted gantry), never flat.

    Raises:
        PlanError: VOLUME_INVALID, the array is not three-dimensional, not int16, thinner than two voxels, or
            the affine is flat, not finite or not affine.
    """

    hu: npt.NDArray[np.int16]
    lps_from_ijk: Array

    def __post_init__(self) -> None:
        affine = np.array(self.lps_from_ijk, dtype=np.float64)
        problem = _problem(self.hu, affine)
        if problem:
            raise PlanError(
                "VOLUME_INVALID",
                f"the CT cannot be used: {problem}",
                "Export the series again as DICOM or NIfTI with its geometry, at least two slices.",
                {"shape": list(self.hu.shape), "volume_problem": problem},
            )
        affine.setflags(write=False)
        object.__setattr__(self, "lps_from_ijk", affine)

    @property
    def shape_ijk(self) -> tuple[int, int, int]:
        """Return the number of columns, rows and slices."""
        slices, rows, columns = self.hu.shape
        return columns, rows, slices

    @property
    def spacing_mm(self) -> Array:
        """Return the distances (3,) between neighbouring voxels along i, j and k, in mm."""
        return np.asarray(np.linalg.norm(self.lps_from_ijk[:3, :3], axis=0))

    @property
    def voxel_mm3(self) -> float:
        """Return the volume of one voxel."""
        return float(abs(np.linalg.det(self.lps_from_ijk[:3, :3])))

    def in_patient_order(self) -> "Volume":
        """Return the CT with i nearest to left-right, j to front-back, k to feet-head; nothing is copied.

        A "slice" is then axial for any order of the axes in a file. The directions of the axes are unchanged.
        """
        along = np.abs(self.lps_from_ijk[:3, :3] / self.spacing_mm)
        orders = list(itertools.permutations(range(3)))
        best = max(orders, key=lambda order: sum(along[axis, order[axis]] for axis in range(3)))
        if best == (0, 1, 2):
            return self
        # The array has its axes the other way round: k, j, i.
        hu = self.hu.transpose([2 - axis for axis in reversed(best)])
        return Volume(hu=hu, lps_from_ijk=self.lps_from_ijk[:, [*best, 3]])

    def lps_from_index(self, index_ijk: npt.ArrayLike) -> Array:
        """Return points (..., 3) in LPS mm of indexes (..., 3); fractions are allowed."""
        index = np.asarray(index_ijk, dtype=np.float64)
        return np.asarray(index @ self.lps_from_ijk[:3, :3].T + self.lps_from_ijk[:3, 3])

    def index_from_lps(self, points_lps_mm: npt.ArrayLike) -> Array:
        """Return indexes (..., 3) as i, j, k of points (..., 3) in LPS mm; not rounded, may lie outside."""
        points = np.asarray(points_lps_mm, dtype=np.float64) - self.lps_from_ijk[:3, 3]
        return np.asarray(points @ np.linalg.inv(self.lps_from_ijk[:3, :3]).T)

    def contains(self, points_lps_mm: npt.ArrayLike) -> npt.NDArray[np.bool_]:
        """Return which points (..., 3) in LPS mm lie between the outermost voxel centres: (...) bool."""
        index = self.index_from_lps(points_lps_mm)
        last_index = np.array(self.shape_ijk) - 1.0
        return np.asarray(((index >= -1e-9) & (index <= last_index + 1e-9)).all(axis=-1))

    def sample_hu(self, points_lps_mm: npt.ArrayLike) -> Array:
        """Return HU (...) at points (..., 3) in LPS mm, trilinear; -1024 outside the scanned block.

        Only the part of the volume around the points is read, so that a mapped file stays on disk.
        """
        index = self.index_from_lps(points_lps_mm)
        shape, flat = index.shape[:-1], index.reshape(-1, 3)[:, ::-1]
        if flat.shape[0] == 0:
            return np.zeros(shape)
        size = np.array(self.hu.shape)
        # A point on the outermost voxels is inside, regardless of rounding.
        bordering = np.clip(flat, 0.0, size - 1.0)
        flat = np.where(np.abs(flat - bordering) <= BORDER_VOXELS, bordering, flat)
        low = np.clip(np.floor(flat.min(axis=0)).astype(np.int64), 0, size - 1)
        high = np.clip(np.ceil(flat.max(axis=0)).astype(np.int64) + 1, low + 1, size)
        part = self.hu[low[0] : high[0], low[1] : high[1], low[2] : high[2]]
        values = scipy.ndimage.map_coordinates(
            part, (flat - low).T, output=np.float64, order=1, mode="constant", cval=OUTSIDE_HU
        )
        return np.asarray(values.reshape(shape))


def _problem(hu: npt.NDArray[np.int16], affine: Array) -> str:
    """Return the defect of this array or affine, or an empty string."""
    if hu.ndim != 3 or min(hu.shape) < 2:
        return f"its array has shape {hu.shape}, needed three dimensions of at least 2"
    if hu.dtype != np.int16:
        return f"its values are {hu.dtype}, needed int16"
    if affine.shape != (4, 4) or not np.isfinite(affine).all():
        return "its affine is not a (4, 4) matrix of finite numbers"
    if np.abs(affine[3] - [0.0, 0.0, 0.0, 1.0]).max() > 1e-9:
        return "the last row of its affine is not 0 0 0 1"
    lengths = np.linalg.norm(affine[:3, :3], axis=0)
    if lengths.min() < 1e-6 or abs(np.linalg.det(affine[:3, :3] / np.maximum(lengths, 1e-12))) < 1e-3:
        return "its affine is flat: two axes of the volume have the same direction, or one has no length"
    return ""
