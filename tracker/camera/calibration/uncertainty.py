"""Uncertainty of camera parameters from the residuals.

With independent errors, intervals from the residuals contain the true value for 95 of 100 cameras. Errors
of neighbouring corners are not independent: blur, a bent board or the detector moves them together. Even a
correlation too weak to be detected (0.03 px in common among 0.15 px) makes errors a fifth larger, so that
standard deviations are never smaller than those of a jackknife over views, which needs no independence within
a view. Where correlation is detected, Student's t allows for the few views too.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy

from tracker.camera.calibration.blocks import Block, inverse, total_information
from tracker.camera.detection.view import BoardView
from tracker.geometry import Array

# Independent errors exceed this correlation in about one of a thousand calibrations.
CORRELATED_SDS = 3.3
MIN_VIEWS_FOR_DIFFERENCES = 4


@dataclass(frozen=True, slots=True, kw_only=True)
class Uncertainty:
    """Covariance of the shared parameters.

    Attributes:
        covariance: (p, p).
        degrees_of_freedom: for Student's t.
        noise_px: standard deviation of one coordinate.
        is_noise_correlated: whether errors are found to be correlated.
    """

    covariance: Array
    degrees_of_freedom: int
    noise_px: float
    is_noise_correlated: bool

    @property
    def reach_95(self) -> Array:
        """Return half of each 95 % interval (p,)."""
        return np.asarray(
            scipy.special.stdtrit(self.degrees_of_freedom, 0.975) * np.sqrt(np.diag(self.covariance))
        )


def uncertainty(blocks: Sequence[Block], *, is_noise_correlated: bool) -> Uncertainty:
    """Return the covariance from the points' noise and from a jackknife over views, the larger of both.

    The jackknife (first order) holds for errors common to a view. With few views it is itself uncertain,
    which Student's t with few degrees of freedom takes into account where correlation is detected. Only there
    it also determines the correlations between the parameters.
    """
    information = total_information(blocks)
    shared = information.shape[0]
    free = sum(block.coordinates - block.own for block in blocks) - shared
    variance_px2 = sum(block.squares_px2 for block in blocks) / max(free, 1)
    plain = inverse(information) * variance_px2
    count = len(blocks)
    if count < MIN_VIEWS_FOR_DIFFERENCES:
        return Uncertainty(
            covariance=plain,
            degrees_of_freedom=max(free, 1),
            noise_px=float(np.sqrt(variance_px2)),
            is_noise_correlated=is_noise_correlated,
        )
    moved = np.array([-inverse(information - one.information) @ one.gradient for one in blocks])
    spread = (count - 1) / count * moved.T @ moved
    sds, plain_sds = np.sqrt(np.diag(spread)), np.sqrt(np.diag(plain))
    if not is_noise_correlated:
        widened = np.maximum(1.0, sds / np.maximum(plain_sds, 1e-300))
        return Uncertainty(
            covariance=plain * widened[:, None] * widened[None, :],
            degrees_of_freedom=max(free, 1),
            noise_px=float(np.sqrt(variance_px2)),
            is_noise_correlated=False,
        )
    # The jackknife of few views may be too small by chance, but correlated points never contain more
    # information than independent ones.
    scale = np.maximum(1.0, plain_sds / np.maximum(sds, 1e-300))
    return Uncertainty(
        covariance=spread * scale[:, None] * scale[None, :],
        degrees_of_freedom=count - 1,
        noise_px=float(np.sqrt(variance_px2)),
        is_noise_correlated=True,
    )


def noise_is_correlated(
    views: Sequence[BoardView], residuals_px: Sequence[Array], blocks: Sequence[Block]
) -> bool:
    """Return whether errors of neighbouring points are correlated, or the variance differs between views."""
    products, squares, pairs = 0.0, 0.0, 0
    for view, residual in zip(views, residuals_px, strict=True):
        couples = _neighbours(view)
        products += float((residual[couples[:, 0]] * residual[couples[:, 1]]).sum())
        squares += float((residual[couples] ** 2).sum()) / 2.0
        pairs += 2 * len(couples)
    if pairs and products / squares * np.sqrt(pairs) > CORRELATED_SDS:
        return True
    mean_px2 = sum(b.squares_px2 for b in blocks) / sum(b.coordinates for b in blocks)
    ratios = np.array([b.squares_px2 / b.coordinates / mean_px2 for b in blocks])
    free = np.array([b.coordinates - b.own for b in blocks], dtype=np.float64)
    chi2 = float((((ratios - 1.0) ** 2) * free / 2.0).sum())
    return chi2 > float(scipy.special.chdtri(len(blocks) - 1, 0.0005))


def _neighbours(view: BoardView) -> Array:
    """Return the pairs of points (m, 2) that are adjacent on the board."""
    points = view.object_points_mm[:, :2]
    tree = scipy.spatial.KDTree(points)
    nearest, _ = tree.query(points, k=2)
    pairs = tree.query_pairs(1.05 * float(np.median(nearest[:, 1])), output_type="ndarray")
    return np.asarray(pairs).reshape(-1, 2)
