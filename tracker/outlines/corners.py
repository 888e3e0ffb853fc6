"""Outlines: where a dark square could be of which no more than a corner is seen.

Motion blurs all sides but those along it, and with them all four corners. So two sides that face each other
also make an outline: where they end is tried, and the coarse match uses templates blurred along them, which
rank the true outline first in nearly all images; sharp templates rank it up to three hundredth.
"""

from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from tracker.edges import GreyImage
from tracker.outlines.kernels import corner_quads, pair_quads, successors_of

Quads: TypeAlias = npt.NDArray[np.float32]

MIN_CORNER_SIDE_PX = 8.0
MIN_SQUASH_RATIO = 0.4
# Off a side, so far that an edge in focus is past.
BESIDE_PX = 2.0
# A length that is off by a tenth is near enough to be known at a glance.
LENGTH_GROWTH = 1.25
# What of a smeared side is seen may be a quarter too short, or too long.
MAX_PAIR_RATIO = 2.0
PAIR_LENGTHS, PAIR_SHIFTS = np.array([0.8, 1.0, 1.25]), np.array([-0.12, 0.0, 0.12])
# Of stripes and noise, the longest: each is held against all that run the other way.
MAX_PAIRED = 5000


def corner_quads_of(image: GreyImage, segments: npt.NDArray[np.float32], *, min_step_grey: float) -> Quads:
    """Candidate outlines of which one corner is seen, with what leads to it, and the rest may be covered.

    Outlines (q, 4, 2) in px, parallelograms, clockwise on the screen.
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
    """Candidate outlines of which two sides that face each other are seen, and motion smears the others.

    Outlines (q, 4, 2) in px, parallelograms, clockwise on the screen; the first side is along a seen one.
    """
    if len(segments) > MAX_PAIRED:
        long = np.argsort(-np.hypot(*(segments[:, 2:] - segments[:, :2]).T), kind="stable")[:MAX_PAIRED]
        segments = np.ascontiguousarray(segments[long])
    quads = pair_quads(
        segments, MIN_CORNER_SIDE_PX, MIN_SQUASH_RATIO, MAX_PAIR_RATIO, PAIR_LENGTHS, PAIR_SHIFTS
    )
    return np.asarray(quads, dtype=np.float32)
