"""Detect the head of a wire: wider, of one colour, not much longer than wide."""

import numpy as np
import numpy.typing as npt

from tracker.geometry import Array
from tracker.registration.needles.detection.cross_sections import cross_sections

Image8 = npt.NDArray[np.uint8]
WIDTHS = (2.0, 2.5, 3.0, 3.6, 4.3)
MIN_SECTIONS = 3


def head_length_px(picture: Image8, end_px: Array, outwards: Array, width_px: float) -> float:
    """Return the length of a head at the end of a wire, in px; 0 without one.

    Args:
        picture: (h, w, 3), BGR.
        end_px: (2,), last visible point of the wire.
        outwards: (2,), along the wire, away from it.
        width_px: of the wire.
    """
    along = outwards / np.linalg.norm(outwards)
    best = 0.0
    for times in WIDTHS:
        wide = times * width_px
        sections = cross_sections(picture, end_px, along, wide, -0.5 * width_px, 1.2 * wide + width_px)
        beyond = cross_sections(picture, end_px, along, wide, 1.4 * wide + width_px, 2.0 * wide + width_px)
        centred = sections.is_bar & (np.abs(sections.off_px) < 0.25 * wide)
        # A head is short, unlike a handle or the edge of a large object.
        if np.count_nonzero(centred) >= max(MIN_SECTIONS, 0.3 * wide) and beyond.is_bar.mean() < 0.5:
            best = max(best, float(np.count_nonzero(centred)))
    return best
