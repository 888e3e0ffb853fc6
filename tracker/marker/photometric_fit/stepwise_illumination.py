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

import numpy as np

from tracker.geometry import Array
from tracker.marker.photometric_fit.estimator import Estimator
from tracker.marker.photometric_fit.fit_kernels import OUTLIER_CONTRAST
from tracker.marker.photometric_fit.highlight import highlight_in
from tracker.marker.photometric_fit.illumination import contrasts, shadow_in, smooth_light

MAX_TERMS = 3
FIRST_ROUNDS, ROUNDS = 4, 3
# A term must reduce the unexplained cells to this ratio, and by at least this number.
MAX_LEFT_RATIO, MIN_GAIN_CELLS = 0.93, 5.0
MIN_GAIN_RATIO = 0.25


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
