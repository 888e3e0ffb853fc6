"""Rejection of squares that the rotated or mirrored model fits as well.

For a marker that is similar to its own quarter rotation (correlation 0.83), the wrong rotation with a fitted
highlight can fit better than the right one. A marker is therefore accepted only if no other rotation with its
own highlight fits as well, and under occlusion or highlights only if its mirror image does not fit better. If
two fits at one position contradict each other, neither is accepted. This removes ten of twelve wrong
rotations in a thousand scenes under glare.
"""

import numpy as np
import numpy.typing as npt

from tracker.geometry import Array
from tracker.marker.photometric_fit.estimator import Estimator, inside_square
from tracker.marker.photometric_fit.grid_kernels import GRID_CELLS, render_model
from tracker.marker.photometric_fit.occlusion import OUTLIER_RESIDUAL_CONTRAST, unoccluded_weights
from tracker.marker.sampling_kernels import through

# Minimum difference in inlier cells to the other rotations. A highlight fitted to a wrong rotation has up to
# 5 more than the right one if the shape is similar to its own rotation.
MIN_MARGIN_CELLS = 8.0
# A marker may be nearly its own mirror image.
MAX_SIMILARITY = 0.9
LIGHT_ROUNDS, ROUNDS = 3, 6


def rotation_is_ambiguous(fit: Estimator) -> bool:
    """Return whether a rotation by a quarter or more fits nearly as well, or the mirror image better.

    Under highlights many shapes fit: there each rotation is fitted with its own position, blur and
    illumination.
    """
    own = _unexplained_cells(fit)
    if _another_is_nearer_in_place(fit):
        return True
    return fit.has_highlight_terms and any(
        _unexplained_refitted(fit, quarter_turns) < own for quarter_turns in (1, 2, 3)
    )


def _unexplained_cells(fit: Estimator) -> float:
    """Return the number of outlier cells of the square after a fit."""
    off = fit.residual / (OUTLIER_RESIDUAL_CONTRAST * np.maximum(fit.gain, 0.25 * float(np.median(fit.gain))))
    return float(np.minimum(off**2, 1.0)[inside_square()].sum())


def _another_is_nearer_in_place(fit: Estimator) -> bool:
    """Return whether, at the same position, another rotation fits nearly as well or a mirror image better."""
    visible, fit.visible = fit.visible, np.ones((GRID_CELLS, GRID_CELLS), np.bool_)
    rendered, weight, reference_gain = fit.rendered.copy(), fit.weight.copy(), fit.reference_gain.copy()
    own, *others = (_unexplained_as(fit, quarter_turns, weight) for quarter_turns in range(4))
    mirrored = [
        _unexplained_as(fit, quarter_turns, weight, mirror_of=rendered[0]) for quarter_turns in range(4)
    ]
    fit.visible, fit.rendered, fit.weight, fit.reference_gain = visible, rendered, weight, reference_gain
    return own > min(others) - MIN_MARGIN_CELLS or own > min(mirrored)


def _unexplained_as(
    fit: Estimator, quarter_turns: int, weight: Array, *, mirror_of: npt.NDArray[np.float32] | None = None
) -> float:
    """Return the unexplained cells of the rotated or mirrored model; inf if nearly mirror-symmetric."""
    sign = 1.0 if mirror_of is None else -1.0
    blur, ahead = fit.blur * (1.0, 1.0, sign), fit.ahead * np.array([[sign], [1.0]])
    for _ in range(quarter_turns):
        # The image is rotated back afterwards.
        blur, ahead = np.array([blur[1], blur[0], -blur[2]]), np.array([ahead[1], -ahead[0]])
    render_model(fit.pictures.layers, fit.pictures.blurs_cells, blur, ahead, fit.rendered)
    fit.rendered[0] = np.rot90(fit.rendered[0], quarter_turns).copy()
    if mirror_of is not None:
        fit.rendered[0] = fit.rendered[0][:, ::-1].copy()
        inside = inside_square()
        if np.corrcoef(fit.rendered[0][inside], mirror_of[inside])[0, 1] > MAX_SIMILARITY:
            return np.inf
    return _unexplained_cells(fit) if fit.solve(LIGHT_ROUNDS, weight.copy(), free=0) else np.inf


def _unexplained_refitted(fit: Estimator, quarter_turns: int) -> float:
    """Return the unexplained cells of the rotated model after its own fit."""
    corners_px = np.array([through(fit.to_px, a, b) for a, b in fit.corners])
    other = Estimator(fit.image, fit.pictures, np.roll(corners_px, -quarter_turns, axis=0), fit.side_px)
    other.offset_basis, other.gain_basis = (
        _rotated(fit.offset_basis, quarter_turns),
        _rotated(fit.gain_basis, quarter_turns),
    )
    other.sample()
    walked = other.solve(ROUNDS, unoccluded_weights(other.observed, other.picture))
    return _unexplained_cells(other) if walked else np.inf


def _rotated(offset_basis: Array, quarter_turns: int) -> Array:
    """Return a basis (cells, n) rotated by quarter turns."""
    rotated = np.rot90(offset_basis.reshape(GRID_CELLS, GRID_CELLS, -1), quarter_turns)
    return np.ascontiguousarray(rotated.reshape(GRID_CELLS * GRID_CELLS, -1))
