"""Signed distance field to the wall around a channel: computed once, sampled in each image.

A 0.5 mm grid with 16-bit values is exact to 0.01 mm on flat bone and takes 5 MB to send to the tracking
process.
"""

from dataclasses import dataclass
from enum import StrEnum

import numpy as np
import numpy.typing as npt
import scipy

from tracker.errors import PlanError
from tracker.geometry import Array
from tracker.navigation.clearance.distance_kernels import (
    interpolate,
    propagate_nearest,
    rasterise_distance,
    sweep_neighbours,
)
from tracker.navigation.clearance.posterior_surface import PosteriorSurface, find_posterior_surface
from tracker.navigation.clearance.triangles import subdivide_triangles, triangles_near_grid
from tracker.navigation.clearance.voxels import Flags, Grid, dilated, fill_holes, voxelise
from tracker.navigation.directions import channel_directions
from tracker.plan.channel import Channel
from tracker.plan.surface import Surface

STEP_MM = 0.5
MARGIN_MM = 25.0
# Radii of the morphological closing, tried in ascending order, because thresholding opens holes in the thin
# cortex of a real CT. A foramen is wider than twice the last.
CLOSING_RADII_MM = (1.0, 1.5, 2.0, 3.0)
# Quantisation to 16 bits: a range of 256 mm in steps of a hundredth of a voxel.
UNIT_MM = 1.0 / 128.0
LARGEST_TRIANGLE_MM = 4.0
NARROW_BAND_STEPS = 2.0
# A smaller ratio of the channel in bone means another surface or another unit.
MIN_IN_BONE_RATIO = 0.8
MAX_NODES = 40_000_000


class WallSource(StrEnum):
    """What a clearance was measured against."""

    BONE = "bone"  # the bone's surface
    PEDICLE = "pedicle"  # the outline of the pedicle's isthmus, where no surface is known
    CHANNEL = "channel"  # the planned cylinder, where neither is


@dataclass(frozen=True, slots=True, kw_only=True)
class WallDistanceField:
    """Signed distances to the wall on a grid, and the posterior surface, through which a drill enters.

    Attributes:
        against: what the wall is.
        grid: of the nodes.
        values: (n0, n1, n2) int16, in `UNIT_MM`; negative inside the bone, positive outside.
        posterior: depth map of the posterior surface around the entry.
        closing_radius_mm: holes in the bone narrower than twice this were closed; 0 without bone.
    """

    against: WallSource
    grid: Grid
    values: npt.NDArray[np.int16]
    posterior: PosteriorSurface
    closing_radius_mm: float = 0.0

    def __post_init__(self) -> None:
        for array in (self.values, self.grid.origin_mm, self.posterior.floor_mm):
            array.setflags(write=False)

    def __reduce__(self) -> tuple[object, ...]:
        # Rebuild after unpickling, so that the arrays are read-only there too; for writable arrays Numba
        # would compile the kernels again.
        return _field_from, (self.against, self.grid, self.values, self.posterior, self.closing_radius_mm)

    def distances_mm(self, points_mm: Array) -> tuple[Array, Array]:
        """Return signed distances (n,) in mm at points (n, 3), positive outside, and gradients (n, 3)."""
        points = np.array(points_mm, dtype=np.float64).reshape(-1, 3)
        distance, gradient = np.empty(len(points)), np.empty((len(points), 3))
        interpolate(self.values, UNIT_MM, self.grid.step_mm, self.grid.origin_mm, points, distance, gradient)
        return distance, gradient


def _field_from(
    against: WallSource,
    grid: Grid,
    values: npt.NDArray[np.int16],
    posterior: PosteriorSurface,
    closing_radius_mm: float,
) -> WallDistanceField:
    return WallDistanceField(
        against=against, grid=grid, values=values, posterior=posterior, closing_radius_mm=closing_radius_mm
    )


