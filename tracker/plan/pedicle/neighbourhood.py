"""The part of a CT around a click, with its noise level and the HU of soft tissue and cortex."""

from collections.abc import Callable
from dataclasses import dataclass

import cv2
import numpy as np
import numpy.typing as npt
import scipy

from tracker.geometry import Array
from tracker.plan.volume import Volume

REACH_MM = 70.0
NEAR_MM = 14.0
# Metal is far above any bone; values are clipped here.
MAX_HU = 1600.0
SMOOTH_MM = 0.45
# Slices from which noise is estimated.
NOISE_SLICES = 64
# Half the distance over which the normal of a wall is taken.
NORMAL_MM = 1.5


@dataclass(frozen=True, slots=True, kw_only=True)
class Neighbourhood:
    """A block of the CT around a point, unfiltered and slightly smoothed.

    Attributes:
        block: (slices, rows, columns) float32, HU, clipped to the range of bone.
        smooth: the same, smoothed by about half a millimetre where voxels are finer than that.
        lps_from_index: (4, 4), from index (i, j, k) of the block to LPS mm.
        noise_hu: standard deviation of a voxel's noise.
        tissue_hu: typical HU of the soft tissue around.
        cortex_hu: HU of the densest bone near the point.
    """

    block: npt.NDArray[np.float32]
    smooth: npt.NDArray[np.float32]
    lps_from_index: Array
    noise_hu: float
    tissue_hu: float
    cortex_hu: float

    @property
    def min_fall_hu(self) -> float:
        """Return the minimum fall in HU of a wall to its outside."""
        return float(max(80.0, 2.5 * self.noise_hu, 0.2 * (self.cortex_hu - self.tissue_hu)))

    @property
    def soft_below_hu(self) -> float:
        """Return the HU below which a voxel is soft tissue."""
        return self.tissue_hu + max(60.0, 0.12 * (self.cortex_hu - self.tissue_hu))

    @property
    def bone_above_hu(self) -> float:
        """Return the HU above which a voxel is bone (metal and contrast excepted)."""
        return self.tissue_hu + max(120.0, 0.4 * (self.cortex_hu - self.tissue_hu))

    def voxel_width_mm(self, directions: Array) -> Array:
        """Return the extent (..., 3) of a voxel's three sides along unit directions (..., 3)."""
        return np.abs(directions @ self.lps_from_index[:3, :3])

    def index_of(self, points_lps_mm: Array) -> Array:
        """Return the block indexes (..., 3) as i, j, k."""
        return self.index_step(points_lps_mm - self.lps_from_index[:3, 3])

    def index_step(self, steps_lps_mm: Array) -> Array:
        """Return steps (..., 3) in indexes (i, j, k)."""
        inverse = np.linalg.inv(self.lps_from_index[:3, :3])
        return np.asarray(steps_lps_mm @ inverse.T)

    def contains(self, points_lps_mm: Array) -> npt.NDArray[np.bool_]:
        """Return which points (..., 3) lie in the block."""
        index = self.index_of(points_lps_mm)
        last_index = np.array(self.block.shape[::-1]) - 1.0
        return np.asarray(((index >= 0.0) & (index <= last_index)).all(axis=-1))

    def smooth_hu(self, points_lps_mm: Array) -> Array:
        """Return the smoothed HU (...) at points (..., 3); the border is replicated."""
        index = self.index_of(points_lps_mm)
        flat = index.reshape(-1, 3)[:, ::-1]
        values = scipy.ndimage.map_coordinates(
            self.smooth, flat.T, output=np.float64, order=1, mode="nearest"
        )
        return np.asarray(values.reshape(index.shape[:-1]))

    def outwards_at(self, point_lps_mm: Array) -> Array:
        """Return the direction (3,) in which HU fall around a point, averaged over a few millimetres."""
        return falling_direction(self.smooth_hu, point_lps_mm, NORMAL_MM)

    @property
    def slice_normal(self) -> Array:
        """Return the unit normal (3,) of the slices."""
        normal = np.cross(self.lps_from_index[:3, 0], self.lps_from_index[:3, 1])
        return np.asarray(normal / np.linalg.norm(normal))


