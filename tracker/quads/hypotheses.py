"""Quad hypotheses from single corners and from pairs of opposite sides.

Motion blurs all sides except those along it, and with them all four corners. Two opposite sides therefore
also form a hypothesis: their ends are varied, and the coarse match uses templates blurred along them, which
rank the true quad first in nearly all images; sharp templates rank it as low as three hundredth.
"""

from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from tracker.edges import GreyImage
from tracker.quads.quad_kernels import corner_quads, pair_quads, successors_of

Quads: TypeAlias = npt.NDArray[np.float32]

MIN_CORNER_SIDE_PX = 8.0
MIN_SQUASH_RATIO = 0.4
# Distance from a side at which the blur of an edge in focus has ended.
BESIDE_PX = 2.0
# Ratio of successive lengths: the template match tolerates a length error of a tenth.
LENGTH_GROWTH = 1.25
# The visible part of a motion-blurred side may be too short or too long by a quarter.
MAX_PAIR_RATIO = 2.0
PAIR_LENGTHS, PAIR_SHIFTS = np.array([0.8, 1.0, 1.25]), np.array([-0.12, 0.0, 0.12])
# Only the longest segments are paired, because the number of pairs grows with the square of their number.
MAX_PAIRED = 5000


def corner_quads_of(image: GreyImage, segments: npt.NDArray[np.float32], *, min_step_grey: float) -> Quads:
    """Return quads (q, 4, 2) in px of which one corner and its two sides are visible.

    They are parallelograms, clockwise on the screen; the rest may be occluded.
    """
    if len(segments) < 2:
        return np.empty((0, 4, 2), np.float32)
    successors, counts = successors_of(segments)
    quads = corner_quads(
        image,
        segments,
        successors,
        counts,
        MIN_CORNER_SIDE_PX,
        MIN_SQUASH_RATIO,
        BESIDE_PX,
        min_step_grey,
        LENGTH_GROWTH,
    )
    return np.asarray(quads, dtype=np.float32)


def pair_quads_of(segments: npt.NDArray[np.float32]) -> Quads:
    """Return quads (q, 4, 2) in px of which two opposite sides are visible and motion blurs the others.

    They are parallelograms, clockwise on the screen; the first side is along a visible one.
    """
    if len(segments) > MAX_PAIRED:
        long = np.argsort(-np.hypot(*(segments[:, 2:] - segments[:, :2]).T), kind="stable")[:MAX_PAIRED]
        segments = np.ascontiguousarray(segments[long])
    quads = pair_quads(
        segments, MIN_CORNER_SIDE_PX, MIN_SQUASH_RATIO, MAX_PAIR_RATIO, PAIR_LENGTHS, PAIR_SHIFTS
    )
    return np.asarray(quads, dtype=np.float32)