def grid_around(channel: Channel, *, step_mm: float = STEP_MM, margin_mm: float = MARGIN_MM) -> Grid:
    """Return the grid within a margin of a channel, aligned with the patient's axes."""
    ends = np.stack([channel.entry_in_vertebra_mm, channel.target_in_vertebra_mm])
    low, high = ends.min(axis=0) - margin_mm, ends.max(axis=0) + margin_mm
    count = np.ceil((high - low) / step_mm).astype(int) + 1
    # An irregular offset avoids grid lines through mesh vertices at round coordinates, where crossings are
    # ambiguous.
    origin = low + step_mm * np.array([0.137, 0.241, 0.319])
    origin.setflags(write=False)
    return Grid(origin_mm=origin, step_mm=step_mm, shape=(int(count[0]), int(count[1]), int(count[2])))


def bone_distance_field(
    surface: Surface,
    channel: Channel,
    *,
    step_mm: float = STEP_MM,
    margin_mm: float = MARGIN_MM,
    closing_radius_mm: tuple[float, ...] = CLOSING_RADII_MM,
) -> WallDistanceField:
    """Compute the distance field of the outer wall of the bone: exact to 0.1 mm near it.

    Marrow and pores count as bone; the spinal canal and everything connected to the outside do not. Holes in
    the cortex are closed with the smallest of the given radii for which the channel lies in bone. The
    posterior surface, through which a drill enters, is excluded.

    Raises:
        PlanError: BONE_NOT_AT_CHANNEL, most of the channel lies outside of the surface; BONE_INSIDE_OUT;
            FIELD_TOO_LARGE.
    """
    grid = grid_around(channel, step_mm=step_mm, margin_mm=margin_mm)
    _reject_large(grid)
    _reject_inside_out(surface)
    corners = subdivide_triangles(triangles_near_grid(surface, grid), LARGEST_TRIANGLE_MM, grid)
    steps = grid.steps_of(corners)
    bone, closed_mm = _bone_around(channel, grid, voxelise(grid, steps), closing_radius_mm)
    across = channel_directions(channel)
    posterior, is_back = find_posterior_surface(bone, grid, channel.entry_in_vertebra_mm, across, corners)
    outer = _faces_outside(bone, grid, corners)
    walls = np.ascontiguousarray(steps[outer & ~is_back])
    squared = _squared_steps(bone, walls, np.ascontiguousarray(steps[outer & is_back]))
    return WallDistanceField(
        against=WallSource.BONE,
        grid=grid,
        values=pack_signed_distance(np.sqrt(squared) * step_mm, bone),
        posterior=posterior,
        closing_radius_mm=closed_mm,
    )


def pack_signed_distance(distance_mm: npt.NDArray[np.floating], inside: Flags) -> npt.NDArray[np.int16]:
    """Return signed distances, negative inside, quantised to 16 bits."""
    signed = np.where(inside, -distance_mm, distance_mm) / UNIT_MM
    values = np.rint(np.clip(signed, -32767, 32767)).astype(np.int16)
    values.setflags(write=False)
    return values


def _squared_steps(bone: Flags, walls: Array, backs: Array) -> npt.NDArray[np.float32]:
    """Return the squared distance of each node from the walls and from the openings of closed pores."""
    squared = np.full(bone.shape, np.inf, np.float32)
    nearest = np.full(bone.shape, -1, np.int32)
    known = squared.copy()
    rasterise_distance(backs, 0, NARROW_BAND_STEPS, known, nearest.copy())
    rasterise_distance(walls, 0, NARROW_BAND_STEPS, squared, nearest)
    mouths = _mouths(bone, np.minimum(known, squared))
    points = np.repeat(mouths[:, None, :], 3, axis=1)
    rasterise_distance(points, len(walls), NARROW_BAND_STEPS, squared, nearest)
    everything = np.concatenate([walls, points])
    if len(everything) == 0:
        return np.full(bone.shape, np.float32(1e4), np.float32)
    seeds = scipy.ndimage.distance_transform_edt(squared > 1.0, return_distances=False, return_indices=True)
    propagate_nearest(everything, seeds, nearest, squared)
    for direction in (1, -1):
        sweep_neighbours(everything, nearest, squared, direction)
    return squared


