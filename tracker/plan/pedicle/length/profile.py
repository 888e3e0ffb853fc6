"""HU profiles along a line through bone, and detection of wall edges in them."""

import numpy as np

from tracker.geometry import Array
from tracker.plan.pedicle.neighbourhood import Neighbourhood
from tracker.plan.pedicle.outlines import planes_across

STEP_MM = 0.2
MAX_DISTANCE_MM = 64.0
MAX_BEHIND_ENTRY_MM = 2.6
DISC_OFFSETS_MM: Array = 0.9 * np.array([[0.0, 0.0], [1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]])


def profile_along(near: Neighbourhood, start_mm: Array, direction: Array) -> Array:
    """Return the mean HU over a small disc along the line, every `STEP_MM`, within the CT."""
    steps = np.arange(0.0, MAX_DISTANCE_MM, STEP_MM)
    line = start_mm + steps[:, None] * direction
    inside = near.contains(line)
    count = len(steps) if inside.all() else int(np.argmin(inside))
    (across,), (up,) = planes_across(direction[None])
    shifted = line[None] + (DISC_OFFSETS_MM @ np.stack([across, up]))[:, None, :]
    return np.asarray(near.smooth_hu(shifted).mean(axis=0)[:count])


def behind_steps(near: Neighbourhood, direction: Array) -> int:
    """Return the distance behind a wall at which its outside is sampled, in steps; over one voxel."""
    return int(max(MAX_BEHIND_ENTRY_MM, float(near.voxel_width_mm(direction).max())) / STEP_MM)


def falls(near: Neighbourhood, profile: Array, *, min_hu: float, behind: int) -> list[tuple[float, float]]:
    """Return the half-height distance of each fall of at least this much, in mm, and the HU behind it."""
    found: list[tuple[float, float]] = []
    top = 0
    at = 1
    while at < len(profile):
        if profile[at] > profile[top]:
            top = at
        elif profile[top] - profile[at] >= min_hu:
            end = _foot(profile, at + int(np.argmin(profile[at : at + behind + 1])), near.soft_below_hu)
            half = 0.5 * (profile[top] + profile[end])
            after = top + int(np.argmax(profile[top : end + 1] < half))
            share = (profile[after - 1] - half) / max(profile[after - 1] - profile[after], 1e-9)
            found.append(((after - 1 + float(share)) * STEP_MM, float(profile[end])))
            top = at = end
        at += 1
    return found


def _foot(profile: Array, at: int, soft_below_hu: float) -> int:
    """Return where a fall from bone ends; a wall met obliquely falls over more than one voxel."""
    while at + 1 < len(profile) and profile[at] > soft_below_hu and profile[at + 1] < profile[at]:
        at += 1
    return at
