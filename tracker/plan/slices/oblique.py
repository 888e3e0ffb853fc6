"""Oblique slices: along and across a channel, and in any other plane."""

import numpy as np
import numpy.typing as npt

from tracker.errors import PlanError
from tracker.geometry import Array, rotation_from_vector
from tracker.plan.channel import Channel
from tracker.plan.slices.resample import max_intensity_slab, resampled
from tracker.plan.slices.slice import Slice
from tracker.plan.volume import Volume

LEFT, FEET, HEAD = np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, -1.0]), np.array([0.0, 0.0, 1.0])
BACK = np.array([0.0, 1.0, 0.0])
# A direction nearer than this to the axis cannot define up.
MIN_ACROSS = 0.1


def oblique_slice(
    volume: Volume,
    *,
    centre_lps_mm: npt.ArrayLike,
    right_lps: npt.ArrayLike,
    down_lps: npt.ArrayLike,
    size_mm: tuple[float, float],
    pixel_mm: float | None = None,
    slab_mm: float = 0.0,
) -> Slice:
    """Return the slice in any plane through the CT.

    Args:
        volume: the CT.
        centre_lps_mm: (3,), the middle of the image.
        right_lps: (3,), direction to the right in the image, of any length.
        down_lps: (3,), direction down; its component along `right_lps` is removed.
        size_mm: width and height from the first to the last pixel's centre.
        pixel_mm: side of the pixels; the smallest voxel side if left out.
        slab_mm: slab thickness of the maximum intensity projection.

    Raises:
        PlanError: PLANE_INVALID, SLICE_TOO_LARGE or SLAB_INVALID.
    """
    centre = np.asarray(centre_lps_mm, dtype=np.float64)
    right, down = _axes(np.asarray(right_lps, dtype=np.float64), np.asarray(down_lps, dtype=np.float64))
    side = float(volume.spacing_mm.min()) if pixel_mm is None else pixel_mm
    flat = np.column_stack(
        [right * side, down * side, centre - right * size_mm[0] / 2.0 - down * size_mm[1] / 2.0]
    )
    return max_intensity_slab(
        lambda beyond: resampled(volume, flat + beyond, size_mm),
        slab_mm,
        float(volume.spacing_mm.min()),
        flat,
    )


def along_channel(
    volume: Volume,
    channel: Channel,
    *,
    rotation_deg: float = 0.0,
    size_mm: tuple[float, float] = (60.0, 100.0),
    pixel_mm: float | None = None,
    slab_mm: float = 0.0,
) -> Slice:
    """Return the slice that contains the channel's axis; the drilling direction points up in the image.

    Without a rotation the patient's left is on the right, as nearly as the axis allows: the axial slice,
    tilted along the channel. The rotation is right-handed about the drilling direction; 90 degrees show the
    direction of head and feet.

    Raises:
        PlanError: PLANE_INVALID, SLICE_TOO_LARGE or SLAB_INVALID.
    """
    axis = channel.axis_in_vertebra
    right = rotation_from_vector(axis * np.radians(rotation_deg)) @ _across(axis, LEFT, HEAD)
    middle = (channel.entry_in_vertebra_mm + channel.target_in_vertebra_mm) / 2.0
    return oblique_slice(
        volume,
        centre_lps_mm=middle,
        right_lps=right,
        down_lps=-axis,
        size_mm=size_mm,
        pixel_mm=pixel_mm,
        slab_mm=slab_mm,
    )


def across_channel(
    volume: Volume,
    channel: Channel,
    *,
    depth_mm: float,
    size_mm: tuple[float, float] = (40.0, 40.0),
    pixel_mm: float | None = None,
    slab_mm: float = 0.0,
) -> Slice:
    """Return the slice perpendicular to the channel at a depth from its entry, seen along the drill.

    The feet point down, as nearly as the axis allows; the channel's axis is the centre of the image.

    Raises:
        PlanError: PLANE_INVALID, SLICE_TOO_LARGE or SLAB_INVALID.
    """
    axis = channel.axis_in_vertebra
    down = _across(axis, FEET, BACK)
    return oblique_slice(
        volume,
        centre_lps_mm=channel.entry_in_vertebra_mm + axis * depth_mm,
        right_lps=np.cross(down, axis),
        down_lps=down,
        size_mm=size_mm,
        pixel_mm=pixel_mm,
        slab_mm=slab_mm,
    )


def _across(axis: Array, wanted: Array, otherwise: Array) -> Array:
    """Return the unit direction perpendicular to the axis that is nearest to the wanted one."""
    for direction in (wanted, otherwise):
        across = direction - (direction @ axis) * axis
        length = np.linalg.norm(across)
        if length > MIN_ACROSS:
            break
    return np.asarray(across / length)


def _axes(right: Array, down: Array) -> tuple[Array, Array]:
    """Orthonormalise two directions."""
    lengths = np.linalg.norm(right), np.linalg.norm(down)
    if np.isfinite(lengths).all() and min(lengths) > 0.0:
        right = right / lengths[0]
        down = down / lengths[1] - (down @ right) / lengths[1] * right
        length = np.linalg.norm(down)
        if length > 1e-3:
            return right, down / length
    raise PlanError(
        "PLANE_INVALID",
        "the two directions of the plane are parallel or zero",
        "Give two different directions.",
        {"right": right.tolist(), "down": down.tolist()},
    )
