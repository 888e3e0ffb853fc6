"""Side of a pedicle, from the canal and the vertebral body beside it."""

import numpy as np

from tracker.geometry import Array
from tracker.plan.pedicle.neighbourhood import Neighbourhood

STEP_MM = 0.5
CANAL_MM = (8.0, 34.0)
MAX_VIEW_DEPTH_MM = 48.0
BODY_AHEAD_MM = (16.0, 20.0, 24.0, 28.0)
CLEARLY_MM = 8.0
AIR_HU = -300.0


def canal_side(near: Neighbourhood, isthmus_mm: Array, left: Array, half_width_mm: float, up: Array) -> int:
    """Return +1 if the canal lies to the patient's left, -1 to the right, 0 if undetermined.

    On the canal's side a gap as wide as a canal is followed by bone: the other pedicle.
    """
    ways = [way for way in (1, -1) if _is_canal(near, isthmus_mm, way * left, half_width_mm, up)]
    return ways[0] if len(ways) == 1 else 0


def body_side(near: Neighbourhood, isthmus_mm: Array, axis: Array, left: Array) -> int:
    """Return +1 if the body extends further to the patient's left of the axis, -1 to the right, else 0."""
    apart = []
    for ahead in BODY_AHEAD_MM:
        point = isthmus_mm + ahead * axis
        reach = [_bone_reach_mm(near, point, way * left) for way in (1, -1)]
        apart.append(reach[0] - reach[1])
    difference = float(np.median(apart))
    if abs(difference) < CLEARLY_MM:
        return 0
    return 1 if difference > 0 else -1


def _profile(near: Neighbourhood, point: Array, direction: Array) -> Array:
    line = point + np.arange(0.0, MAX_VIEW_DEPTH_MM, STEP_MM)[:, None] * direction
    inside = near.contains(line)
    return np.where(inside, near.smooth_hu(line), -1024.0)


def _is_canal(near: Neighbourhood, isthmus: Array, way: Array, half_width_mm: float, up: Array) -> bool:
    votes = 0
    for lift in (-2.0, 0.0, 2.0):
        profile = _profile(near, isthmus + lift * up + (half_width_mm + 1.0) * way, way)
        bone = np.flatnonzero(profile > near.bone_above_hu)
        # The wall itself may still be bright for a millimetre or two.
        beyond = bone[bone > 2.0 / STEP_MM]
        if not len(beyond):
            continue
        gap = float(beyond[0]) * STEP_MM
        air = bool((profile[: beyond[0]] < AIR_HU).any())
        votes += CANAL_MM[0] <= gap <= CANAL_MM[1] and not air
    return votes >= 2


def _bone_reach_mm(near: Neighbourhood, point: Array, way: Array) -> float:
    """Return the extent of the body, up to the last bone before a gap wider than marrow."""
    bone = np.flatnonzero(_profile(near, point, way) > near.bone_above_hu)
    return float(bone[-1]) * STEP_MM if len(bone) else 0.0
