"""Along the pedicle's axis: where it enters the bone from behind, and where it leaves the body in front."""

from dataclasses import dataclass

import numpy as np

from tracker.geometry import Array
from tracker.plan.pedicle.neighbourhood import Neighbourhood
from tracker.plan.pedicle.outlines import angles, planes_across
from tracker.plan.pedicle.solid import Solid

STEP_MM = 0.2
FARTHEST_MM = 64.0
BEHIND_MM = 2.6
# Nearer to the isthmus no front wall lies.
FRONT_FROM_MM, ENTRY_FROM_MM = 8.0, 2.0
# From here on a wall may border on something that is not soft, as a vessel with contrast.
VESSEL_FROM_MM = 24.0
DISC_MM = 0.9
# Behind a true outer wall most directions across the axis meet no bone soon.
GAP_BEYOND_MM = 2.0
LOOK_BEYOND_MM, LOOK_ACROSS_MM, LOOK_RAYS, ENCLOSED_RATIO = 4.0, 32.0, 16, 0.85


# Where the solid ends, the wall is the fall of the profile that is so near to it.
NEAR_EXIT_MM = 4.0
# Where bone and vessel have grown together in the solid, their joint is shallow, and far ahead.
MARROW_MM, DENSE_HU, SOFT_MM = (8.0, 24.0), 40.0, 3.0
NECK_FROM_MM, NECK_MM = 24.0, 3.0
# Deeper outside than this the line has left the bone, and not only passed a gap in its wall.
LEFT_MM = 1.0


@dataclass(frozen=True, slots=True, kw_only=True)
class WallAhead:
    """The outer wall in one direction.

    Attributes:
        distance_mm: from the isthmus.
        found: whether a wall was met; if not, the bone goes on to this distance at least.
        outwards: unit (3,), the wall's normal; the direction itself where no wall was met.
        faced_ratio: cosine between direction and normal: 1 where the wall is met squarely, 0 along it.
    """

    distance_mm: float
    found: bool
    outwards: Array
    faced_ratio: float


def outside_limit_hu(near: Neighbourhood) -> float:
    """Below this number lies what is soft."""
    return near.tissue_hu + max(60.0, 0.12 * (near.cortex_hu - near.tissue_hu))


def bone_limit_hu(near: Neighbourhood) -> float:
    """Above this number lies what is surely bone, where metal and contrast are left aside."""
    return near.tissue_hu + max(120.0, 0.4 * (near.cortex_hu - near.tissue_hu))


def front_wall(near: Neighbourhood, solid: Solid, isthmus_mm: Array, axis: Array) -> WallAhead:
    """Where the axis leaves the body in front, perhaps towards a vessel with contrast."""
    return _wall(near, solid, isthmus_mm, axis, FRONT_FROM_MM, VESSEL_FROM_MM)


def back_wall(near: Neighbourhood, solid: Solid, isthmus_mm: Array, axis: Array) -> WallAhead:
    """Where the axis, followed backwards, leaves the arch: the entry."""
    return _wall(near, solid, isthmus_mm, -axis, ENTRY_FROM_MM, np.inf)


def _wall(
    near: Neighbourhood, solid: Solid, isthmus_mm: Array, direction: Array, from_mm: float, vessel_mm: float
) -> WallAhead:
    """Where the filled solid ends, to the fall of the profile there; where it does not, the profile alone.

    What is soft and closed in, as marrow, belongs to the solid, so that no gap within the body ends it.
    """
    exit_mm = _exit_mm(solid, isthmus_mm, direction, from_mm)
    soft_mm = _soft_from_mm(near, _profile(near, isthmus_mm, direction))
    if soft_mm is not None and (exit_mm is None or soft_mm < exit_mm - NEAR_EXIT_MM):
        exit_mm = soft_mm
    distance, found = _outer_wall(near, isthmus_mm, direction, from_mm, vessel_mm)
    if exit_mm is not None and not (found and _is_neck(solid, isthmus_mm, direction, distance, exit_mm)):
        found = bool(near.holds(isthmus_mm + (exit_mm + 1.0) * direction))
        distance = _fall_near(near, isthmus_mm, direction, exit_mm)
    if not found:
        # Nothing is told surely: the nearer place is the safer one for a screw.
        falls = [one for one, _ in _falls(_profile(near, isthmus_mm, direction), near.least_fall_hu, 1)]
        distance = min([one for one in falls if one >= NECK_FROM_MM], default=distance)
    outwards = solid.outwards_at(isthmus_mm + distance * direction) if found else direction
    return WallAhead(
        distance_mm=distance, found=found, outwards=outwards, faced_ratio=float(outwards @ direction)
    )


def _soft_from_mm(near: Neighbourhood, profile: Array) -> float | None:
    """Where a body of dense marrow gives way to something soft for longer than a gap in it; else None.

    A vessel with a hard wall belongs to the filled solid as marrow does, but blood is softer than marrow.
    """
    marrow = profile[int(MARROW_MM[0] / STEP_MM) : int(MARROW_MM[1] / STEP_MM)]
    limit = outside_limit_hu(near)
    if not len(marrow) or float(np.median(marrow)) < limit + DENSE_HU:
        return None
    length = int(SOFT_MM / STEP_MM)
    soft = (profile < limit)[int(NECK_FROM_MM / STEP_MM) :]
    runs = np.flatnonzero(np.convolve(soft, np.ones(length), mode="valid") > length - 0.5)
    return NECK_FROM_MM + float(runs[0]) * STEP_MM if len(runs) else None


