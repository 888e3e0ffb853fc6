"""The vertebra as a solid: bone with its marrow filled in, without canal and surroundings."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import scipy

from tracker.geometry import Array
from tracker.plan.pedicle.neighbourhood import Neighbourhood, falling_direction

STEP_MM = 1.25
# Around the isthmus: to both sides, ahead and behind, to head and feet.
ASIDE_MM, AHEAD_MM, MAX_BEHIND_ENTRY_MM, UP_MM = 50.0, 62.0, 36.0, 32.0
# Soft tissue enters only through gaps wider than twice this: not through a vascular foramen.
GAP_MM = 2.0
AIR_HU = -200.0
SOFT_HU, ABOVE_TISSUE_HU = (-50.0, 110.0), (40.0, 80.0)
SMOOTH_VOXELS = 0.6
NORMAL_MM = 2.5


@dataclass(frozen=True, slots=True, kw_only=True)
class Solid:
    """A signed depth grid in LPS around an isthmus.

    Attributes:
        corner_mm: (3,), where the first voxel lies.
        depth_mm: (x, y, z), distance from the solid's surface, positive inside, negative outside.
    """

    corner_mm: Array
    depth_mm: npt.NDArray[np.float32]

    def depth_at(self, points_mm: Array) -> Array:
        """Return the depth (...) at points (..., 3); far outside beyond the grid."""
        index = (points_mm.reshape(-1, 3) - self.corner_mm) / STEP_MM
        values = scipy.ndimage.map_coordinates(
            self.depth_mm, index.T, output=np.float64, order=1, mode="constant", cval=-20.0
        )
        return np.asarray(values.reshape(points_mm.shape[:-1]))

    def contains(self, points_mm: Array) -> npt.NDArray[np.bool_]:
        """Return which points (..., 3) lie within the grid."""
        index = (points_mm - self.corner_mm) / STEP_MM
        return np.asarray(((index >= 0.0) & (index <= np.array(self.depth_mm.shape) - 1.0)).all(axis=-1))

    def outwards_at(self, point_mm: Array) -> Array:
        """Return the outward surface normal (3,) near a point, averaged over a few millimetres."""
        return falling_direction(self.depth_at, point_mm, NORMAL_MM)


def _distance_mm(mask: npt.NDArray[np.bool_]) -> Array:
    """Return the distance of each node of the mask to the nearest one outside of it."""
    return np.asarray(scipy.ndimage.distance_transform_edt(mask, sampling=STEP_MM), dtype=float)


def solid_around(near: Neighbourhood, isthmus_mm: Array) -> Solid:
    """Return the solid of bone and enclosed marrow; soft tissue is what wide gaps connect to the sides.

    Nothing enters from above or below, where a CT may end within the marrow.
    """
    low = np.array([-ASIDE_MM, -AHEAD_MM, -UP_MM])
    high = np.array([ASIDE_MM, MAX_BEHIND_ENTRY_MM, UP_MM])
    count = tuple(np.ceil((high - low) / STEP_MM).astype(int))
    corner = isthmus_mm + low
    index = np.moveaxis(np.indices(count), 0, -1).reshape(-1, 3)
    points = corner + STEP_MM * index
    hu = scipy.ndimage.gaussian_filter(near.smooth_hu(points).reshape(count), SMOOTH_VOXELS)
    inside = near.contains(points).reshape(count)
    soft_hu = hu[(hu > SOFT_HU[0]) & (hu < SOFT_HU[1])]
    tissue = float(np.median(soft_hu)) if len(soft_hu) else near.tissue_hu
    limit = tissue + float(np.clip(0.1 * (near.cortex_hu - tissue), *ABOVE_TISSUE_HU))
    gap = max(GAP_MM, float(np.linalg.norm(near.lps_from_index[:3, :3], axis=0).max()))
    bone = hu > limit
    air = (hu < AIR_HU) | ~inside
    from_bone = _distance_mm(~bone)
    wide = (from_bone > gap) | air
    label, _ = scipy.ndimage.label(wide)
    faces = [label[0], label[-1], label[:, 0], label[:, -1]]
    reached = np.unique(np.concatenate([face.ravel() for face in faces]))
    open_core = np.isin(label, reached[reached > 0]) & wide
    soft = (_distance_mm(~open_core) <= gap) & ~bone
    solid = ~(soft | open_core)
    within = _distance_mm(solid)
    without = _distance_mm(~solid)
    # Half a voxel each way: the surface lies between the last voxel inside and the first outside.
    depth = np.where(solid, within - 0.5 * STEP_MM, 0.5 * STEP_MM - without)
    return Solid(corner_mm=corner, depth_mm=depth.astype(np.float32))
