"""The bone's back: the surface through which a drill comes in, as it is seen along the channel.

A drill enters through the bone's back, so only the other walls warn. Places of the drill count from the
back as it is seen along the channel, or from 7 mm past the entry where there is none. A side wall seen
under less than 75 degrees from behind is therefore no wall.
"""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.geometry import Array
from tracker.navigation.clearance.inside import Flags, Grid
from tracker.navigation.directions import Directions

# Within this of the channel's axis the drill is at its pedicle; beyond, it is nowhere near its plan.
REACH_MM = 20.0
STEP_MM = 0.5
# A drill that has met no bone so deep past the entry has slipped off it. Where the bone's own back lies
# deeper, at the root of a transverse process, it is the plan's entry that is shallow.
SLIPPED_MM = 5.0
# What lies further behind the entry, as the joint of the vertebra above, does not cover it.
BEHIND_MM = 3.0
SEEN_MM = 25.0
MARCH_MM = 0.25
# A surface seen under a flatter angle (75 degrees) is a wall, not a back.
FACES_BACK = -0.25
SAME_MM = 1.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Back:
    """How deep the bone's back lies around the entry, along the channel.

    Attributes:
        floor_mm: (n, n) float64; from the entry plane to the bone, at least 0 and at most `SLIPPED_MM`; rows
            from lateral to medial, columns from foot to head, the entry in the middle.
        step_mm: from node to node.
    """

    floor_mm: Array
    step_mm: float


def flat_back() -> Back:
    """The entry plane itself, where no surface is known."""
    size = 2 * round(REACH_MM / STEP_MM) + 1
    floor = np.zeros((size, size))
    floor.setflags(write=False)
    return Back(floor_mm=floor, step_mm=STEP_MM)


def back_of(
    bone: Flags, grid: Grid, entry_mm: Array, across: Directions, corners: Array
) -> tuple[Back, Flags]:
    """The bone's back, and which of the triangles (m, 3, 3) in mm belong to it."""
    places = np.arange(-REACH_MM, REACH_MM + 1e-9, STEP_MM)
    u, v = np.meshgrid(places, places, indexing="ij")
    start = entry_mm + u[..., None] * across.medial + v[..., None] * across.cranial
    depths = np.arange(-SEEN_MM, SLIPPED_MM + SAME_MM + 1e-9, MARCH_MM)
    hit = bone[grid.nearest(start[None] + depths[:, None, None, None] * across.axis)]
    seen = _first(hit, depths)
    near = depths >= -BEHIND_MM
    entered = _first(hit[near], depths[near])
    floor = np.clip(entered, 0.0, SLIPPED_MM)
    floor.setflags(write=False)
    return Back(floor_mm=floor, step_mm=STEP_MM), _belong(corners, entry_mm, across, (seen, entered))


def _first(hit: Flags, depths: Array) -> Array:
    return np.where(hit.any(axis=0), depths[hit.argmax(axis=0)], np.inf)


def _belong(corners: Array, entry_mm: Array, across: Directions, maps: tuple[Array, ...]) -> Flags:
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-12)
    middle = corners.mean(axis=1) - entry_mm
    row, column = (_places(middle @ way) for way in (across.medial, across.cranial))
    size = len(maps[0])
    held = (row >= 0) & (column >= 0) & (row < size) & (column < size)
    row, column = np.clip(row, 0, size - 1), np.clip(column, 0, size - 1)
    depth = middle @ across.axis
    on_map = np.any([np.abs(depth - one[row, column]) < SAME_MM for one in maps], axis=0)
    return np.asarray(held & on_map & (normal @ across.axis < FACES_BACK))


def _places(along: Array) -> npt.NDArray[np.int64]:
    return np.rint((along + REACH_MM) / STEP_MM).astype(np.int64)
