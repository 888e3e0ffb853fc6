"""Resampling of the CT in a plane."""

import math
from collections.abc import Callable

import numpy as np

from tracker.errors import PlanError
from tracker.geometry import Array
from tracker.plan.slices.slice import Slice
from tracker.plan.volume import Volume

MAX_SIDE_PX = 4096
MAX_SLAB_MM = 100.0


def resampled(volume: Volume, lps_from_px: Array, size_mm: tuple[float, float]) -> Slice:
    """Return the CT in a plane, interpolated linearly.

    Args:
        volume: the CT.
        lps_from_px: (3, 3), where the pixels lie.
        size_mm: width and height; the pixels' centres reach at least so far.

    Raises:
        PlanError: SLICE_TOO_LARGE.
    """
    sides = np.linalg.norm(lps_from_px[:, :2], axis=0)
    if not (np.isfinite(lps_from_px).all() and np.isfinite(size_mm).all() and sides.min() > 0.0):
        raise _too_large(size_mm, float(sides.min()))
    # Tolerance, so that rounding does not add a pixel.
    columns, rows = (math.ceil(size / side - 1e-6) + 1 for size, side in zip(size_mm, sides, strict=True))
    if min(columns, rows) < 1 or max(columns, rows) > MAX_SIDE_PX:
        raise _too_large(size_mm, float(sides.min()))
    u, v = np.meshgrid(np.arange(columns), np.arange(rows))
    points = np.stack([u, v, np.ones_like(u)], axis=-1) @ lps_from_px.T
    return Slice(hu=np.rint(volume.sample_hu(points)).astype(np.int16), lps_from_px=lps_from_px)


def max_intensity_slab(
    read: Callable[[Array], Slice], slab_mm: float, step_mm: float, lps_from_px: Array
) -> Slice:
    """Return the maximum intensity projection through a slab; the plane itself for thickness 0.

    Args:
        read: returns the slice for a (3, 3) offset, added to `lps_from_px`.
        slab_mm: thickness.
        step_mm: between the sampled planes.
        lps_from_px: (3, 3), of the plane in the middle.

    Raises:
        PlanError: SLAB_INVALID.
    """
    if not 0.0 <= slab_mm <= MAX_SLAB_MM:
        raise PlanError(
            "SLAB_INVALID",
            f"a slab of {slab_mm:g} mm cannot be shown, allowed 0 to {MAX_SLAB_MM:.0f} mm",
            "Choose a thinner slab.",
            {"slab_mm": slab_mm, "max_mm": MAX_SLAB_MM},
        )
    count = math.ceil(slab_mm / step_mm) + 1 if slab_mm > 0.0 else 1
    sides = np.linalg.norm(lps_from_px[:, :2], axis=0)
    normal = np.cross(*(lps_from_px[:, :2] / np.maximum(sides, 1e-12)).T)
    highest = None
    for beyond in np.linspace(-slab_mm / 2.0, slab_mm / 2.0, count) if count > 1 else (0.0,):
        offset = np.zeros((3, 3))
        offset[:, 2] = normal * beyond
        hu = read(offset).hu
        highest = hu if highest is None else np.maximum(highest, hu)
    return Slice(hu=np.asarray(highest), lps_from_px=lps_from_px)


def _too_large(size_mm: tuple[float, float], side_mm: float) -> PlanError:
    return PlanError(
        "SLICE_TOO_LARGE",
        f"a slice of {size_mm[0]:.1f} x {size_mm[1]:.1f} mm with pixels of {side_mm:.4f} mm cannot be shown, "
        f"allowed {MAX_SIDE_PX} pixels a side",
        "Choose larger pixels, or a smaller field.",
        {"width_mm": size_mm[0], "height_mm": size_mm[1], "pixel_mm": side_mm, "max_px": MAX_SIDE_PX},
    )
