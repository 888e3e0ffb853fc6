"""Distance field without a bone surface: of the outline of the pedicle's isthmus, or of the channel."""

import numpy as np
import numpy.typing as npt
import scipy

from tracker.geometry import Array
from tracker.navigation.clearance.distance_field import (
    MARGIN_MM,
    STEP_MM,
    WallDistanceField,
    WallSource,
    grid_around,
    pack_signed_distance,
)
from tracker.navigation.clearance.posterior_surface import flat_posterior_surface
from tracker.navigation.clearance.voxels import Grid
from tracker.plan.channel import Channel
from tracker.plan.pedicle import PedicleMeasure
from tracker.plan.screw.clearance import HALF_LENGTH_MM

FINE_MM = 0.25
REACH_MM = 25.0


def outline_distance_field(
    measure: PedicleMeasure, channel: Channel, *, step_mm: float = STEP_MM, margin_mm: float = MARGIN_MM
) -> WallDistanceField:
    """Compute the distance field of the outline, extruded 3 mm before and behind the isthmus.

    Beyond that, body and arch are wider by an unknown amount, so the outline is widened by 1 mm per mm. The
    anterior wall is therefore not monitored, and the wall near the entry hardly.
    """
    grid = grid_around(channel, step_mm=step_mm, margin_mm=margin_mm)
    offsets = _offsets(grid, measure.isthmus_lps_mm)
    axis = measure.axis_lps
    helper = np.eye(3)[int(np.argmin(np.abs(axis)))]
    first = np.cross(axis, helper) / np.linalg.norm(np.cross(axis, helper))
    plane = np.stack([first, np.cross(axis, first)]).astype(np.float32)
    outline = (measure.outline_lps_mm - measure.isthmus_lps_mm) @ plane.T
    # Computed in the plane at a higher resolution, because the outline is constant along the axis.
    reach = float(np.abs(outline).max()) + REACH_MM
    places = np.arange(-reach, reach, FINE_MM, dtype=np.float32)
    drawn = _signed_mm(np.stack(np.meshgrid(places, places, indexing="ij"), axis=-1), outline)
    index = np.stack([(_along(offsets, direction) + reach) / FINE_MM for direction in plane])
    signed = scipy.ndimage.map_coordinates(drawn, index, order=1, mode="nearest")
    beyond = np.maximum(np.abs(_along(offsets, axis)) - HALF_LENGTH_MM, 0.0)
    return _field(WallSource.PEDICLE, grid, signed - beyond)


def channel_distance_field(
    channel: Channel, *, step_mm: float = STEP_MM, margin_mm: float = MARGIN_MM
) -> WallDistanceField:
    """Compute the distance field of the planned cylinder, if nothing else is known.

    There is no wall beyond its ends; there the outline is widened by 1 mm per mm.
    """
    grid = grid_around(channel, step_mm=step_mm, margin_mm=margin_mm)
    offsets = _offsets(grid, channel.entry_in_vertebra_mm)
    depth = _along(offsets, channel.axis_in_vertebra)
    x, y, z = offsets
    off = np.sqrt(np.maximum(x**2 + y**2 + z**2 - depth**2, 0.0))
    beyond = np.maximum(np.maximum(-depth, depth - channel.length_mm), 0.0)
    return _field(WallSource.CHANNEL, grid, np.asarray(off - channel.radius_mm - beyond, np.float32))


def _offsets(grid: Grid, from_mm: Array) -> tuple[npt.NDArray[np.float32], ...]:
    """Return the offsets of the nodes in x (n0, 1, 1), y (1, n1, 1) and z (1, 1, n2)."""
    along = [
        origin + grid.step_mm * np.arange(count)
        for origin, count in zip(grid.origin_mm - from_mm, grid.shape, strict=True)
    ]
    return tuple(one.astype(np.float32) for one in np.ix_(*along))


def _along(offsets: tuple[npt.NDArray[np.float32], ...], direction: Array) -> npt.NDArray[np.float32]:
    """Return the coordinate (n0, n1, n2) of the nodes in a direction."""
    x, y, z = offsets
    first, second, third = direction.astype(np.float32)
    return np.asarray(x * first + y * second + z * third, dtype=np.float32)


def _field(against: WallSource, grid: Grid, distance_mm: npt.NDArray[np.float32]) -> WallDistanceField:
    values = pack_signed_distance(np.abs(distance_mm), distance_mm < 0.0)
    return WallDistanceField(against=against, grid=grid, values=values, posterior=flat_posterior_surface())


def _signed_mm(points: npt.NDArray[np.float32], outline: Array) -> npt.NDArray[np.float32]:
    """Return the signed distance of points (..., 2) from a closed polygon (n, 2), negative inside."""
    squared = np.full(points.shape[:-1], np.inf, np.float32)
    inside = np.zeros(points.shape[:-1], bool)
    x, y = points[..., 0], points[..., 1]
    for (ax, ay), (bx, by) in zip(outline, np.roll(outline, -1, axis=0), strict=True):
        length = max((bx - ax) ** 2 + (by - ay) ** 2, 1e-12)
        share = np.clip(((x - ax) * (bx - ax) + (y - ay) * (by - ay)) / length, 0.0, 1.0)
        off = (x - ax - share * (bx - ax)) ** 2 + (y - ay - share * (by - ay)) ** 2
        squared = np.minimum(squared, off)
        if ay != by:
            inside ^= ((ay > y) != (by > y)) & (x < (bx - ax) * (y - ay) / (by - ay) + ax)
    return np.asarray(np.where(inside, -1.0, 1.0) * np.sqrt(squared), dtype=np.float32)
