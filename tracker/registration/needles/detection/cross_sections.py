"""Cross sections of a bar at every pixel of its length, with subpixel edges."""

from dataclasses import dataclass

import cv2
import numpy as np
import numpy.typing as npt

from tracker.geometry import Array

Image8 = npt.NDArray[np.uint8]
FINE_PX = 0.25
# Minimum step of an edge in grey levels, over all colour channels; smaller steps are noise.
MIN_STEP = 18.0
MAX_WIDTH_CHANGE_RATIO = 0.3


@dataclass(frozen=True, slots=True, kw_only=True)
class CrossSections:
    """Cross sections of one bar.

    Attributes:
        at_px: (n,), position along the centre line.
        off_px: (n,), offset of the bar's centre; valid where `is_bar`.
        width_px: (n,), likewise.
        is_bar: (n,), whether both edges are present at the expected distance.
        inside: (n, 3), colour of the centre.
    """

    at_px: Array
    off_px: Array
    width_px: Array
    is_bar: npt.NDArray[np.bool_]
    inside: Array


def cross_sections(
    image: Image8, middle_px: Array, along: Array, width_px: float, from_px: float, to_px: float
) -> CrossSections:
    """Sample cross sections of a straight line between two distances from its middle.

    Args:
        image: (h, w, 3), BGR.
        middle_px: (2,), on the line.
        along: (2,), unit.
        width_px: expected width of the bar.
        from_px: start along the line.
        to_px: end along the line.
    """
    at = np.arange(from_px, to_px, 1.0)
    reach = 1.6 * width_px + 2.0
    across = np.arange(-reach, reach + FINE_PX / 2, FINE_PX)
    beside = np.array([-along[1], along[0]])
    where = middle_px + at[:, None, None] * along + across[None, :, None] * beside
    looked_at = cv2.remap(
        image.astype(np.float32),
        where[..., 0].astype(np.float32),
        where[..., 1].astype(np.float32),
        cv2.INTER_LINEAR,
        borderMode=cv2.BORDER_REPLICATE,
    )
    # Average five cross sections, because a wire does not change over five pixels.
    rows: Array = np.asarray(cv2.blur(looked_at, (1, 5)), dtype=np.float64)
    inside = np.asarray(rows[:, np.abs(across) < 0.2 * width_px].mean(axis=1), dtype=np.float64)
    sides = []
    for sign in (-1.0, 1.0):
        beyond = (sign * across > 0.85 * width_px) & (sign * across < 1.3 * width_px + 1.0)
        outside = np.asarray(rows[:, beyond].mean(axis=1), dtype=np.float64)
        sides.append(_crossing(rows, across, inside, outside, sign, width_px))
    left, right = sides
    width = right - left
    good = np.isfinite(width) & (np.abs(width - width_px) < MAX_WIDTH_CHANGE_RATIO * width_px)
    inner = (where.min(axis=1) > 1.0).all(axis=1) & (
        where.max(axis=1) < np.array([image.shape[1] - 2.0, image.shape[0] - 2.0])
    ).all(axis=1)
    return CrossSections(
        at_px=at, off_px=0.5 * (left + right), width_px=width, is_bar=good & inner, inside=inside
    )


def _crossing(
    rows: Array, across: Array, inside: Array, outside: Array, sign: float, width_px: float
) -> Array:
    """Return (n,) the half-height position of an edge; NaN without a step."""
    step = inside - outside
    size = np.linalg.norm(step, axis=1)
    share = np.einsum("nkc,nc->nk", rows - outside[:, None], step) / np.maximum(size, 1e-6)[:, None] ** 2
    side = np.flatnonzero((sign * across >= 0.0) & (sign * across <= 1.1 * width_px))
    side = side if sign > 0.0 else side[::-1]
    run = share[:, side]
    below = run < 0.5
    first = np.argmax(below, axis=1)
    found = below.any(axis=1) & (first > 0) & (size > MIN_STEP)
    before = np.maximum(first - 1, 0)
    index = np.arange(len(run))
    high, low = run[index, before], run[index, first]
    part = (high - 0.5) / np.maximum(high - low, 1e-6)
    place = across[side][before] + sign * part * FINE_PX
    return np.asarray(np.where(found, place, np.nan))
