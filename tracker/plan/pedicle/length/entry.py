"""Screw entry: the posterior surface of the arch around the axis, not the tip of a process."""

import numpy as np
import scipy

from tracker.geometry import Array
from tracker.plan.pedicle.outlines import planes_across
from tracker.plan.pedicle.solid import Solid

# Radius of the disc around the axis, between those of a process and of the arch.
DISC_MM, GRID_MM, STEP_MM, MAX_DISTANCE_MM = 10.0, 0.5, 0.5, 34.0
# The face lies where half of the disc is bone, independent of its tilt.
FACE_SHARE = 0.5


def arch_back_mm(solid: Solid, isthmus_mm: Array, axis: Array) -> float | None:
    """Return the distance in mm from the isthmus to the posterior end of the bone around the axis, or None.

    The area of sections across the axis, within 10 mm of it, increases from the isthmus into the arch, and
    falls to half of its maximum at the arch's posterior surface. A process around the axis is narrower, and
    is excluded. None where the bone on the axis itself ends before: without a process, or in marrow that is
    missing in the solid.
    """
    area = _areas_mm2(solid, isthmus_mm, axis)
    if not len(area):
        return None
    widest = int(np.argmax(area))
    limit = FACE_SHARE * area[widest]
    below = np.flatnonzero(area[widest:] < limit)
    if not len(below):
        return None
    row = widest + int(below[0])
    share = (area[row - 1] - limit) / max(area[row - 1] - area[row], 1e-9)
    return (row - 1 + float(share)) * STEP_MM


def _areas_mm2(solid: Solid, isthmus_mm: Array, axis: Array) -> Array:
    """Return the area (n,) of the bone that contains the axis in each section, up to where it ends."""
    (across,), (up,) = planes_across(axis[None])
    grid = np.arange(-DISC_MM, DISC_MM + 0.1, GRID_MM)
    x, y = np.meshgrid(grid, grid)
    disc = np.hypot(x, y) <= DISC_MM
    middle = len(grid) // 2
    plane = isthmus_mm + x[..., None] * across + y[..., None] * up
    along = np.arange(0.0, MAX_DISTANCE_MM, STEP_MM)
    bone = solid.depth_at(plane - along[:, None, None, None] * axis) > 0.0
    ends = np.flatnonzero(~bone[:, middle, middle])
    area = []
    for section in bone[: ends[0] if len(ends) else None]:
        label, _ = scipy.ndimage.label(section)
        area.append(float(((label == label[middle, middle]) & disc).sum()) * GRID_MM**2)
    return np.array(area)
