"""Entry and anterior exit of the pedicle's axis in the bone."""

from dataclasses import dataclass, replace

import numpy as np

from tracker.geometry import Array
from tracker.plan.edge_model import WALL, WALL_SD_MM, Imaging, profiles_of, solve
from tracker.plan.pedicle.length.body import outline_front
from tracker.plan.pedicle.length.entry import arch_back_mm
from tracker.plan.pedicle.length.profile import (
    DISC_OFFSETS_MM,
    MAX_DISTANCE_MM,
    STEP_MM,
    behind_steps,
    falls,
    profile_along,
)
from tracker.plan.pedicle.neighbourhood import Neighbourhood
from tracker.plan.pedicle.outlines import angles, planes_across
from tracker.plan.pedicle.plausibility import coarsest_mm
from tracker.plan.pedicle.solid import Solid

# Minimum distance of the front wall from the isthmus.
FRONT_FROM_MM, ENTRY_FROM_MM = 8.0, 2.0
# Beyond an outer wall, most directions across the axis contain no bone nearby.
GAP_BEYOND_MM = 2.0
LOOK_BEYOND_MM, LOOK_ACROSS_MM, LOOK_RAYS, ENCLOSED_RATIO = 4.0, 32.0, 16, 0.85
# For dark marrow that opens to a side. In front of a convex body, at most half of the rays meet bone.
VOID_ENCLOSED_RATIO = 0.7
# The wall is the profile fall within this distance of the end of the solid.
NEAR_EXIT_MM = 4.0
NO_FRONT_FROM_MM = 24.0
# The line has left the bone after this length or depth outside; less is a gap in the wall.
LEFT_DEPTH_MM, LEFT_FROM_MM, LEFT_FOR_MM = 1.0, 0.3, 2.0
# Bone that extends this far behind the arch is a process; its end is uncertain by more than a voxel.
PROCESS_MM, ARCH_SD_MM = 2.5, 1.5
# Minimum cosine between the line and the normal of a wall that is fitted, and in the stated error of others.
MIN_PLANE_RATIO, MIN_FACED_RATIO = 0.5, 0.15


@dataclass(frozen=True, slots=True, kw_only=True)
class WallAhead:
    """The outer wall in one direction along the axis.

    Attributes:
        distance_mm: from the isthmus.
        found: whether a wall was met; if not, the bone extends at least this far.
        outwards: unit (3,), the wall's normal; the direction itself without a wall.
        faced_ratio: cosine between direction and normal: 1 at perpendicular incidence, 0 along the wall.
        beyond_mm: extent of bone-like voxels behind it: a process, or an adjacent vessel.
        sd_mm: of the distance, in addition to that of the axis.
        chord_mm: a front wall that lies behind this distance dents the body; 0 if not known.
    """

    distance_mm: float
    found: bool
    outwards: Array
    faced_ratio: float
    beyond_mm: float = 0.0
    sd_mm: float = 0.0
    chord_mm: float = 0.0


def front_wall(
    near: Neighbourhood, solid: Solid, imaging: Imaging, isthmus_mm: Array, axis: Array
) -> WallAhead:
    """Return where the axis leaves the body anteriorly, by the outline of the whole body.

    Where a contrast-filled vessel touches the body, the solid includes it, and the outline does not.
    """
    exit_mm = _front_exit_mm(near, solid, isthmus_mm, axis)
    outline = outline_front(near, isthmus_mm, axis)
    at_mm = outline.distance_mm
    if at_mm is not None and _is_in_void(near, isthmus_mm, axis, at_mm):
        at_mm = None
    if at_mm is None or (exit_mm is not None and exit_mm <= at_mm):
        wall = _wall(near, solid, imaging, isthmus_mm, axis, FRONT_FROM_MM, exit_mm)
        return replace(wall, chord_mm=outline.chord_mm)
    wall = _wall(near, solid, imaging, isthmus_mm, axis, FRONT_FROM_MM, at_mm)
    beyond_mm = (MAX_DISTANCE_MM if exit_mm is None else exit_mm) - at_mm
    if beyond_mm > NEAR_EXIT_MM:
        faced = float(outline.outwards @ axis)
        wall = replace(wall, outwards=outline.outwards, faced_ratio=faced, beyond_mm=beyond_mm)
    return replace(wall, chord_mm=outline.chord_mm)


