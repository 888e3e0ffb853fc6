"""Where a model has its shape, which makes it unique; its outline is what all squares share."""

import numpy as np
import numpy.typing as npt

from tracker.marker.explanation.cover import Mask
from tracker.marker.explanation.fit import inside_square
from tracker.marker.explanation.light import grid

# Half of the part of the square that a border leaves, in half sides: there another marker may have its shape.
OTHERS_HALF = 0.8


def shape_of(picture: npt.NDArray[np.float32]) -> Mask:
    """Where the model has its shape: around what is bright within the outline."""
    u, v = grid()
    bright = (picture > 0.5) & (np.maximum(np.abs(u), np.abs(v)) < 0.85)
    rows, columns = np.nonzero(bright)
    if len(rows) == 0:
        return inside_square()
    out = np.zeros_like(bright)
    out[max(rows.min() - 1, 0) : rows.max() + 2, max(columns.min() - 1, 0) : columns.max() + 2] = True
    return np.asarray(out & inside_square())


def any_shape_of(picture: npt.NDArray[np.float32]) -> Mask:
    """Where this model or another one may have its shape: what is all dark here may be bright there."""
    u, v = grid()
    return np.asarray(shape_of(picture) | (np.maximum(np.abs(u), np.abs(v)) < OTHERS_HALF))
