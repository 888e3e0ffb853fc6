"""Could a part of the shape be dark for bright, and light, blur and place hide it?

Light that is fitted takes in some of a small part that another marker has dark for bright. So each part of
the shape is asked: by how much of its contrast would it have to be changed, when everything else that is
fitted gives way?
"""

from functools import cache

import numpy as np
import numpy.typing as npt

from tracker.geometry import Array
from tracker.marker.explanation.cover import Mask
from tracker.marker.explanation.fields.kernels import FIELDS, WIDE
from tracker.marker.explanation.fit import Fit
from tracker.marker.explanation.light import grid

# A part is a sixth of the side wide, as a disc of the same area; parts are asked every so many fields.
PART_SIDES, APART_FIELDS, EDGE_FIELDS = 1.0 / 6.0, 2, 4
MIN_SEEN_RATIO = 0.6
# Markers that differ in one field, a sixth of the side wide, have half of its contrast there, and more.
MAX_FLIPPED_RATIO = 0.5
# Neighbouring fields err alike, and many parts are asked.
NOISES = 10.0


def max_flipped(fit: Fit, telling: Mask, shape: Mask, noise_grey: float) -> float:
    """By how much of its contrast the most doubtful part of the shape (where it is `telling`) is changed.

    0 is the model, 1 a part that is dark for bright. A change of fewer than `NOISES` sd of the noise is none.
    """
    centres, parts = _parts(fit)
    gain, weight = fit.gain.ravel(), telling.ravel().astype(np.float64)
    whole = np.sum((parts * gain) ** 2, axis=1)
    seen = parts * (gain * weight)
    rows, columns = centres.T
    asked = (telling & shape)[rows, columns] & (np.sum(seen**2, axis=1) > MIN_SEEN_RATIO * whole)
    if not asked.any():
        return 0.0
    basis, _ = np.linalg.qr(_fitted(fit) * weight[:, None])
    own = seen[asked] - (seen[asked] @ basis) @ basis.T
    size = np.sqrt(np.maximum(np.sum(own**2, axis=1), 1e-9))
    along = np.abs(own @ (fit.rest.ravel() * weight)) / size
    return float(np.max(np.where(along > NOISES * noise_grey, along / size, 0.0)))


def _fitted(fit: Fit) -> Array:
    """What the fit could have changed (fields, n): light, contrast, place and blur."""
    gain, (u, v) = fit.gain, grid()
    slopes = [gain * fit.shown[k] * by for k in (1, 2) for by in (np.ones_like(u), u, v)]
    bends = [gain * fit.shown[k] for k in (3, 4, 5)]
    changes = np.stack([one.ravel() for one in (*slopes, *bends)], axis=1)
    return np.hstack([fit.light, fit.gains * fit.picture.reshape(-1, 1), changes])


@cache
def _centres() -> npt.NDArray[np.int64]:
    at = np.arange(EDGE_FIELDS, WIDE - EDGE_FIELDS, APART_FIELDS)
    rows, columns = np.meshgrid(at, at, indexing="ij")
    return np.stack([rows.ravel(), columns.ravel()], axis=1)


def _parts(fit: Fit) -> tuple[npt.NDArray[np.int64], Array]:
    """The middles (p, 2) of parts, row and column, and how each looks (p, fields) through the fit's blur."""
    area = (PART_SIDES * FIELDS) ** 2
    of_disc = area / (4.0 * np.pi)
    spread = np.array([[fit.blur[0], fit.blur[2]], [fit.blur[2], fit.blur[1]]]) + of_disc * np.eye(2)
    height = min(area / (2.0 * np.pi * float(np.sqrt(np.linalg.det(spread)))), 1.0)
    inverse = np.linalg.inv(spread)
    centres, fields = _centres(), np.arange(WIDE)
    y, x = fields - centres[:, :1], fields - centres[:, 1:]
    far = inverse[0, 0] * (x**2)[:, None, :] + inverse[1, 1] * (y**2)[:, :, None]
    far = far + 2.0 * inverse[0, 1] * y[:, :, None] * x[:, None, :]
    return centres, (height * np.exp(-0.5 * far)).reshape(len(centres), -1)
