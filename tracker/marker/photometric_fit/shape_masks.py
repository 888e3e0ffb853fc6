"""Masks of the inner shape that distinguishes a model; its outline is common to all squares."""

import numpy as np
import numpy.typing as npt

from tracker.marker.photometric_fit.estimator import inside_square
from tracker.marker.photometric_fit.illumination import grid
from tracker.marker.photometric_fit.occlusion import Mask

# Half width, in half sides, of the area inside the border where another marker may have its shape.
OTHERS_HALF = 0.8


def shape_mask(picture: npt.NDArray[np.float32]) -> Mask:
    """Return the bounding mask of the bright shape within the outline."""
    u, v = grid()
    bright = (picture > 0.5) & (np.maximum(np.abs(u), np.abs(v)) < 0.85)
    rows, columns = np.nonzero(bright)
    if len(rows) == 0:
        return inside_square()
    out = np.zeros_like(bright)
    out[max(rows.min() - 1, 0) : rows.max() + 2, max(columns.min() - 1, 0) : columns.max() + 2] = True
    return np.asarray(out & inside_square())


def any_shape_mask(picture: npt.NDArray[np.float32]) -> Mask:
    """Return the mask of this model's shape and of the area where another marker may have its shape."""
    u, v = grid()
    return np.asarray(shape_mask(picture) | (np.maximum(np.abs(u), np.abs(v)) < OTHERS_HALF))
