"""Outlines: four straight edges that could be the border of a dark square."""

from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from tracker.edges import GreyImage
from tracker.marker.kernels import closed_and_open_quads, corner_quads, successors_of

Quads: TypeAlias = npt.NDArray[np.float32]

LEAST_CORNER_SIDE_PX = 8.0
LEAST_SQUASH_RATIO = 0.4
# Off a side, so far that an edge in focus is past.
BESIDE_PX = 2.0
# A length that is off by a tenth is near enough to be known at a glance.
LENGTH_GROWTH = 1.25


def quads_of(segments: npt.NDArray[np.float32]) -> Quads:
    """Candidate outlines (q, 4, 2) in px, corners clockwise on the screen, from segments (s, 4).

    Four segments that follow one another with a right turn at each corner make a closed outline; three of
    them make one whose fourth side is hidden.
    """
    if len(segments) < 3:
        return np.empty((0, 4, 2), np.float32)
    successors, counts = successors_of(segments)
    return np.asarray(closed_and_open_quads(segments, successors, counts), dtype=np.float32)


def corner_quads_of(image: GreyImage, segments: npt.NDArray[np.float32], *, least_step_grey: float) -> Quads:
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
        LEAST_CORNER_SIDE_PX,
        LEAST_SQUASH_RATIO,
        BESIDE_PX,
        least_step_grey,
        LENGTH_GROWTH,
    )
    return np.asarray(quads, dtype=np.float32)
