"""Simulated CT scanner: voxelisation of a Hounsfield field with partial volume and noise."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import scipy

from tracker.geometry import Array
from tracker.plan import Volume

HuAt = Callable[[Array], Array]
CHUNK = 400_000
FLAT_HU = 4.0


@dataclass(frozen=True, slots=True, kw_only=True)
class ScanGrid:
    """Voxel grid and slice thickness of a scan.

    Attributes:
        lps_from_ijk: (4, 4) affine in mm, as in `Volume`; may be oblique or sheared.
        shape_ijk: number of columns, rows and slices.
        thickness_ratio: slice thickness as a ratio of the slice distance; above 1 they overlap.
        blur_mm: sigma of the scanner's own blur within a slice, on top of the voxel's size.
        noise_hu: standard deviation of the noise of a voxel.
        samples: points along each axis that a voxel averages where the field is not flat.
        seed: of the noise.
    """

    lps_from_ijk: Array
    shape_ijk: tuple[int, int, int]
    thickness_ratio: float = 1.0
    blur_mm: float = 0.0
    noise_hu: float = 0.0
    samples: tuple[int, int, int] = (3, 3, 5)
    seed: int = 1

    @staticmethod
    def around(
        centre_lps_mm: npt.ArrayLike,
        *,
        size_mm: tuple[float, float, float],
        spacing_mm: tuple[float, float, float],
        rotation: npt.ArrayLike | None = None,
        gantry_tilt_deg: float = 0.0,
        thickness_ratio: float = 1.0,
        blur_mm: float = 0.0,
        noise_hu: float = 0.0,
        seed: int = 1,
    ) -> "ScanGrid":
        """Return a grid around a point: rows run to the left, columns backwards, slices to the head.

        `rotation` (3, 3) turns the whole stack; a tilted gantry shears it, as scanners do.
        """
        turn = np.eye(3) if rotation is None else np.asarray(rotation, dtype=np.float64)
        axes = turn @ np.diag(spacing_mm)
        axes[:, 2] += turn[:, 1] * np.tan(np.radians(gantry_tilt_deg)) * spacing_mm[2]
        count = np.maximum(np.round(np.array(size_mm) / np.array(spacing_mm)).astype(int), 2)
        affine = np.eye(4)
        affine[:3, :3] = axes
        # A random fraction of a voxel, so that walls do not coincide with voxel borders.
        offset = np.random.default_rng(seed).uniform(-0.5, 0.5, 3)
        affine[:3, 3] = np.asarray(centre_lps_mm, dtype=np.float64) - axes @ ((count - 1) / 2.0 + offset)
        finest = np.clip(np.ceil(np.array(spacing_mm) / 0.2), 3, 9).astype(int)
        return ScanGrid(
            lps_from_ijk=affine,
            shape_ijk=(int(count[0]), int(count[1]), int(count[2])),
            thickness_ratio=thickness_ratio,
            blur_mm=blur_mm,
            noise_hu=noise_hu,
            samples=(int(finest[0]), int(finest[1]), int(finest[2])),
            seed=seed,
        )


def scan(hu_at: HuAt, grid: ScanGrid) -> Volume:
    """Return the CT of a Hounsfield field.

    A voxel is the mean of the field over its box (partial volume), with blur in the slice and noise.

    Args:
        hu_at: from points (n, 3) in LPS mm to HU (n,).
        grid: the voxels.
    """
    columns, rows, slices = grid.shape_ijk
    k, j, i = np.meshgrid(np.arange(slices), np.arange(rows), np.arange(columns), indexing="ij")
    index = np.stack([i.ravel(), j.ravel(), k.ravel()], axis=1).astype(np.float64)
    hu = _field(hu_at, grid, index)
    uneven = _uneven(hu.reshape(slices, rows, columns), grid).ravel()
    hu[uneven] = _averaged(hu_at, grid, index[uneven])
    block = hu.reshape(slices, rows, columns)
    if grid.blur_mm > 0.0:
        spacing = np.linalg.norm(grid.lps_from_ijk[:3, :2], axis=0)
        block = scipy.ndimage.gaussian_filter(
            block, (0.0, grid.blur_mm / spacing[1], grid.blur_mm / spacing[0])
        )
    if grid.noise_hu > 0.0:
        block = block + np.random.default_rng(grid.seed).normal(0.0, grid.noise_hu, block.shape)
    whole = np.clip(np.round(block), -1024, 30_000).astype(np.int16)
    return Volume(hu=whole, lps_from_ijk=grid.lps_from_ijk)


def _field(hu_at: HuAt, grid: ScanGrid, index: Array) -> Array:
    out = np.empty(len(index))
    for start in range(0, len(index), CHUNK):
        part = index[start : start + CHUNK]
        out[start : start + CHUNK] = hu_at(part @ grid.lps_from_ijk[:3, :3].T + grid.lps_from_ijk[:3, 3])
    return out


def _uneven(block: Array, grid: ScanGrid) -> npt.NDArray[np.bool_]:
    """Return the voxels that may contain several tissues: neighbours within two voxels differ."""
    reach = (5 if grid.thickness_ratio > 1.0 else 3, 3, 3)
    spread = scipy.ndimage.maximum_filter(block, size=reach) - scipy.ndimage.minimum_filter(block, size=reach)
    return np.asarray(spread > FLAT_HU)


def _averaged(hu_at: HuAt, grid: ScanGrid, index: Array) -> Array:
    steps = [(np.arange(n) + 0.5) / n - 0.5 for n in grid.samples]
    steps[2] = steps[2] * grid.thickness_ratio
    total = np.zeros(len(index))
    for offset in np.stack(np.meshgrid(*steps, indexing="ij"), axis=-1).reshape(-1, 3):
        total += _field(hu_at, grid, index + offset)
    return np.asarray(total / np.prod(grid.samples))
