"""Outlines of sections through bone: rays from a centre to the half-height point of the wall."""

import functools
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.geometry import Array
from tracker.plan.pedicle.neighbourhood import Neighbourhood
from tracker.plan.pedicle.wall_kernels import smooth_curves, walls_around

STEP_MM = 0.4
MAX_DISTANCE_MM = 17.0
# Maximum distance behind a wall at which its outside is sampled; beyond it another bone may begin.
MAX_BEHIND_ENTRY_MM = 2.8
HARMONICS = 4
ROUNDS = 4


@dataclass(frozen=True, slots=True, kw_only=True)
class Outlines:
    """Outlines of several sections across given directions.

    Attributes:
        centre_mm: (m, 3), LPS.
        across: (m, 3), unit, first direction in each plane.
        up: (m, 3), unit, second direction in each plane.
        radius_mm: (m, rays), to the half level of the wall; NaN where no wall was met.
        smooth_mm: (m, rays), of the smooth closed curve that fits most rays.
        found_ratio: (m,), share of the rays that met a wall on or near that curve.
        gap_deg: (m,), the widest angle without such a ray.
    """

    centre_mm: Array
    across: Array
    up: Array
    radius_mm: Array
    smooth_mm: Array
    found_ratio: Array
    gap_deg: Array

    def only(self, row: int) -> "Outlines":
        """Return one of the sections."""
        one = slice(row, row + 1)
        return Outlines(
            centre_mm=self.centre_mm[one],
            across=self.across[one],
            up=self.up[one],
            radius_mm=self.radius_mm[one],
            smooth_mm=self.smooth_mm[one],
            found_ratio=self.found_ratio[one],
            gap_deg=self.gap_deg[one],
        )

    @property
    def area_mm2(self) -> Array:
        """Return the area (m,) inside the smooth curve."""
        return np.asarray(np.pi * (self.smooth_mm**2).mean(axis=1))

    @property
    def centroid_mm(self) -> Array:
        """Return the centroid (m, 3), LPS."""
        angle = angles(self.smooth_mm.shape[1])
        cubed = self.smooth_mm**3
        weight = 1.5 * np.maximum((self.smooth_mm**2).mean(axis=1), 1e-9)
        x = (cubed * np.cos(angle)).mean(axis=1) / weight
        y = (cubed * np.sin(angle)).mean(axis=1) / weight
        return np.asarray(self.centre_mm + x[:, None] * self.across + y[:, None] * self.up)


def angles(rays: int) -> Array:
    """Return the directions (rays,) of the rays in their plane, in rad."""
    return 2.0 * np.pi * np.arange(rays) / rays


def planes_across(axis: Array) -> tuple[Array, Array]:
    """Return directions across unit axes (m, 3): nearest to the patient's left, and to the head."""
    up = np.array([0.0, 0.0, 1.0]) - axis * axis[:, 2:3]
    up /= np.linalg.norm(up, axis=1, keepdims=True)
    across = np.cross(up, axis)
    across *= np.where(across[:, :1] < 0.0, -1.0, 1.0)
    return across, up


def outlines_of(
    near: Neighbourhood, centre_mm: Array, axis: Array, *, rays: int = 24, recentred: int = 2
) -> Outlines:
    """Return outlines across unit axes (m, 3) around centres (m, 3), each recentred in its outline."""
    centre = np.array(centre_mm, dtype=np.float64)
    across, up = planes_across(axis)
    for turn in range(recentred + 1):
        radius = _wall_radius(near, centre, across, up, rays)
        smooth, near_curve = _smooth_curve(radius)
        out = Outlines(
            centre_mm=centre,
            across=across,
            up=up,
            radius_mm=radius,
            smooth_mm=smooth,
            found_ratio=near_curve.mean(axis=1),
            gap_deg=_widest_gap_deg(near_curve),
        )
        if turn < recentred:
            centre = out.centroid_mm
    return out


def _wall_radius(near: Neighbourhood, centre: Array, across: Array, up: Array, rays: int) -> Array:
    """Return the half-height distance (m, rays) of the wall from centres (m, 3); NaN if there is none."""
    angle = angles(rays)
    direction = np.cos(angle)[:, None] * across[:, None, :] + np.sin(angle)[:, None] * up[:, None, :]
    out = np.empty(direction.shape[:2])
    walls_around(
        np.ascontiguousarray(near.smooth),
        near.index_of(centre),
        near.index_step(STEP_MM * direction),
        int(np.ceil(MAX_DISTANCE_MM / STEP_MM)),
        near.min_fall_hu,
        _behind_steps(near),
        out,
    )
    return STEP_MM * out


def _behind_steps(near: Neighbourhood) -> int:
    slice_mm = float(np.linalg.norm(near.lps_from_index[:3, 2]))
    return int(np.ceil(max(MAX_BEHIND_ENTRY_MM, 1.1 * slice_mm) / STEP_MM))


def _widest_gap_deg(near_curve: npt.NDArray[np.bool_]) -> Array:
    """Return the longest run (m,) of rays without a wall on the curve, cyclic, in degrees."""
    rays = near_curve.shape[1]
    column = np.arange(2 * rays)
    on_curve = np.where(np.tile(near_curve, 2), column, -1)
    longest = (column - np.maximum.accumulate(on_curve, axis=1)).max(axis=1)
    return np.asarray(np.minimum(longest, rays) * 360.0 / rays)


def _smooth_curve(radius: Array) -> tuple[Array, npt.NDArray[np.bool_]]:
    """Return the robust Fourier fit (m, rays) of the radius, and its inlier rays (m, rays)."""
    basis, ridge = _basis(radius.shape[1])
    smooth, near_curve = np.empty_like(radius), np.empty(radius.shape, dtype=np.bool_)
    smooth_curves(radius, basis, ridge, ROUNDS, MAX_DISTANCE_MM, smooth, near_curve)
    return smooth, near_curve


@functools.cache
def _basis(rays: int) -> tuple[Array, Array]:
    """Return the Fourier basis at the rays (rays, waves), and the ridge of each wave (waves,)."""
    angle = angles(rays)
    columns, ridge = [np.ones(rays)], [1e-6]
    for n in range(1, HARMONICS + 1):
        columns += [np.cos(n * angle), np.sin(n * angle)]
        ridge += 2 * [0.02 * rays * n**2 / 40.0]
    return np.stack(columns, axis=1), np.array(ridge)