def _mouths(bone: Flags, squared: npt.NDArray[np.float32]) -> Array:
    """Return points (n, 3), in grid steps, between inside and outside nodes without a triangle nearby."""
    found = []
    for axis in range(3):
        low = tuple(slice(None, -1) if n == axis else slice(None) for n in range(3))
        high = tuple(slice(1, None) if n == axis else slice(None) for n in range(3))
        is_crossed = (bone[low] != bone[high]) & (squared[low] > 1.0) & (squared[high] > 1.0)
        points = np.argwhere(is_crossed).astype(np.float64)
        points[:, axis] += 0.5
        found.append(points)
    return np.concatenate(found)


def _faces_outside(bone: Flags, grid: Grid, corners: Array) -> Flags:
    """Return which triangles (m, 3, 3) face the outside; those of marrow and pores do not."""
    normal = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normal /= np.maximum(np.linalg.norm(normal, axis=1, keepdims=True), 1e-12)
    middle = corners.mean(axis=1)
    # One step outwards may still be inside a curved wall, two may be across a narrow gap.
    return np.asarray(
        ~bone[grid.nearest(middle + grid.step_mm * normal)]
        | ~bone[grid.nearest(middle + 0.5 * grid.step_mm * normal)]
    )


def _reject_inside_out(surface: Surface) -> None:
    centred = Surface(vertices_mm=surface.vertices_mm - surface.vertices_mm.mean(axis=0), faces=surface.faces)
    if centred.volume_ml < 0.0:
        raise PlanError(
            "BONE_INSIDE_OUT",
            f"the bone's surface encloses {centred.volume_ml:.1f} ml: its triangles are clockwise",
            "Import the surface again: its triangles must be counter-clockwise seen from outside.",
            {"volume_ml": centred.volume_ml},
        )


def _reject_large(grid: Grid) -> None:
    nodes = int(np.prod(grid.shape))
    if nodes > MAX_NODES:
        raise PlanError(
            "FIELD_TOO_LARGE",
            f"the distances around the channel would take {nodes} nodes, allowed {MAX_NODES}",
            "Check entry and target of the channel: a channel through a pedicle is 25 to 75 mm long.",
            {"nodes": nodes, "max_nodes": MAX_NODES},
        )


def _bone_around(
    channel: Channel, grid: Grid, solid: Flags, closing_radius_mm: tuple[float, ...]
) -> tuple[Flags, float]:
    """Return the filled bone, and the closing radius for which the channel lies in it."""
    along = np.linspace(0.1, 0.9, 41)[:, None]
    entry, target = channel.entry_in_vertebra_mm, channel.target_in_vertebra_mm
    line = grid.nearest(entry + along * (target - entry))
    ratio = 0.0
    for closed_mm in closing_radius_mm:
        bone = fill_holes(solid, step_mm=grid.step_mm, closing_radius_mm=closed_mm)
        if not bone.all():
            ratio = float(dilated(bone)[line].mean())
        if ratio >= MIN_IN_BONE_RATIO:
            return bone, closed_mm
    raise PlanError(
        "BONE_NOT_AT_CHANNEL",
        f"{100.0 * ratio:.0f} % of channel '{channel.name}' lies inside of the bone's surface, needed "
        f"{100.0 * MIN_IN_BONE_RATIO:.0f} % or more",
        "Check the unit and the coordinates of the surface (mm, LPS, of the channel's own CT); where its "
        "cortex has holes, create it again with a lower threshold.",
        {
            "in_bone_ratio": ratio,
            "in_bone_percent": float(100.0 * ratio),
            "channel": channel.name,
            "needed_percent": 100.0 * MIN_IN_BONE_RATIO,
        },
    )
