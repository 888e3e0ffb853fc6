"""A CT of an ellipsoidal bone with known surface: each voxel contains its fraction of bone."""

from dataclasses import dataclass
from functools import cache

import numpy as np
import numpy.typing as npt

from tracker.geometry import rotation_from_vector
from tracker.plan import Volume

SOFT_HU, BONE_HU = 40.0, 640.0
HALF_HU = (SOFT_HU + BONE_HU) / 2.0
Array = npt.NDArray[np.float64]


@dataclass(frozen=True, kw_only=True)
class Ellipsoid:
    centre_lps_mm: tuple[float, float, float] = (12.0, -230.0, 950.0)
    half_axes_mm: tuple[float, float, float] = (14.0, 10.0, 8.0)

    def level(self, points: Array) -> Array:
        """Below 1 inside."""
        return np.asarray(np.linalg.norm((points - self.centre_lps_mm) / self.half_axes_mm, axis=-1))

    def distances_mm(self, points: Array) -> Array:
        """Signed, above 0 outside; true to first order, which near the surface is enough."""
        scaled = (points - self.centre_lps_mm) / self.half_axes_mm
        level = np.linalg.norm(scaled, axis=-1)
        slope = np.linalg.norm(scaled / self.half_axes_mm, axis=-1) / level
        return np.asarray((level - 1.0) / slope)

    @property
    def volume_ml(self) -> float:
        return float(4.0 / 3.0 * np.pi * np.prod(self.half_axes_mm) / 1000.0)


def affine_of(
    *,
    spacing: tuple[float, float, float] = (0.5, 0.5, 1.0),
    turn: tuple[float, float, float] = (0.0, 0.0, 0.0),
    shear: float = 0.0,
    mirrored: bool = False,
    shape_ijk: tuple[int, int, int] = (72, 60, 28),
    centre_lps_mm: tuple[float, float, float] = (12.0, -230.0, 950.0),
) -> Array:
    """Of a stack whose middle is at the centre; `shear` is the gantry's tilt, mm along j for a mm along k."""
    columns = np.diag(spacing).astype(np.float64)
    columns[1, 2] += shear * spacing[2]
    if mirrored:
        columns[:, 0] *= -1.0
    affine = np.eye(4)
    affine[:3, :3] = rotation_from_vector(np.array(turn)) @ columns
    affine[:3, 3] = np.array(centre_lps_mm) - affine[:3, :3] @ ((np.array(shape_ijk) - 1) / 2.0)
    return affine


def scanned(
    bodies: tuple[Ellipsoid, ...],
    affine: Array,
    *,
    shape_ijk: tuple[int, int, int] = (72, 60, 28),
    noise_hu: float = 0.0,
    fine: int = 4,
) -> Volume:
    """Each voxel is the mean of `fine`^3 points in it."""
    return _scanned(bodies, affine.tobytes(), shape_ijk, noise_hu, fine)


@cache
def _scanned(
    bodies: tuple[Ellipsoid, ...],
    affine_bytes: bytes,
    shape_ijk: tuple[int, int, int],
    noise_hu: float,
    fine: int,
) -> Volume:
    affine = np.frombuffer(affine_bytes).reshape(4, 4)
    columns, rows, slices = shape_ijk
    k, j, i = np.meshgrid(np.arange(slices), np.arange(rows), np.arange(columns), indexing="ij")
    index = np.stack([i, j, k], axis=-1).astype(np.float64)
    centres = index @ affine[:3, :3].T + affine[:3, 3]
    levels = [body.level(centres) for body in bodies]
    inside = np.any([level < 1.0 for level in levels], axis=0) * float(fine**3)
    # No wall passes through a voxel that is farther from each than half its diagonal.
    half_mm = 0.5 * float(np.abs(affine[:3, :3]).sum())
    near = np.any(
        [
            np.abs(level - 1.0) < half_mm / min(body.half_axes_mm)
            for level, body in zip(levels, bodies, strict=True)
        ],
        axis=0,
    )
    steps = (np.arange(fine) + 0.5) / fine - 0.5
    inside[near] = 0.0
    for offset in np.stack(np.meshgrid(steps, steps, steps), axis=-1).reshape(-1, 3):
        points = centres[near] + affine[:3, :3] @ offset
        inside[near] += np.any([body.level(points) < 1.0 for body in bodies], axis=0)
    hu = SOFT_HU + (BONE_HU - SOFT_HU) * inside / fine**3
    hu += np.random.default_rng(5).normal(0.0, noise_hu, hu.shape)
    return Volume(hu=np.rint(hu).astype(np.int16), lps_from_ijk=affine)
