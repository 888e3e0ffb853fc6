"""Outlines: four straight edges that could be the border of a dark square."""

from typing import TypeAlias

import numpy as np
import numpy.typing as npt

from tracker.marker.kernels import closed_and_open_quads, successors_of

Quads: TypeAlias = npt.NDArray[np.float32]


def quads_of(segments: npt.NDArray[np.float32]) -> Quads:
    """Candidate outlines (q, 4, 2) in px, corners clockwise on the screen, from segments (s, 4).

    Four segments that follow one another with a right turn at each corner make a closed outline; three of
    them make one whose fourth side is hidden.
    """
    if len(segments) < 3:
        return np.empty((0, 4, 2), np.float32)
    successors, counts = successors_of(segments)
    return np.asarray(closed_and_open_quads(segments, successors, counts), dtype=np.float32)
