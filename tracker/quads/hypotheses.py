"""Quad hypotheses from single corners: two sides of unknown length that meet."""

from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from tracker.edges import GreyImage
from tracker.quads.quad_kernels import corner_quads, successors_of

Quads: TypeAlias = npt.NDArray[np.float32]

MIN_CORNER_SIDE_PX = 8.0
MIN_SQUASH_RATIO = 0.4
# Distance from a side at which the blur of an edge in focus has ended.
BESIDE_PX = 2.0
# Ratio of successive lengths: the template match tolerates a length error of a tenth.
LENGTH_GROWTH = 1.25


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
