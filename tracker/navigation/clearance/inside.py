"""What of a grid lies inside the bone: marrow and pores count, the spinal canal does not."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy import ndimage

from tracker.geometry import Array
from tracker.navigation.clearance.kernels import mark_crossings, vote

Flags = npt.NDArray[np.bool_]
CUBE = ndimage.generate_binary_structure(3, 3)
CROSS = ndimage.generate_binary_structure(3, 1)


@dataclass(frozen=True, slots=True, kw_only=True)
class Grid:
    """Nodes at equal steps along the patient's axes.

    Attributes:
        origin_mm: (3,), the first node.
        step_mm: from node to node.
        shape: how many along each axis.
    """

    origin_mm: Array
    step_mm: float
    shape: tuple[int, int, int]

    def steps_of(self, points_mm: Array) -> Array:
        """Points (..., 3) in steps from the first node."""
        return np.asarray((points_mm - self.origin_mm) / self.step_mm)

    def nearest(self, points_mm: Array) -> tuple[npt.NDArray[np.int64], ...]:
        """The indices (i, j, k) of the nodes nearest to points (..., 3), at the rim for what is beyond."""
        index = np.rint(self.steps_of(points_mm)).astype(np.int64)
        return tuple(np.moveaxis(np.clip(index, 0, np.array(self.shape) - 1), -1, 0))


def solid_of(grid: Grid, corners: Array) -> Flags:
    """Which nodes lie on the inner side of triangles (m, 3, 3) given in steps of the grid.

    Each node looks both ways along each axis; the first triangle that it meets says whether it is seen from
    behind. The majority decides, so that a mesh may be cut open where the CT ends: bone and canal go on
    there as they were. A mesh that overlaps itself is not for this.
    """
    votes = np.zeros(grid.shape, np.int8)
    for axis in range(3):
        turned = np.moveaxis(votes, axis, 0)
        marks = np.zeros((turned.shape[0] + 1, *turned.shape[1:]), np.int8)
        # The other two axes keep their order; where that is a reflection, entering looks like leaving.
        order = [axis, *[other for other in range(3) if other != axis]]
        mark_crossings(np.ascontiguousarray(corners[:, :, order]), marks)
        vote(-marks if axis == 1 else marks, turned)
    return np.asarray(votes > 0)


def filled(solid: Flags, *, step_mm: float, closes_mm: float) -> Flags:
    """The bone with its marrow and pores: all that a ball of this radius does not reach from outside.

    Outside is the largest space around the bone, and each one that goes through the grid from foot to head:
    the canal, where no gap between the vertebrae joins it to the rest.
    """
    rounds = max(round(closes_mm / step_mm), 1)
    free = ~_grown(solid, rounds)
    spaces, count = ndimage.label(free)
    if count == 0:
        return np.ones_like(solid)
    sizes = np.bincount(spaces.ravel(), minlength=count + 1)
    sizes[0] = 0
    through = np.intersect1d(np.unique(spaces[:, :, 0]), np.unique(spaces[:, :, -1]))
    outside = np.zeros(count + 1, bool)
    outside[through] = True
    outside[int(sizes.argmax())] = True
    outside[0] = False
    reached = outside[spaces]
    # Further than it was held off: into the corners that a ball does not fill.
    for n in range(int(np.ceil(1.5 * rounds)) + 1):
        reached = ndimage.binary_dilation(reached, CUBE if n % 2 else CROSS, mask=~solid) | reached
    return np.asarray(~reached)


def _grown(flags: Flags, rounds: int) -> Flags:
    """Grown by about a ball: a cross and a cube in turn."""
    for n in range(rounds):
        flags = ndimage.binary_dilation(flags, CUBE if n % 2 else CROSS)
    return flags
