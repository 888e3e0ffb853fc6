"""Axial, sagittal and coronal slices in patient directions, independent of the scanner's axes.

Radiological convention: an axial slice is seen from the feet, a coronal one from the front (the patient's
right on the image's left in both), a sagittal one from the patient's left (the front on the image's left).
"""

import math
from typing import Literal, NamedTuple, TypeAlias

import numpy as np
import numpy.typing as npt

from tracker.errors import PlanError
from tracker.geometry import Array
from tracker.plan.slices.resample import max_intensity_slab, resampled
from tracker.plan.slices.slice import Slice
from tracker.plan.volume import Volume

Plane: TypeAlias = Literal["axial", "sagittal", "coronal"]

# Maximum distance in voxels of a plane from the native slice that replaces it.
NATIVE_VOXELS = 1e-3
ALIGNED_RATIO = 1e-6


class _View(NamedTuple):
    """LPS axis of a plane's position, and the right and down directions of its image."""

    axis: int
    right: Array
    down: Array


VIEWS: dict[Plane, _View] = {
    "axial": _View(2, np.array([1.0, 0.0, 0.0]), np.array([0.0, 1.0, 0.0])),
    "sagittal": _View(0, np.array([0.0, 1.0, 0.0]), np.array([0.0, 0.0, -1.0])),
    "coronal": _View(1, np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, -1.0])),
}


def reach_mm(volume: Volume, plane: Plane) -> tuple[float, float, float]:
    """Return the range of positions of a plane, and the step between slices.

    The first two are a coordinate in LPS: z for axial, x for sagittal, y for coronal.
    """
    axis = VIEWS[plane].axis
    along = _corners(volume)[:, axis]
    steps = np.abs(volume.lps_from_ijk[axis, :3])
    return float(along.min()), float(along.max()), float(steps[np.argmax(steps / volume.spacing_mm)])


def patient_slice(
    volume: Volume, plane: Plane, at_mm: float, *, slab_mm: float = 0.0, pixel_mm: float | None = None
) -> Slice:
    """Return the axial, sagittal or coronal slice at an LPS coordinate.

    The native pixels are returned if slice or voxel axes lie in the plane; otherwise the CT is resampled
    into square pixels.

    Args:
        volume: the CT.
        plane: which of the three.
        at_mm: z for axial, x for sagittal, y for coronal.
        slab_mm: thickness of the maximum intensity projection.
        pixel_mm: side of the pixels; the smallest voxel side if None. Not used for native pixels.

    Raises:
        PlanError: SLICE_OUTSIDE, SLICE_TOO_LARGE or SLAB_INVALID.
    """
    low, high, _ = reach_mm(volume, plane)
    if not (math.isfinite(at_mm) and low - 1e-6 <= at_mm <= high + 1e-6):
        raise PlanError(
            "SLICE_OUTSIDE",
            f"there is no {plane} slice at {at_mm:.2f} mm: the CT reaches from {low:.2f} to {high:.2f} mm",
            "Choose a place inside the CT.",
            {"plane": plane, "at_mm": at_mm, "from_mm": low, "to_mm": high},
        )
    view = VIEWS[plane]
    if slab_mm == 0.0 and pixel_mm is None:
        native = _native(volume, view, at_mm)
        if native is not None:
            return native
    corners = _corners(volume)
    side = float(volume.spacing_mm.min()) if pixel_mm is None else pixel_mm
    across, along = corners @ view.right, corners @ view.down
    start = view.right * across.min() + view.down * along.min()
    start[view.axis] = at_mm
    size_mm = (float(np.ptp(across)), float(np.ptp(along)))
    flat = np.column_stack([view.right * side, view.down * side, start])
    return max_intensity_slab(
        lambda beyond: resampled(volume, flat + beyond, size_mm),
        slab_mm,
        float(volume.spacing_mm.min()),
        flat,
    )


def _corners(volume: Volume) -> Array:
    """Return the centres (8, 3) of the corner voxels, in LPS mm."""
    ends = [[0.0, size - 1.0] for size in volume.shape_ijk]
    return volume.lps_from_index(np.array(np.meshgrid(*ends)).reshape(3, 8).T)


def _native(volume: Volume, view: _View, at_mm: float) -> Slice | None:
    """Return the scanner's own pixels in this plane, if two voxel axes and a slice lie in it."""
    steps = volume.lps_from_ijk[:3, :3]
    axes = steps / volume.spacing_mm
    columns, rows = _lying_along(axes, view.right), _lying_along(axes, view.down)
    if columns is None or rows is None:
        return None
    through = 3 - columns - rows
    place = (at_mm - volume.lps_from_ijk[view.axis, 3]) / steps[view.axis, through]
    nearest = round(place)
    is_upright = np.abs(np.delete(axes[:, through], view.axis)).max() < ALIGNED_RATIO
    if abs(place - nearest) > NATIVE_VOXELS and not is_upright:
        return None
    index = np.zeros(3)
    index[through] = place if is_upright else nearest
    hu = _read(volume.hu, through, float(index[through]))
    # The remaining array has the lower of both axes (in i, j, k) last.
    hu = hu if columns < rows else hu.T
    for axis, wanted, flipped in ((columns, view.right, 1), (rows, view.down, 0)):
        if axes[:, axis] @ wanted < 0.0:
            hu = np.flip(hu, axis=flipped)
            index[axis] = volume.shape_ijk[axis] - 1.0
    start = volume.lps_from_index(index)
    return Slice(
        hu=np.ascontiguousarray(hu),
        lps_from_px=np.column_stack(
            [
                steps[:, columns] * np.sign(axes[:, columns] @ view.right),
                steps[:, rows] * np.sign(axes[:, rows] @ view.down),
                start,
            ]
        ),
    )


def _lying_along(axes: Array, wanted: Array) -> int | None:
    """Return the voxel axis along this direction, of either sign."""
    along = np.abs(wanted @ axes)
    best = int(np.argmax(along))
    off = np.linalg.norm(axes[:, best] - np.sign(wanted @ axes[:, best]) * wanted)
    return best if off < ALIGNED_RATIO else None


def _read(hu: npt.NDArray[np.int16], through: int, place: float) -> npt.NDArray[np.int16]:
    """Return the voxels at a position along one axis (i, j, k), interpolated between two slices."""
    last = hu.shape[2 - through] - 1
    place = min(max(place, 0.0), float(last))
    low = min(int(place), last - 1)
    part = place - low
    below, above = (np.take(hu, low + step, axis=2 - through) for step in (0, 1))
    if part < NATIVE_VOXELS or part > 1.0 - NATIVE_VOXELS:
        return np.asarray(below if part < 0.5 else above)
    return np.asarray(np.rint(below * (1.0 - part) + above * part).astype(np.int16))
