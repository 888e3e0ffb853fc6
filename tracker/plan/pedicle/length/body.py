"""Outline of the vertebral body around the axis, to separate an adjacent vessel from bone."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.geometry import Array
from tracker.plan.pedicle.neighbourhood import Neighbourhood
from tracker.plan.pedicle.outlines import planes_across

# At this distance ahead of the isthmus the axis is inside the body, even in small vertebrae.
CENTRE_MM = 20.0
REACH_DEG, TURN_DEG = 72.0, 4.0
STEP_MM, MIN_MM, MAX_MM = 0.5, 3.0, 46.0
EDGE_MM, LIFTS_MM = 1.5, (-1.5, 0.0, 1.5)
# Weight of an edge, relative to the decrease of HU at a typical wall; higher with soft tissue outside.
FAINT_EDGE, MIN_EDGE, MAX_EDGE, SOFT_BONUS = 0.3, 0.5, 1.5, 0.3
MAX_STEPS, STEP_COST = 4, 0.15
SLOPE_ANGLES = 3
# Angles on both sides of the axis between which a chord of the outline is drawn, in steps of `TURN_DEG`.
CHORD_ANGLES = range(5, 11)


@dataclass(frozen=True, slots=True, kw_only=True)
class OutlineFront:
    """Intersection of the body's outline with the axis.

    Attributes:
        distance_mm: from the isthmus; None if no wall is visible on the axis.
        outwards: unit (3,), the outline's normal there, in its plane.
        chord_mm: distance of the outermost chord between both sides of the axis. The front wall of a convex
            body does not lie behind it.
    """

    distance_mm: float | None
    outwards: Array
    chord_mm: float


def outline_front(near: Neighbourhood, isthmus_mm: Array, axis: Array) -> OutlineFront:
    """Return the anterior wall from the body's outline.

    Rays run forwards and sideways from a point in the body, in the plane of the axis that is nearest to
    axial. The outline is the path over these rays with the strongest outer edges and the smallest steps
    (dynamic programming).
    Where a vessel touches the body, it still follows the wall: the vessel's far side is a step of its width.
    """
    (across,), (up,) = planes_across(axis[None])
    edge, usable = _edges(near, isthmus_mm + CENTRE_MM * axis, axis, across, up)
    middle = len(edge) // 2
    path = _path(edge)
    row = int(path[middle])
    is_visible = bool(usable[middle].any()) and edge[middle, row] >= MIN_EDGE
    radius = MIN_MM + STEP_MM * path[middle - SLOPE_ANGLES : middle + SLOPE_ANGLES + 1]
    turn = np.radians(TURN_DEG) * np.arange(-SLOPE_ANGLES, SLOPE_ANGLES + 1)
    slope = float((turn * radius).sum() / (turn**2).sum())
    outwards = radius[SLOPE_ANGLES] * axis - slope * across
    return OutlineFront(
        distance_mm=CENTRE_MM + MIN_MM + row * STEP_MM if is_visible else None,
        outwards=outwards / np.linalg.norm(outwards),
        chord_mm=CENTRE_MM + _outermost_chord_mm(edge, path),
    )


def _outermost_chord_mm(edge: Array, path: Array) -> float:
    """Return where the outermost chord of the path crosses the middle ray; 0 without walls on both sides."""
    middle = len(path) // 2
    radius = MIN_MM + STEP_MM * path
    is_clear = edge[np.arange(len(path)), path] >= MIN_EDGE
    chords = [
        2.0 * np.cos(np.radians(TURN_DEG * n)) / (1.0 / radius[middle - n] + 1.0 / radius[middle + n])
        for n in CHORD_ANGLES
        if is_clear[middle - n] and is_clear[middle + n]
    ]
    return max(chords, default=0.0)


def _edges(
    near: Neighbourhood, centre: Array, axis: Array, across: Array, up: Array
) -> tuple[Array, npt.NDArray[np.bool_]]:
    """Return the edge strength of each place (angles, distances), and whether it lies in the CT."""
    angle = np.radians(np.arange(-REACH_DEG, REACH_DEG + 0.1, TURN_DEG))
    ways = np.cos(angle)[:, None] * axis + np.sin(angle)[:, None] * across
    voxel = float(np.linalg.norm(near.voxel_width_mm(axis)))
    wide = round(max(EDGE_MM, 0.8 * voxel) / STEP_MM)
    distance = MIN_MM + STEP_MM * np.arange(-wide, int((MAX_MM - MIN_MM) / STEP_MM) + wide)
    points = centre + distance[:, None] * ways[:, None, :]
    hu = np.mean([near.smooth_hu(points + lift * up) for lift in LIFTS_MM], axis=0)
    total = np.cumsum(np.concatenate([np.zeros((len(hu), 1)), hu], axis=1), axis=1)
    mean = (total[:, wide:] - total[:, :-wide]) / wide
    inside, outside = mean[:, : -wide - 1], mean[:, wide + 1 :]
    usable = near.contains(points)[:, wide : wide + inside.shape[1]]
    edge = np.clip((inside - outside) / near.min_fall_hu, 0.0, MAX_EDGE)
    edge = np.where(edge > FAINT_EDGE, edge + np.where(outside < near.soft_below_hu, SOFT_BONUS, 0.0), edge)
    return np.where(usable & (inside > near.soft_below_hu), edge, 0.0), usable


def _path(edge: Array) -> Array:
    """Return the row (angles,) of the path with maximum edge strength and minimum steps between angles."""
    best, came = edge[0], []
    shifts = np.arange(-MAX_STEPS, MAX_STEPS + 1)
    for column in edge[1:]:
        padded = np.pad(best, MAX_STEPS, constant_values=-np.inf)
        choices = np.stack([padded[MAX_STEPS + s : MAX_STEPS + s + len(best)] for s in shifts])
        choices -= STEP_COST * np.abs(shifts)[:, None]
        way = np.argmax(choices, axis=0)
        came.append(shifts[way])
        best = choices[way, np.arange(len(best))] + column
    path = [int(np.argmax(best))]
    for moved in reversed(came):
        path.append(path[-1] + int(moved[path[-1]]))
    return np.array(path[::-1])