def falling_direction(values_at: Callable[[Array], Array], point_mm: Array, reach_mm: float) -> Array:
    """Return the unit direction (3,) in which values (n,) at points (n, 3) fall, by differences."""
    values = values_at(point_mm + reach_mm * np.concatenate([np.eye(3), -np.eye(3)]))
    fall = values[3:] - values[:3]
    return np.asarray(fall / max(float(np.linalg.norm(fall)), 1e-9))


def neighbourhood_of(volume: Volume, centre_lps_mm: Array) -> Neighbourhood:
    """Return the block within 70 mm of a point, clipped to the volume."""
    index = volume.index_from_lps(centre_lps_mm)
    # The block must hold a ball of this reach, so along each index axis as many voxels as the ball covers.
    inverse = np.linalg.inv(volume.lps_from_ijk[:3, :3])
    reach = np.linalg.norm(inverse, axis=1) * REACH_MM
    low = np.clip(np.floor(index - reach).astype(int), 0, np.array(volume.shape_ijk) - 2)
    high = np.clip(np.ceil(index + reach).astype(int) + 1, low + 2, np.array(volume.shape_ijk))
    raw = volume.hu[low[2] : high[2], low[1] : high[1], low[0] : high[0]]
    # NIfTI has its voxels in another order, which OpenCV does not take.
    block = np.clip(raw.astype(np.float32, order="C"), -1024.0, MAX_HU)
    affine = np.array(volume.lps_from_ijk)
    affine[:3, 3] = volume.lps_from_index(low.astype(np.float64))
    spacing = volume.spacing_mm[::-1]
    # Smooth only if voxels are finer than the walls.
    sigma = np.sqrt(np.maximum(SMOOTH_MM**2 - (0.5 * spacing) ** 2, 0.0)) / spacing
    near = _near(block, affine, centre_lps_mm)
    noise = _noise_hu(block)
    soft = near[(near > -200.0) & (near < 150.0)]
    tissue = float(np.median(soft)) if len(soft) > 20 else 0.0
    cortex = float(np.percentile(near, 98.0)) if len(near) else tissue
    return Neighbourhood(
        block=block,
        smooth=_smoothed(block, sigma),
        lps_from_index=affine,
        noise_hu=noise,
        tissue_hu=tissue,
        cortex_hu=cortex,
    )


def _smoothed(block: npt.NDArray[np.float32], sigma: Array) -> npt.NDArray[np.float32]:
    """Return a block convolved with a Gaussian of this sigma (3,) in voxels: slices, rows, columns.

    OpenCV takes a fifth of the time of `scipy.ndimage.gaussian_filter`, a second in a fine CT.
    """
    z, y, x = (cv2.getGaussianKernel(2 * round(4.0 * one) + 1, one) for one in sigma)
    within = np.empty_like(block)
    for one, out in zip(block, within, strict=True):
        cv2.sepFilter2D(one, -1, x, y, dst=out, borderType=cv2.BORDER_REFLECT)
    columns = within.reshape(len(block), -1)
    across = cv2.sepFilter2D(columns, -1, np.ones(1), z, borderType=cv2.BORDER_REFLECT)
    return np.asarray(across, dtype=np.float32).reshape(block.shape)


def _near(block: npt.NDArray[np.float32], affine: Array, centre: Array) -> Array:
    """Return the HU of the voxels within 14 mm."""
    inverse = np.linalg.inv(affine[:3, :3])
    middle, reach = inverse @ (centre - affine[:3, 3]), np.linalg.norm(inverse, axis=1) * NEAR_MM
    low = np.maximum(np.floor(middle - reach).astype(int), 0)
    high = np.ceil(middle + reach).astype(int) + 1
    part = block[low[2] : high[2], low[1] : high[1], low[0] : high[0]]
    index = np.moveaxis(np.indices(part.shape), 0, -1)[..., ::-1] + low
    away = (index - middle) @ affine[:3, :3].T
    return np.asarray(part[(away**2).sum(axis=-1) < NEAR_MM**2], dtype=np.float64)


def _noise_hu(block: npt.NDArray[np.float32]) -> float:
    """Estimate noise from differences of neighbours within a slice; the median is robust to edges."""
    some = block[:: max(1, len(block) // NOISE_SLICES), ::2]
    step = np.abs(np.diff(some[:, :, ::2], n=2, axis=2))
    real = step[some[:, :, 1:-1:2][:, :, : step.shape[2]] > -900.0]
    return float(np.median(real) / (0.6745 * np.sqrt(6.0))) if real.size else 0.0
