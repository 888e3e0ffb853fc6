"""Along the pedicle's axis: where it enters the bone from behind, and where it leaves the body in front."""

from dataclasses import dataclass

import numpy as np

from tracker.geometry import Array
from tracker.plan.pedicle.neighbourhood import Neighbourhood
from tracker.plan.pedicle.outlines import planes_across

STEP_MM = 0.2
FARTHEST_MM = 64.0
BEFORE_MM, BEHIND_MM = 4.0, 2.6
# Nearer to the isthmus no front wall lies; an inner end of dense bone may.
FRONT_FROM_MM, FRONT_USUALLY_FROM_MM = 8.0, 15.0
ENTRY_FROM_MM = 2.0
DISC_MM = 0.9


@dataclass(frozen=True, slots=True, kw_only=True)
class WallAhead:
    """The first outer wall in one direction.

    Attributes:
        distance_mm: from the isthmus.
        found: whether a wall was met; if not, the bone goes on to this distance at least.
    """

    distance_mm: float
    found: bool


def outside_limit_hu(near: Neighbourhood) -> float:
    """Below this number lies what is soft."""
    return near.tissue_hu + max(60.0, 0.12 * (near.cortex_hu - near.tissue_hu))


def front_wall(near: Neighbourhood, isthmus_mm: Array, axis: Array) -> WallAhead:
    """Where the axis leaves the body in front."""
    falls, reached = _falls(near, isthmus_mm, axis)
    for least in (FRONT_USUALLY_FROM_MM, FRONT_FROM_MM):
        beyond = falls[falls >= least]
        if len(beyond):
            return WallAhead(distance_mm=float(beyond[0]), found=True)
    return WallAhead(distance_mm=reached, found=False)


def back_wall(near: Neighbourhood, isthmus_mm: Array, axis: Array) -> WallAhead:
    """Where the axis, followed backwards, leaves the arch: the entry."""
    falls, reached = _falls(near, isthmus_mm, -axis)
    beyond = falls[falls >= ENTRY_FROM_MM]
    if len(beyond):
        return WallAhead(distance_mm=float(beyond[0]), found=True)
    return WallAhead(distance_mm=reached, found=False)


def _falls(near: Neighbourhood, isthmus_mm: Array, direction: Array) -> tuple[Array, float]:
    """Distances at which bone ends in something soft, and how far the CT reaches."""
    steps = np.arange(0.0, FARTHEST_MM, STEP_MM)
    line = isthmus_mm + steps[:, None] * direction
    inside = near.holds(line)
    count = len(steps) if inside.all() else int(np.argmin(inside))
    (across,), (up,) = planes_across(direction[None] if abs(direction[2]) < 0.99 else np.array([[0.0, -1.0, 0.0]]))
    offsets = DISC_MM * np.array([[0.0, 0.0], [1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]])
    shifted = line[None] + (offsets[:, :1] * across + offsets[:, 1:] * up)[:, None, :]
    profile = near.smooth_hu(shifted).mean(axis=0)[:count]
    limit = outside_limit_hu(near)
    slice_mm = float(near.voxel_width_mm(direction).max())
    before = int(BEFORE_MM / STEP_MM)
    behind = int(max(BEHIND_MM, slice_mm) / STEP_MM)
    found = []
    for at in np.flatnonzero((profile[:-1] >= limit) & (profile[1:] < limit)) if count > 1 else ():
        first = max(at - before, 0)
        peak = float(profile[first : at + 1].max())
        trough = float(profile[at + 1 : at + 1 + behind].min())
        if peak - trough < near.least_fall_hu:
            continue
        half = 0.5 * (peak + trough)
        top = first + int(np.argmax(profile[first : at + 1]))
        below = np.flatnonzero(profile[top:] < half)
        if len(below) and below[0] > 0:
            after = top + int(below[0])
            share = (profile[after - 1] - half) / max(profile[after - 1] - profile[after], 1e-9)
            found.append((after - 1 + share) * STEP_MM)
    return np.array(found), float(steps[max(count - 1, 0)])
