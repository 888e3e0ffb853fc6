"""Outlines of labels in a slice of the CT, to draw them over it."""

from dataclasses import dataclass

import cv2
import numpy as np

from tracker.geometry import Array
from tracker.plan.labels.label_volume import Labels, LabelVolume
from tracker.plan.labels.levels import CLASS_OF_LEVEL

# Smaller parts of a section are not drawn.
MIN_PIXELS = 12
ROWS_AT_ONCE = 64


@dataclass(frozen=True, slots=True, kw_only=True)
class LabelOutline:
    """Section of one label in a slice.

    Attributes:
        level: `L3`.
        rings_lps_mm: closed polygons (n, 3), through the centres of the outermost pixels; holes included.
        name_lps_mm: (3,), the pixel that is deepest inside, where the name fits.
    """

    level: str
    rings_lps_mm: tuple[Array, ...]
    name_lps_mm: Array


def label_outlines(
    labels: LabelVolume, lps_from_px: Array, size_wh_px: tuple[int, int]
) -> tuple[LabelOutline, ...]:
    """Return the outlines of all labels in a slice, from the head down.

    Args:
        labels: labels in the CT.
        lps_from_px: (3, 3), takes (u, v, 1) to LPS in mm, as in `Slice`.
        size_wh_px: number of columns and rows of the slice.
    """
    numbers = _numbers_in_slice(labels, lps_from_px, size_wh_px)
    shown = np.flatnonzero(np.bincount(numbers.ravel()))
    found = []
    for level, number in CLASS_OF_LEVEL.items():
        if number not in shown:
            continue
        mask = (numbers == number).astype(np.uint8)
        if np.count_nonzero(mask) < MIN_PIXELS:
            continue
        rings, _ = cv2.findContours(mask, cv2.RETR_CCOMP, cv2.CHAIN_APPROX_SIMPLE)
        depth = cv2.distanceTransform(np.pad(mask, 1), cv2.DIST_L2, 3)[1:-1, 1:-1]
        row, column = np.unravel_index(int(depth.argmax()), depth.shape)
        found.append(
            LabelOutline(
                level=level,
                rings_lps_mm=tuple(
                    np.column_stack([ring.reshape(-1, 2), np.ones(len(ring))]) @ lps_from_px.T
                    for ring in rings
                    if len(ring) > 2
                ),
                name_lps_mm=lps_from_px @ np.array([float(column), float(row), 1.0]),
            )
        )
    return tuple(found)


def _numbers_in_slice(labels: LabelVolume, lps_from_px: Array, size_wh_px: tuple[int, int]) -> Labels:
    """Return the class numbers (height, width); a few rows at a time, to save memory."""
    width, height = size_wh_px
    numbers = np.zeros((height, width), dtype=np.uint8)
    for start in range(0, height, ROWS_AT_ONCE):
        part = numbers[start : start + ROWS_AT_ONCE]
        v, u = np.mgrid[start : start + len(part), :width]
        points = np.stack([u, v, np.ones_like(u)], axis=-1).reshape(-1, 3) @ lps_from_px.T
        part[:] = labels.numbers_at(points).reshape(part.shape)
    return numbers
