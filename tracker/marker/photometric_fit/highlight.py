"""Fit of one highlight: the Gaussian with the largest decrease of the squared residuals."""

from functools import cache
from itertools import product

import numpy as np
import numpy.typing as npt

from tracker.geometry import Array
from tracker.marker.photometric_fit.grid_kernels import GRID_CELLS
from tracker.marker.photometric_fit.illumination import grid

# Centres and sds (along, across) of the initial Gaussians, in half sides.
MIDDLES = np.linspace(-1.2, 1.2, 7)
ANGLES, ROUND_SDS, LONG_SDS = 4, (0.35, 0.55, 0.9), (0.9, 0.4)
MIN_RATIO = 0.05
STRIDE = 3  # one cell in nine is enough to find one
# Limits of the Gauss-Newton refinement of the best Gaussian; a narrower one could fit a part of the shape.
ROUNDS, MAX_MOVED, FARTHEST, MIN_SD, MAX_SD = 4, 0.3, 1.5, 0.42, 1.5
DAMPING = 0.02


def highlight_in(residual: Array, fitted_basis: Array, weight: Array) -> Array | None:
    """Return the highlight (cells,), maximum 1, with the largest decrease of the residuals; None without one.

    Args:
        residual: residuals of a fit (n, n), in grey levels.
        fitted_basis: basis (cells, k) of the parameters that were already fitted.
        weight: weights of the cells (n, n).
    """
    few = _sparse_cells()
    root = np.sqrt(weight.ravel()[few])
    basis, _ = np.linalg.qr(fitted_basis[few] * root[:, None])
    left = residual.ravel()[few] * root
    left = left - basis @ (left @ basis)

    def own(some: Array) -> Array:
        """Project illumination terms (cells, n) orthogonally to the fitted basis."""
        there = some[few] * root[:, None]
        return np.asarray(there - basis @ (basis.T @ there))

    def explained_by(own_some: Array) -> Array:
        return np.asarray((left @ own_some) / np.sqrt(np.sum(own_some**2, axis=0) + 1e-9))

    along = explained_by(own(_gaussian_basis()))
    # A highlight is never negative.
    which = int(np.argmax(along))
    shape, maximum = _shapes()[which], float(along[which])
    if not (maximum > 0.0 and maximum**2 > MIN_RATIO * float(left @ left)):
        return None
    best = _with_slopes(shape)
    for _ in range(ROUNDS):
        shape = _moved(shape, own(best), left)
        there = _with_slopes(shape)
        better = float(explained_by(own(there[:, :1]))[0])
        if not better > maximum:
            break
        best, maximum = there, better
    return best[:, 0]


def _moved(shape: Array, own: Array, left: Array) -> Array:
    """Return the shape after one damped Gauss-Newton step; `own` (cells, 6): Gaussian and derivatives."""
    a, g = own.T @ own, own.T @ left
    solved = np.linalg.solve(a + DAMPING * np.diag(np.diag(a)) + 1e-9 * np.eye(len(a)), g)
    step = solved[1:] / max(float(solved[0]), 1e-6)
    middle = shape[:2] + np.clip(step[:2], -MAX_MOVED, MAX_MOVED)
    uu, vv, uv = shape[2:] + step[2:]
    values, ways = np.linalg.eigh(np.array([[uu, uv], [uv, vv]]))
    values = np.clip(values, MAX_SD**-2, MIN_SD**-2)
    inverse = ways @ np.diag(values) @ ways.T
    return np.array([*np.clip(middle, -FARTHEST, FARTHEST), inverse[0, 0], inverse[1, 1], inverse[0, 1]])


def _with_slopes(shape: Array) -> Array:
    """Return a Gaussian (cells,), maximum 1, and its derivatives by the shape: (cells, 6).

    The shape is the centre and the inverse covariance: uu, vv, uv.
    """
    u, v, uu, vv, uv = shape
    x, y = (one.ravel() - middle for one, middle in zip(grid(), (u, v), strict=True))
    gaussian = np.exp(-0.5 * (uu * x * x + vv * y * y + 2.0 * uv * x * y))
    slopes = (uu * x + uv * y, vv * y + uv * x, -0.5 * x * x, -0.5 * y * y, -x * y)
    return np.stack([gaussian, *(gaussian * one for one in slopes)], axis=1)


@cache
def _sparse_cells() -> npt.NDArray[np.int64]:
    """Return the cells of a sparse grid."""
    at = np.arange(0, GRID_CELLS, STRIDE)
    return np.asarray((at[:, None] * GRID_CELLS + at).ravel())


@cache
def _shapes() -> Array:
    """Return the initial shapes (n, 5), round and elongated."""
    forms = [(sd, sd, 0.0) for sd in ROUND_SDS] + [(*LONG_SDS, k * np.pi / ANGLES) for k in range(ANGLES)]
    shapes = []
    for along, across, angle in forms:
        c, s, a, b = np.cos(angle), np.sin(angle), along**-2, across**-2
        inverse = (c * c * a + s * s * b, s * s * a + c * c * b, c * s * (a - b))
        shapes += [(u, v, *inverse) for u, v in product(MIDDLES, MIDDLES)]
    return np.array(shapes)


@cache
def _gaussian_basis() -> Array:
    """Return the initial shapes as Gaussians (cells, n)."""
    return np.column_stack([_with_slopes(one)[:, 0] for one in _shapes()])
