"""Outlines: where a dark square could be of which no more than a corner is seen."""

from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from tracker.edges import GreyImage
from tracker.outlines.kernels import corner_quads, successors_of

Quads: TypeAlias = npt.NDArray[np.float32]

LEAST_CORNER_SIDE_PX = 8.0
LEAST_SQUASH_RATIO = 0.4
# Off a side, so far that an edge in focus is past.
BESIDE_PX = 2.0
# A length that is off by a tenth is near enough to be known at a glance.
LENGTH_GROWTH = 1.25


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
