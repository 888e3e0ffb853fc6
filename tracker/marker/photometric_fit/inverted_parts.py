"""Largest contrast inversion of a part of the shape that the fitted parameters could hide.

Fitted illumination partly absorbs a small part that is inverted in another marker. For each part of the shape
its change of contrast is estimated jointly with all fitted parameters.
"""

from functools import cache

import numpy as np
import numpy.typing as npt

from tracker.geometry import Array
from tracker.marker.photometric_fit.estimator import Estimator
from tracker.marker.photometric_fit.grid_kernels import GRID_CELLS, SQUARE_CELLS
from tracker.marker.photometric_fit.illumination import grid
from tracker.marker.photometric_fit.occlusion import Mask

# Width of a part, tested as a disc of the same area, and the stride of the tested parts in cells.
PART_SIDES, STRIDE_CELLS, MARGIN_CELLS = 1.0 / 6.0, 2, 4
MIN_SEEN_RATIO = 0.6
# Markers that differ in one field, a sixth of the side wide, reach at least this ratio there.
MAX_INVERTED_RATIO = 0.5
# Errors of neighbouring cells are correlated, and many parts are tested.
NOISES = 10.0


def max_inverted_ratio(fit: Estimator, informative: Mask, shape: Mask, noise_grey: float) -> float:
    """Return the largest relative contrast change over all `informative` parts of the shape.

    0 is the model, 1 a part that is dark for bright. Changes below `NOISES` sd of the noise count as 0.
    """
    centres, parts = _parts(fit)
    gain, weight = fit.gain.ravel(), informative.ravel().astype(np.float64)
    full_energy = np.sum((parts * gain) ** 2, axis=1)
    observed = parts * (gain * weight)
    rows, columns = centres.T
    tested = (informative & shape)[rows, columns] & (
        np.sum(observed**2, axis=1) > MIN_SEEN_RATIO * full_energy
    )
    if not tested.any():
        return 0.0
    basis, _ = np.linalg.qr(_fitted(fit) * weight[:, None])
    own = observed[tested] - (observed[tested] @ basis) @ basis.T
    size = np.sqrt(np.maximum(np.sum(own**2, axis=1), 1e-9))
    along = np.abs(own @ (fit.residual.ravel() * weight)) / size
    return float(np.max(np.where(along > NOISES * noise_grey, along / size, 0.0)))


def _fitted(fit: Estimator) -> Array:
    """Return the derivatives (cells, n) by illumination, contrast, position and blur."""
    gain, (u, v) = fit.gain, grid()
    slopes = [gain * fit.rendered[k] * by for k in (1, 2) for by in (np.ones_like(u), u, v)]
    bends = [gain * fit.rendered[k] for k in (3, 4, 5)]
    changes = np.stack([one.ravel() for one in (*slopes, *bends)], axis=1)
    return np.hstack([fit.offset_basis, fit.gain_basis * fit.picture.reshape(-1, 1), changes])


@cache
def _centres() -> npt.NDArray[np.int64]:
    at = np.arange(MARGIN_CELLS, GRID_CELLS - MARGIN_CELLS, STRIDE_CELLS)
    rows, columns = np.meshgrid(at, at, indexing="ij")
    return np.stack([rows.ravel(), columns.ravel()], axis=1)


def _parts(fit: Estimator) -> tuple[npt.NDArray[np.int64], Array]:
    """Return the centres (p, 2) of parts, row and column, and their blurred images (p, cells)."""
    area = (PART_SIDES * SQUARE_CELLS) ** 2
    of_disc = area / (4.0 * np.pi)
    spread = np.array([[fit.blur[0], fit.blur[2]], [fit.blur[2], fit.blur[1]]]) + of_disc * np.eye(2)
    height = min(area / (2.0 * np.pi * float(np.sqrt(np.linalg.det(spread)))), 1.0)
    inverse = np.linalg.inv(spread)
    centres, fields = _centres(), np.arange(GRID_CELLS)
    y, x = fields - centres[:, :1], fields - centres[:, 1:]
    far = inverse[0, 0] * (x**2)[:, None, :] + inverse[1, 1] * (y**2)[:, :, None]
    far = far + 2.0 * inverse[0, 1] * y[:, :, None] * x[:, None, :]
    return centres, (height * np.exp(-0.5 * far)).reshape(len(centres), -1)