def back_wall(
    near: Neighbourhood, solid: Solid, imaging: Imaging, isthmus_mm: Array, axis: Array
) -> WallAhead:
    """Return where the axis, followed backwards, leaves the arch: the entry.

    If the axis continues into a process, the entry is where the arch around it ends, as a surgeon opens it.
    """
    exit_mm = _exit_mm(solid, isthmus_mm, -axis, ENTRY_FROM_MM)
    if exit_mm is not None and _is_in_open_marrow(near, solid, isthmus_mm, -axis, exit_mm):
        exit_mm = None
    wall = _wall(near, solid, imaging, isthmus_mm, -axis, ENTRY_FROM_MM, exit_mm)
    arch_mm = arch_back_mm(solid, isthmus_mm, axis)
    if arch_mm is None or wall.distance_mm <= arch_mm + PROCESS_MM:
        return wall
    if _is_in_open_marrow(near, solid, isthmus_mm, -axis, arch_mm):
        return wall
    beyond_mm = wall.distance_mm - arch_mm
    return WallAhead(
        distance_mm=arch_mm,
        found=True,
        outwards=-axis,
        faced_ratio=1.0,
        beyond_mm=beyond_mm,
        sd_mm=ARCH_SD_MM,
    )


def _wall(
    near: Neighbourhood,
    solid: Solid,
    imaging: Imaging,
    isthmus_mm: Array,
    direction: Array,
    from_mm: float,
    exit_mm: float | None,
) -> WallAhead:
    """Return the wall near the end of the solid, refined by the profile; else from the profile alone.

    Enclosed soft regions, as marrow, belong to the solid, so that no gap within the body ends it. The half
    level of a profile lies outside of a thin wall, by up to a voxel, so a blurred cortex is fitted to it.
    """
    if exit_mm is not None:
        found = bool(near.contains(isthmus_mm + (exit_mm + 1.0) * direction))
        distance = _fall_near(near, isthmus_mm, direction, exit_mm)
    else:
        distance, found = _outer_wall(near, isthmus_mm, direction, from_mm)
    if not found:
        # If ambiguous, the nearer wall is safer for a screw.
        profile = profile_along(near, isthmus_mm, direction)
        some = [one for one, _ in falls(near, profile, min_hu=near.min_fall_hu, behind=1)]
        distance = min([one for one in some if one >= NO_FRONT_FROM_MM], default=distance)
        return WallAhead(
            distance_mm=distance, found=False, outwards=direction, faced_ratio=1.0, sd_mm=WALL_SD_MM
        )
    point = isthmus_mm + distance * direction
    outwards, visible = solid.outwards_at(point), near.outwards_at(point)
    # The solid fills gaps between bones, as a disc, and its surface is then not the wall.
    if visible @ direction < MIN_PLANE_RATIO:
        outwards = visible
    faced = float(outwards @ direction)
    # A wall met more obliquely is not certainly the one where the line ends.
    moved_mm, sd_mm = (
        _edge_mm(near, imaging, point, outwards) if faced >= MIN_PLANE_RATIO else (0.0, WALL_SD_MM)
    )
    plane_ratio = max(faced, MIN_PLANE_RATIO)
    grazing_sd_mm = _grazing_sd_mm(solid, isthmus_mm, direction, distance, plane_ratio, coarsest_mm(near))
    return WallAhead(
        distance_mm=distance + moved_mm / plane_ratio,
        found=True,
        outwards=outwards,
        faced_ratio=faced,
        sd_mm=float(np.hypot(sd_mm / max(faced, MIN_FACED_RATIO), grazing_sd_mm)),
    )


