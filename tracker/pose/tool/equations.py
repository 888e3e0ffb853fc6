"""Robust linear least squares with three equations per pose: start, inliers, covariance."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import scipy

from tracker.geometry import Array

Mask = npt.NDArray[np.bool_]

TRIALS, SAMPLE_SIZE = 300, 5
FINALISTS, CONCENTRATIONS = 10, 10
# Probability that an inlier is accepted: noise alone excludes one pose in a thousand.
INLIER_PROBABILITY = 0.999
# A pose with a smaller residual is always an inlier, because numbers in a file are rounded.
MIN_ALLOWED = 1e-3
MAX_LEVERAGE = 0.95
FREEDOM_BY_POSE = 0.6


@dataclass(frozen=True, slots=True, kw_only=True)
class Equations:
    """Linear equations of n poses for k unknowns x: residual = design @ x + offset.

    Attributes:
        design: (n, 3, k).
        offset: (n, 3).
    """

    design: Array
    offset: Array

    def of(self, chosen: npt.NDArray[np.bool_] | npt.NDArray[np.int_]) -> "Equations":
        """Return the equations of some poses."""
        return Equations(design=self.design[chosen], offset=self.offset[chosen])

    def residuals(self, x: Array) -> Array:
        """Return the residuals (n, 3) of x (k,)."""
        return np.asarray(self.design @ x + self.offset)

    def whitened(self, whitening: Array) -> "Equations":
        """Return the equations multiplied by each pose's whitening matrix (n, 3, 3)."""
        return Equations(
            design=whitening @ self.design, offset=np.einsum("nij,nj->ni", whitening, self.offset)
        )

    def solved(self) -> Array:
        """Return the least-squares solution (k,), of minimum norm where a direction is undetermined."""
        flat = self.design.reshape(-1, self.design.shape[2])
        return np.asarray(np.linalg.lstsq(flat, -self.offset.reshape(-1), rcond=None)[0], dtype=float)


def least_trimmed_squares(equations: Equations) -> Array:
    """Return the least trimmed squares estimate (k,); up to nearly half of the poses may be outliers.

    FAST-LTS (Rousseeuw and Van Driessen 2006): random samples of a few poses, then concentration steps on the
    best half for the best samples. The random numbers are seeded, so the result is deterministic.
    """
    design, offset = equations.design, equations.offset
    count, unknowns = len(design), design.shape[2]
    random = np.random.default_rng(0)
    drawn = np.argsort(random.random((TRIALS, count)), axis=1)[:, : min(SAMPLE_SIZE, count)]
    normal = np.einsum("nij,nik->njk", design, design)
    right = -np.einsum("nij,ni->nj", design, offset)
    # Regularises samples with an undetermined direction.
    ridge = 1e-9 * np.eye(unknowns)
    tried = np.linalg.solve(normal[drawn].sum(axis=1) + ridge, right[drawn].sum(axis=1)[:, :, None])[:, :, 0]
    squares = ((np.einsum("nij,mj->mni", design, tried) + offset) ** 2).sum(axis=2)
    half = min((count + unknowns + 1) // 2, count)
    best, min_cost = np.asarray(tried[0]), np.inf
    for x in tried[np.argsort(np.median(squares, axis=1))[:FINALISTS]]:
        for _ in range(CONCENTRATIONS):
            best_poses = np.argsort((equations.residuals(x) ** 2).sum(axis=1))[:half]
            x = equations.of(best_poses).solved()  # noqa: PLW2901  concentrated step by step
        total = float(np.sort((equations.residuals(x) ** 2).sum(axis=1))[:half].sum())
        if total < min_cost:
            best, min_cost = x, total
    return best


def best_half(residuals: Array) -> Mask:
    """Return the mask of the half of the poses with the smallest residuals (n, 3)."""
    squares = (residuals**2).sum(axis=1)
    return np.asarray(squares <= np.median(squares))


def max_allowed(residuals: Array, used: Mask) -> float:
    """Return the inlier limit of a residual's length, from the median of all and the spread of the inliers.

    The noise may be isotropic, a disc (rotation with a long lever) or a line (depth). The squared length is
    modelled as a chi-square with the effective degrees of freedom of that shape (Satterthwaite).
    """
    spread = residuals[used].T @ residuals[used]
    power = float(np.trace(spread @ spread))
    freedom = float(np.trace(spread)) ** 2 / power if power > 0.0 else 3.0
    few = (1.0 + 5.0 / max(3 * len(residuals) - 6, 1)) ** 2
    median = float(np.median((residuals**2).sum(axis=1)))
    by_median = float(
        scipy.special.chdtri(freedom, 1.0 - INLIER_PROBABILITY) / scipy.special.chdtri(freedom, 0.5)
    )
    return max(float(np.sqrt(few * median * by_median)), MIN_ALLOWED)


def covariance_of(equations: Equations, x: Array, *, numbers: int) -> Array:
    """Return the covariance (k, k) of the solution x from the residuals; `numbers` of them are of interest.

    The sandwich estimator of White (1980) in its leave-one-out form (HC3, MacKinnon and White 1985), with one
    block per pose, since the shape of a pose's noise is unknown. Two factors give the 95 % chi-square
    ellipsoid of `numbers` values its nominal coverage: one for few poses (by the F distribution), one for
    errors correlated between neighbouring images.
    """
    design, residuals = equations.design, equations.residuals(x)
    inverse = np.linalg.pinv(np.einsum("nij,nik->jk", design, design), hermitian=True)
    leverage = design @ inverse @ design.transpose(0, 2, 1)
    values, ways = np.linalg.eigh(leverage)
    left = 1.0 / (1.0 - np.minimum(values, MAX_LEVERAGE))
    left_out_residuals = np.einsum("nij,nj,nkj,nk->ni", ways, left, ways, residuals)
    scores = np.einsum("nij,ni->nj", design, left_out_residuals)
    sandwich = inverse @ (scores.T @ scores) @ inverse
    return np.asarray(sandwich * _few_poses(len(design), numbers) * autocorrelation_factor(residuals))


def autocorrelation_factor(residuals: Array) -> float:
    """Return the variance inflation of autocorrelated residuals (n, 3); 1 without autocorrelation."""
    count = len(residuals)
    power = float((residuals**2).sum())
    if count < 4 or power <= 0.0:
        return 1.0
    # Three standard deviations of the autocorrelation of independent noise: below, it counts as 0.
    limit = 3.0 / np.sqrt(3.0 * count)
    inflation = 1.0
    for lag in range(1, count // 4):
        correlation = float((residuals[lag:] * residuals[:-lag]).sum()) / power
        if correlation < limit:
            break
        inflation += 2.0 * correlation
    return inflation


def _few_poses(count: int, numbers: int) -> float:
    # Effective degrees of freedom of the sandwich estimator, found by simulation of many kinds of noise.
    freedom = max(FREEDOM_BY_POSE * (count - 3), 1.0)
    return float(numbers * scipy.special.fdtri(numbers, freedom, 0.95) / scipy.special.chdtri(numbers, 0.05))
