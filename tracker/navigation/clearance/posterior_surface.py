"""The posterior surface of the bone, through which a drill enters, as seen along the channel.

A drill enters through it, so only the other walls count for the clearance. Points of the drill count if they
are deeper than the visible posterior surface, or than 7 mm past the entry if there is none. A side wall whose
normal is within 75 degrees of the view direction is therefore not monitored.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.geometry import Array
from tracker.navigation.clearance.voxels import Flags, Grid
from tracker.navigation.directions import Directions

# Maximum distance from the channel's axis at which the drill is at this pedicle.
REACH_MM = 20.0
STEP_MM = 0.5
# A drill that is deeper past the entry without bone has slipped off it. If the posterior surface is deeper,
# as at the root of a transverse process, the planned entry is too shallow.
MAX_ENTRY_DEPTH_MM = 5.0
# Surfaces farther behind the entry, as the facet joint of the vertebra above, do not count.
MAX_BEHIND_ENTRY_MM = 3.0
MAX_VIEW_DEPTH_MM = 25.0
RAY_STEP_MM = 0.25
# A surface seen at a flatter angle (75 degrees) is a wall and not the posterior surface.
MAX_POSTERIOR_COSINE = -0.25
SAME_MM = 1.0


@dataclass(frozen=True, slots=True, kw_only=True)
class PosteriorSurface:
    """Depth map of the posterior surface around the entry, along the channel.

    Attributes:
        floor_mm: (n, n) float64; from the entry plane to the bone, clipped to 0..`MAX_ENTRY_DEPTH_MM`; rows
            from lateral to medial, columns from caudal to cranial, centred on the entry.
        step_mm: grid spacing.
    """

    floor_mm: Array
    step_mm: float


def flat_posterior_surface() -> PosteriorSurface:
    """Return the entry plane, for an unknown surface."""
    size = 2 * round(REACH_MM / STEP_MM) + 1
    floor = np.zeros((size, size))
    floor.setflags(write=False)
    return PosteriorSurface(floor_mm=floor, step_mm=STEP_MM)


def find_posterior_surface(
    bone: Flags, grid: Grid, entry_mm: Array, across: Directions, corners: Array
) -> tuple[PosteriorSurface, Flags]:
    """Return the posterior surface by ray marching, and which triangles (m, 3, 3) in mm belong to it."""
    places = np.arange(-REACH_MM, REACH_MM + 1e-9, STEP_MM)
    u, v = np.meshgrid(places, places, indexing="ij")
    start = entry_mm + u[..., None] * across.medial + v[..., None] * across.cranial
    depths = np.arange(-MAX_VIEW_DEPTH_MM, MAX_ENTRY_DEPTH_MM + SAME_MM + 1e-9, RAY_STEP_MM)
    hit = bone[grid.nearest(start[None] + depths[:, None, None, None] * across.axis)]
    seen = _first(hit, depths)
    near = depths >= -MAX_BEHIND_ENTRY_MM
    entered = _first(hit[near], depths[near])
    floor = np.clip(entered, 0.0, MAX_ENTRY_DEPTH_MM)
    floor.setflags(write=False)
    return PosteriorSurface(floor_mm=floor, step_mm=STEP_MM), _belong(
        corners, entry_mm, across, (seen, entered)
    )


def _first(hit: Flags, depths: Array) -> Array:
    return np.where(hit.any(axis=0), depths[hit.argmax(axis=0)], np.inf)


def _belong(corners: Array, entry_mm: Array, across: Directions, maps: tuple[Array, ...]) -> Flags:
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-12)
    middle = corners.mean(axis=1) - entry_mm
    row, column = (_places(middle @ direction) for direction in (across.medial, across.cranial))
    size = len(maps[0])
    in_grid = (row >= 0) & (column >= 0) & (row < size) & (column < size)
    row, column = np.clip(row, 0, size - 1), np.clip(column, 0, size - 1)
    depth = middle @ across.axis
    on_map = np.any([np.abs(depth - one[row, column]) < SAME_MM for one in maps], axis=0)
    return np.asarray(in_grid & on_map & (normal @ across.axis < MAX_POSTERIOR_COSINE))


def _places(along: Array) -> npt.NDArray[np.int64]:
    return np.rint((along + REACH_MM) / STEP_MM).astype(np.int64)