def _edge_mm(near: Neighbourhood, imaging: Imaging, point_mm: Array, outwards: Array) -> tuple[float, float]:
    """Return the offset of the outer wall from a point along a normal, and its standard deviation."""
    (across,), (up,) = planes_across(outwards[None])
    points = point_mm + DISC_OFFSETS_MM @ np.stack([across, up])
    normals = np.tile(outwards, (len(points), 1))
    profiles = profiles_of(near.block, near.lps_from_index, points, normals, near.noise_hu)
    parameters, sd, _ = solve(profiles, imaging)
    offsets = parameters[:, WALL]
    # What is uncertain in the imaging is common to all profiles.
    own_sd_mm = np.std(offsets) / np.sqrt(len(offsets))
    return float(np.median(offsets)), float(np.hypot(np.median(sd[:, WALL]), own_sd_mm))


def _exit_mm(solid: Solid, isthmus_mm: Array, direction: Array, from_mm: float) -> float | None:
    """Return the last exit of the line from the solid, or None if it stays within the grid."""
    along = np.arange(from_mm, MAX_DISTANCE_MM, STEP_MM)
    line = isthmus_mm + along[:, None] * direction
    depth = solid.depth_at(line)[solid.contains(line)]
    steps = int(LEFT_FOR_MM / STEP_MM)
    shallow = np.convolve(depth < -LEFT_FROM_MM, np.ones(steps))[steps - 1 :] > steps - 0.5
    left = np.flatnonzero((depth < -LEFT_DEPTH_MM) | shallow)
    inside = np.flatnonzero(depth[: left[0]] > 0.0) if len(left) else left
    return float(along[inside[-1]]) if len(inside) else None


def _front_exit_mm(near: Neighbourhood, solid: Solid, isthmus_mm: Array, axis: Array) -> float | None:
    """Return the exit of the axis from the solid in front, or None if it stays within the grid.

    Weak trabeculae, as dark as soft tissue, that a thin wall does not close off are not part of the solid.
    They are passed, because bone encloses the line behind its exit into them.
    """
    from_mm = FRONT_FROM_MM
    while (exit_mm := _exit_mm(solid, isthmus_mm, axis, from_mm)) is not None:
        if not _is_in_void(near, isthmus_mm, axis, exit_mm):
            return exit_mm
        along = np.arange(exit_mm + GAP_BEYOND_MM, MAX_DISTANCE_MM, STEP_MM)
        inside = np.flatnonzero(solid.depth_at(isthmus_mm + along[:, None] * axis) > 0.0)
        if not len(inside):
            return None
        from_mm = float(along[inside[0]])
    return None


def _is_in_void(near: Neighbourhood, isthmus_mm: Array, axis: Array, distance_mm: float) -> bool:
    """Return whether the line continues in soft tissue within bone: in dark marrow, and not in a vessel."""
    beyond = _beyond(isthmus_mm, axis, distance_mm)
    is_soft = bool((near.smooth_hu(beyond) < near.soft_below_hu).all())
    return is_soft and _is_within_bone(near, beyond, axis, VOID_ENCLOSED_RATIO)


def _grazing_sd_mm(
    solid: Solid,
    isthmus_mm: Array,
    direction: Array,
    distance_mm: float,
    plane_ratio: float,
    voxel_mm: float,
) -> float:
    """Return the sd of an exit that the line approaches along a surface, as of the arch beside a facet.

    The surface of the solid is uncertain by up to a voxel, and a narrower recess is filled. Moved by a voxel,
    it ends the line elsewhere; the range beyond that of a plane wall with this cosine between line and
    normal is the uncertainty.
    """
    along = np.arange(0.0, MAX_DISTANCE_MM, STEP_MM)
    depth = solid.depth_at(isthmus_mm + along[:, None] * direction)
    exit_step = min(round(distance_mm / STEP_MM), len(along) - 1)
    bone = np.flatnonzero(depth[: exit_step + 1] > 0.0)
    if not len(bone):
        return 0.0
    # Marrow that leaks out of the solid may lie before the wall.
    gaps = np.flatnonzero(depth[: bone[-1]] <= 0.0)
    first = int(gaps[-1]) + 1 if len(gaps) else 0
    level_mm = min(voxel_mm, 0.5 * float(depth[first : exit_step + 1].max()))
    inside = np.flatnonzero(depth[: exit_step + 1] >= level_mm)
    outside = np.flatnonzero(depth[exit_step:] <= -level_mm)
    if not len(outside):
        return 0.0
    range_mm = (exit_step + int(outside[0]) - int(inside[-1])) * STEP_MM
    return max(0.0, 0.5 * range_mm - level_mm / plane_ratio)


