"""How sure each number of a camera is, from what its residuals themselves show.

With independent errors, residuals and Student's t cover the truth in 95 of 100 cameras. Real boards bend
and blur; there the jackknife over views is used, and is never narrower.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from scipy import special
from scipy.spatial import cKDTree

from tracker.camera.calibration.blocks import Block, inverse, total_information
from tracker.camera.detection.view import BoardView
from tracker.geometry import Array

# By chance alone, errors of points that are independent look alike once in about a thousand calibrations.
ALIKE_SDS = 3.3
MIN_VIEWS_FOR_DIFFERENCES = 4


@dataclass(frozen=True, slots=True, kw_only=True)
class Uncertainty:
    """The covariance of the shared numbers.

    Attributes:
        covariance: (p, p).
        degrees_of_freedom: for Student's t.
        noise_px: standard deviation of one coordinate.
        is_noise_alike: it comes from the differences between views.
    """

    covariance: Array
    degrees_of_freedom: int
    noise_px: float
    is_noise_alike: bool

    @property
    def reach_95(self) -> Array:
        """Half of each 95 % interval (p,)."""
        return np.asarray(special.stdtrit(self.degrees_of_freedom, 0.975) * np.sqrt(np.diag(self.covariance)))


def uncertainty(blocks: Sequence[Block], *, is_noise_alike: bool) -> Uncertainty:
    """The covariance from the points' noise, or from how the views differ where the noise is alike.

    The second leaves one view out after the other (jackknife, first order): it holds for errors in common
    to a view, and is itself unsure where views are few, which Student's t with few degrees of freedom says.
    """
    information = total_information(blocks)
    shared = information.shape[0]
    free = sum(block.coordinates - block.own for block in blocks) - shared
    variance_px2 = sum(block.squares_px2 for block in blocks) / max(free, 1)
    plain = inverse(information) * variance_px2
    count = len(blocks)
    if not is_noise_alike or count < MIN_VIEWS_FOR_DIFFERENCES:
        return Uncertainty(
            covariance=plain,
            degrees_of_freedom=max(free, 1),
            noise_px=float(np.sqrt(variance_px2)),
            is_noise_alike=is_noise_alike,
        )
    moved = np.array([-inverse(information - one.information) @ one.gradient for one in blocks])
    spread = (count - 1) / count * moved.T @ moved
    # Differences of few views may come out small by chance; points that are alike never say more than
    # independent ones.
    sds, plain_sds = np.sqrt(np.diag(spread)), np.sqrt(np.diag(plain))
    scale = np.maximum(1.0, plain_sds / np.maximum(sds, 1e-300))
    return Uncertainty(
        covariance=spread * scale[:, None] * scale[None, :],
        degrees_of_freedom=count - 1,
        noise_px=float(np.sqrt(variance_px2)),
        is_noise_alike=True,
    )


def noise_is_alike(
    views: Sequence[BoardView], residuals_px: Sequence[Array], blocks: Sequence[Block]
) -> bool:
    """Whether errors of neighbouring points go together, or views are of different quality."""
    products, squares, pairs = 0.0, 0.0, 0
    for view, residual in zip(views, residuals_px, strict=True):
        couples = _neighbours(view)
        products += float((residual[couples[:, 0]] * residual[couples[:, 1]]).sum())
        squares += float((residual[couples] ** 2).sum()) / 2.0
        pairs += 2 * len(couples)
    if pairs and products / squares * np.sqrt(pairs) > ALIKE_SDS:
        return True
    mean_px2 = sum(b.squares_px2 for b in blocks) / sum(b.coordinates for b in blocks)
    ratios = np.array([b.squares_px2 / b.coordinates / mean_px2 for b in blocks])
    free = np.array([b.coordinates - b.own for b in blocks], dtype=np.float64)
    chi2 = float((((ratios - 1.0) ** 2) * free / 2.0).sum())
    return chi2 > float(special.chdtri(len(blocks) - 1, 0.0005))


def _neighbours(view: BoardView) -> Array:
    """Pairs of points (m, 2) that are next to each other on the board."""
    points = view.object_points_mm[:, :2]
    tree = cKDTree(points)
    nearest, _ = tree.query(points, k=2)
    pairs = tree.query_pairs(1.05 * float(np.median(nearest[:, 1])), output_type="ndarray")
    return np.asarray(pairs).reshape(-1, 2)
