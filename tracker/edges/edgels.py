"""Edgels: local maxima of the gradient magnitude across an edge, with sub-pixel position (section 2.3)."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.edges.edge_kernels import find_edgels
from tracker.edges.gradient import Gradient

Float32 = npt.NDArray[np.float32]
Int32 = npt.NDArray[np.int32]


@dataclass(frozen=True, slots=True, kw_only=True)
class Edgels:
    """The edge elements of an image.

    Attributes:
        x, y: (n,), position in px of the gradient's window, sub-pixel.
        nx, ny: (n,), unit direction of the gradient: from dark to bright, across the edge.
        strength: (n,), gradient magnitude.
        at: (h, w), index of the edgel in each pixel, -1 where there is none.
    """

    x: Float32
    y: Float32
    nx: Float32
    ny: Float32
    strength: Float32
    at: Int32


def edgels_of(gradient: Gradient) -> Edgels:
    """Return all edgels above the gradient's noise threshold, in row order."""
    x, y, nx, ny, strength, at = find_edgels(gradient.x, gradient.y, np.float32(gradient.threshold))
    return Edgels(x=x, y=y, nx=nx, ny=ny, strength=strength, at=at)