def _fall_near(near: Neighbourhood, isthmus_mm: Array, direction: Array, exit_mm: float) -> float:
    """Return the profile fall nearest to the end of the solid; the end itself if there is none."""
    profile = profile_along(near, isthmus_mm, direction)
    behind = behind_steps(near, direction)
    for share in (1.0, 0.5):
        found = falls(near, profile, min_hu=share * near.min_fall_hu, behind=behind)
        close = [one for one, _ in found if abs(one - exit_mm) <= NEAR_EXIT_MM]
        if close:
            return min(close, key=lambda one: abs(one - exit_mm))
    return exit_mm


def _outer_wall(
    near: Neighbourhood, isthmus_mm: Array, direction: Array, from_mm: float
) -> tuple[float, bool]:
    """Return the first fall beyond which bone no longer encloses the line.

    Dense layers inside the bone fall to marrow, which can be as dark as muscle, but bone still encloses it.
    If no fall reaches the minimum of a wall, half of it is accepted: bone without a cortical shell.
    """
    profile = profile_along(near, isthmus_mm, direction)
    behind = behind_steps(near, direction)
    for share in (1.0, 0.5):
        for distance_mm, trough in falls(near, profile, min_hu=share * near.min_fall_hu, behind=behind):
            if distance_mm < from_mm or trough > near.soft_below_hu:
                continue
            if not _is_within_bone(near, _beyond(isthmus_mm, direction, distance_mm), direction):
                return distance_mm, True
    return max(len(profile) - 1, 0) * STEP_MM, False


def _is_in_open_marrow(
    near: Neighbourhood, solid: Solid, isthmus_mm: Array, direction: Array, distance_mm: float
) -> bool:
    """Return whether the solid ends at this distance within the bone.

    Marrow as dark as muscle that a weak wall does not close off does not belong to the solid.
    """
    beyond = _beyond(isthmus_mm, direction, distance_mm)
    return bool((solid.depth_at(beyond) < 0.0).all()) and _is_within_bone(near, beyond, direction)


def _beyond(isthmus_mm: Array, direction: Array, distance_mm: float) -> Array:
    """Return the points (2, 3) of the line behind a wall at this distance."""
    along = distance_mm + np.array([GAP_BEYOND_MM, LOOK_BEYOND_MM])
    return np.asarray(isthmus_mm + along[:, None] * direction)


def _is_within_bone(
    near: Neighbourhood, points: Array, direction: Array, min_ratio: float = ENCLOSED_RATIO
) -> bool:
    """Return whether bone encloses the line at each of these points (n, 3)."""
    return all(_enclosed_ratio(near, point, direction) >= min_ratio for point in points)


def _enclosed_ratio(near: Neighbourhood, point_mm: Array, direction: Array) -> float:
    """Return the share of the directions across the line in which bone is met."""
    (across,), (up,) = planes_across(direction[None])
    angle = angles(LOOK_RAYS)
    rays = np.cos(angle)[:, None] * across + np.sin(angle)[:, None] * up
    steps = np.arange(0.0, LOOK_ACROSS_MM, 0.5)
    points = point_mm + steps[:, None] * rays[:, None, :]
    # Thick slices reduce the contrast of an endplate.
    faint = near.tissue_hu + max(100.0, 0.25 * (near.cortex_hu - near.tissue_hu))
    bone = (near.smooth_hu(points) > faint) & near.contains(points)
    return float(bone.any(axis=1).mean())
