"""Stepwise selection of illumination terms: a shadow edge and highlights, while each reduces the residuals.

A spline of highlights fits half of the small parts of the shape, and the residuals then discriminate little.
A few terms of fixed form do not fit the shape.

Illumination and position are fitted alternately up to three times. The shape of each highlight is fitted too,
because highlights from a fixed set leave residuals as large as noise. The noise is estimated on the outline,
which is common to all squares, and the inside must fit to that noise level. Nothing is accepted where half of
the shape is saturated, or blur exceeds a tenth of the side. Of two positions that both fit, the one under
simple illumination is preferred. Some markers under strong highlights, and most of 20 px, are therefore
missed.
"""

from dataclasses import dataclass
from functools import cache
from itertools import product

import numpy as np
import numpy.typing as npt

from tracker.geometry import Array
from tracker.marker.photometric_fit.estimator import Estimator
from tracker.marker.photometric_fit.fit_kernels import OUTLIER_CONTRAST
from tracker.marker.photometric_fit.grid_kernels import GRID_CELLS
from tracker.marker.photometric_fit.illumination import contrasts, grid, shadow_in, smooth_light

MAX_TERMS = 3
FIRST_ROUNDS, ROUNDS = 4, 3
# A term must reduce the unexplained cells to this ratio, and by at least this number.
MAX_LEFT_RATIO, MIN_GAIN_CELLS = 0.93, 5.0
MIN_GAIN_RATIO = 0.25
# Centres and sds (along, across) of the initial Gaussians, in half sides.
MIDDLES = np.linspace(-1.2, 1.2, 7)
ANGLES, ROUND_SDS, LONG_SDS = 4, (0.35, 0.55, 0.9), (0.9, 0.4)
MIN_HIGHLIGHT_RATIO = 0.05
STRIDE = 3  # one cell in nine is enough to find one
# Limits of the Gauss-Newton refinement of the best Gaussian; a narrower one could fit a part of the shape.
HIGHLIGHT_ROUNDS, MAX_MOVED, FARTHEST, MIN_SD, MAX_SD = 4, 0.3, 1.5, 0.42, 1.5
DAMPING = 0.02


@dataclass(frozen=True, slots=True, kw_only=True)
class IlluminationFit:
    """Illumination terms of a fit with their robust weights.

    Attributes:
        offset_basis: additive terms (cells, n).
        gain_basis: contrast terms (cells, m).
        weight: robust weights of the cells (n, n).
        outlier_cells: approximate number of outlier cells.
    """

    offset_basis: Array
    gain_basis: Array
    weight: Array
    outlier_cells: float


def fit_illumination(fit: Estimator, weight: Array | None) -> bool:
    """Select and fit illumination terms at fixed position and blur; False where the model has no contrast.

    `weight` (n, n): initial weights of the cells.
    """
    best = _fit_terms(fit, smooth_light(2), contrasts(), weight, rounds=FIRST_ROUNDS)
    if best is None:
        return False
    for _ in range(MAX_TERMS):
        tried = [one for one in (_with_shadow(fit, best), _with_highlight(fit, best)) if one is not None]
        better = min(tried, key=lambda one: one.outlier_cells, default=best)
        enough = better.outlier_cells < min(
            MAX_LEFT_RATIO * best.outlier_cells, best.outlier_cells - MIN_GAIN_CELLS
        )
        best = better if enough else best
        if _fit_terms(fit, best.offset_basis, best.gain_basis, best.weight, rounds=1) is None:
            return False
        if not enough:
            break
    return True


def _with_shadow(fit: Estimator, lit: IlluminationFit) -> IlluminationFit | None:
    """Add a shadow edge; None where one was already added, or none reduces the residuals enough."""
    if lit.gain_basis.shape[1] > contrasts().shape[1]:
        return None
    # A highlight adds light; a shadow reduces the contrast.
    edge = shadow_in(fit.residual + fit.gain * fit.picture, fit.picture, fit.visible)
    if edge is None:
        return None
    offset_basis, gain_basis = (np.column_stack([one, edge]) for one in (lit.offset_basis, lit.gain_basis))
    return _fit_terms(fit, offset_basis, gain_basis, lit.weight, rounds=ROUNDS)


def _with_highlight(fit: Estimator, lit: IlluminationFit) -> IlluminationFit | None:
    """Add one highlight; None where none reduces the residuals enough."""
    fitted_basis = np.hstack([fit.offset_basis, fit.gain_basis * fit.picture.reshape(-1, 1)])
    highlight = highlight_in(fit.residual, fitted_basis, fit.weight * fit.visible)
    if highlight is None:
        return None
    return _fit_terms(
        fit, np.column_stack([lit.offset_basis, highlight]), lit.gain_basis, lit.weight, rounds=ROUNDS
    )


def _fit_terms(
    fit: Estimator, offset_basis: Array, gain_basis: Array, weight: Array | None, *, rounds: int
) -> IlluminationFit | None:
    fit.offset_basis, fit.gain_basis = offset_basis, gain_basis
    if not fit.solve(rounds, None if weight is None else weight.copy(), free=0):
        return None
    contrast = np.maximum(fit.gain, MIN_GAIN_RATIO * float(np.median(fit.gain)))
    off = np.minimum((fit.residual / (OUTLIER_CONTRAST * contrast)) ** 2, 1.0)
    return IlluminationFit(
        offset_basis=offset_basis,
        gain_basis=gain_basis,
        weight=fit.weight,
        outlier_cells=float(off[fit.visible].sum()),
    )


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
    if not (maximum > 0.0 and maximum**2 > MIN_HIGHLIGHT_RATIO * float(left @ left)):
        return None
    best = _with_slopes(shape)
    for _ in range(HIGHLIGHT_ROUNDS):
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