def _is_neck(solid: Solid, isthmus_mm: Array, direction: Array, at_mm: float, exit_mm: float) -> bool:
    """Whether a wall well before the solid's end is one all the same: bone and a vessel grown together."""
    depth = float(solid.depth_at((isthmus_mm + at_mm * direction)[None])[0])
    return at_mm < exit_mm - NEAR_EXIT_MM and at_mm > NECK_FROM_MM and depth < NECK_MM


def _exit_mm(solid: Solid, isthmus_mm: Array, direction: Array, from_mm: float) -> float | None:
    """Where the line leaves the solid for good, or None where it does not within the grid."""
    along = np.arange(from_mm, FARTHEST_MM, STEP_MM)
    line = isthmus_mm + along[:, None] * direction
    depth = solid.depth_at(line)[solid.holds(line)]
    left = np.flatnonzero(depth < -LEFT_MM)
    inside = np.flatnonzero(depth[: left[0]] > 0.0) if len(left) else left
    return float(along[inside[-1]]) if len(inside) else None


def _fall_near(near: Neighbourhood, isthmus_mm: Array, direction: Array, exit_mm: float) -> float:
    """The fall of the profile nearest to where the solid ends; the end itself where there is none."""
    profile = _profile(near, isthmus_mm, direction)
    behind = int(max(BEHIND_MM, float(near.voxel_width_mm(direction).max())) / STEP_MM)
    for share in (1.0, 0.5):
        falls = [one for one, _ in _falls(profile, share * near.least_fall_hu, behind)]
        close = [one for one in falls if abs(one - exit_mm) <= NEAR_EXIT_MM]
        if close:
            return min(close, key=lambda one: abs(one - exit_mm))
    return exit_mm


def _outer_wall(
    near: Neighbourhood, isthmus_mm: Array, direction: Array, from_mm: float, vessel_from_mm: float
) -> tuple[float, bool]:
    """The first fall behind which the line is no longer enclosed by bone.

    Dense layers inside the bone fall to marrow, which can be as dark as muscle; but there walls stand around.
    Where no fall is as deep as a wall's, half of that is taken: bone without a shell.
    """
    profile = _profile(near, isthmus_mm, direction)
    limit = outside_limit_hu(near)
    behind = int(max(BEHIND_MM, float(near.voxel_width_mm(direction).max())) / STEP_MM)
    for share in (1.0, 0.5):
        for distance_mm, trough in _falls(profile, share * near.least_fall_hu, behind):
            if distance_mm < from_mm or (trough > limit and distance_mm < vessel_from_mm):
                continue
            # In a narrow gap before a vessel the nearer look sees that nothing stands around.
            looks = (LOOK_BEYOND_MM,) if trough > limit else (GAP_BEYOND_MM, LOOK_BEYOND_MM)
            points = [isthmus_mm + (distance_mm + look_mm) * direction for look_mm in looks]
            if not all(_is_enclosed(near, point, direction) for point in points):
                return distance_mm, True
    return max(len(profile) - 1, 0) * STEP_MM, False


def _profile(near: Neighbourhood, isthmus_mm: Array, direction: Array) -> Array:
    """Mean HU over a small disc along the line, as far as the CT reaches."""
    steps = np.arange(0.0, FARTHEST_MM, STEP_MM)
    line = isthmus_mm + steps[:, None] * direction
    inside = near.holds(line)
    count = len(steps) if inside.all() else int(np.argmin(inside))
    (across,), (up,) = planes_across(direction[None])
    offsets = DISC_MM * np.array([[0.0, 0.0], [1.0, 0.0], [-1.0, 0.0], [0.0, 1.0], [0.0, -1.0]])
    shifted = line[None] + (offsets[:, :1] * across + offsets[:, 1:] * up)[:, None, :]
    return np.asarray(near.smooth_hu(shifted).mean(axis=0)[:count])


def _falls(profile: Array, least_fall_hu: float, behind: int) -> list[tuple[float, float]]:
    """Where the profile falls by so much: distance in mm of half the fall, and the number behind it."""
    found: list[tuple[float, float]] = []
    top = 0
    at = 1
    while at < len(profile):
        if profile[at] > profile[top]:
            top = at
        elif profile[top] - profile[at] >= least_fall_hu:
            end = at + int(np.argmin(profile[at : at + behind + 1]))
            half = 0.5 * (profile[top] + profile[end])
            after = top + int(np.argmax(profile[top : end + 1] < half))
            share = (profile[after - 1] - half) / max(profile[after - 1] - profile[after], 1e-9)
            found.append(((after - 1 + float(share)) * STEP_MM, float(profile[end])))
            top = at = end
        at += 1
    return found


def _is_enclosed(near: Neighbourhood, point_mm: Array, direction: Array) -> bool:
    """Whether bone is met in most directions across the line."""
    (across,), (up,) = planes_across(direction[None])
    angle = angles(LOOK_RAYS)
    rays = np.cos(angle)[:, None] * across + np.sin(angle)[:, None] * up
    steps = np.arange(0.0, LOOK_ACROSS_MM, 0.5)
    points = point_mm + steps[:, None] * rays[:, None, :]
    # In thick slices an endplate is faint.
    faint = near.tissue_hu + max(100.0, 0.25 * (near.cortex_hu - near.tissue_hu))
    bone = (near.smooth_hu(points) > faint) & near.holds(points)
    return bool(bone.any(axis=1).mean() >= ENCLOSED_RATIO)
