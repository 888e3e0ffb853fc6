"""Phantoms with a known pedicle, independent of the project's own phantom, and errors of a measurement."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np

from tracker.plan import PedicleMeasure, Volume
from tracker.plan.pedicle import sagittal_deg_of, transverse_deg_of
from tracker.rehearsal.ct import PedicleTruth, ScanGrid, scan

HuAt = Callable[[np.ndarray], np.ndarray]


@dataclass(frozen=True, kw_only=True)
class Off:
    """Errors of one measurement."""

    width_voxels: float
    height_voxels: float
    transverse_deg: float
    sagittal_deg: float
    length_mm: float

    @property
    def is_small(self) -> bool:
        sizes = abs(self.width_voxels), abs(self.height_voxels)
        return max(sizes) < 0.5 and max(abs(self.transverse_deg), abs(self.sagittal_deg)) < 1.0


def off_by(measure: PedicleMeasure, truth: PedicleTruth, volume: Volume) -> Off:
    """In voxels of the slice, the smaller ones, also for the height in thick slices."""
    voxel = float(volume.spacing_mm[0])
    return Off(
        width_voxels=(measure.width_mm - truth.width_mm) / voxel,
        height_voxels=(measure.height_mm - truth.height_mm) / voxel,
        transverse_deg=measure.transverse_deg - transverse_deg_of(truth.axis_lps, measure.side),
        sagittal_deg=measure.sagittal_deg - sagittal_deg_of(truth.axis_lps),
        length_mm=measure.length_mm - truth.length_mm,
    )


def rod_between_blocks(
    *, width_mm: float, height_mm: float, axis: np.ndarray, rod_hu: float, block_hu: float, around_hu: float
) -> HuAt:
    """A solid elliptic rod through the origin that joins two solid blocks: no cortex, no marrow."""
    up = np.array([0.0, 0.0, 1.0]) - axis * axis[2]
    up /= np.linalg.norm(up)
    across = np.cross(axis, up)

    def hu_at(p: np.ndarray) -> np.ndarray:
        hu = np.full(len(p), around_hu)
        for y in (-26.0, 18.0):
            inside = (np.abs(p - [0.0, y, 0.0]) < [20.0, 16.0 if y < 0 else 8.0, 13.0]).all(axis=1)
            hu[inside] = block_hu
        oval = (2 * p @ across / width_mm) ** 2 + (2 * p @ up / height_mm) ** 2
        hu[(oval < 1.0) & (np.abs(p @ axis) < 15.0)] = rod_hu
        return hu

    return hu_at


def scanned(hu_at: HuAt, *, spacing_mm: tuple[float, float, float], noise_hu: float, seed: int = 1) -> Volume:
    grid = ScanGrid.around(
        (0.0, -8.0, 0.0), size_mm=(60, 90, 40), spacing_mm=spacing_mm, noise_hu=noise_hu, seed=seed
    )
    # With the usual samples in a voxel, a scan takes longer than the measurement.
    return scan(hu_at, replace(grid, samples=(2, 2, 3)))
