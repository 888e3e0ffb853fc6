"""Least squares where each pose says three numbers: robust start, who agrees, how sure it is."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
from scipy import special

from tracker.geometry import Array

Mask = npt.NDArray[np.bool_]

DRAWS, DRAWN = 300, 5
FINALISTS, CONCENTRATIONS = 10, 10
# A pose that noise alone throws out: one in a thousand.
AGREED_SHARE = 0.999
# Numbers in a file are rounded; what is nearer than this always agrees.
MIN_ALLOWED = 1e-3
MAX_LEVERAGE = 0.95
FREEDOM_BY_POSE = 0.6


@dataclass(frozen=True, slots=True, kw_only=True)
class Equations:
    """What n poses say of k unknowns x: design @ x + offset is zero, but for noise.

    Attributes:
        design: (n, 3, k).
        offset: (n, 3).
    """

    design: Array
    offset: Array

    def of(self, chosen: npt.NDArray[np.bool_] | npt.NDArray[np.int_]) -> "Equations":
        """Those of some poses."""
        return Equations(design=self.design[chosen], offset=self.offset[chosen])

    def residuals(self, x: Array) -> Array:
        """By how much each pose (n, 3) contradicts x (k,)."""
        return np.asarray(self.design @ x + self.offset)

    def whitened(self, whitening: Array) -> "Equations":
        """Each pose's three numbers turned and scaled by its matrix (n, 3, 3)."""
        return Equations(
            design=whitening @ self.design, offset=np.einsum("nij,nj->ni", whitening, self.offset)
        )

    def solved(self) -> Array:
        """The x (k,) with the least sum of squares; the shortest where poses leave a direction open."""
        flat = self.design.reshape(-1, self.design.shape[2])
        return np.asarray(np.linalg.lstsq(flat, -self.offset.reshape(-1), rcond=None)[0])


def robust_start(equations: Equations) -> Array:
    """The x (k,) that fits the better half of the poses best: up to nearly half of them may be anything.

    Least trimmed squares (Rousseeuw and Van Driessen 2006): few poses drawn at random again and again, the
    best draws concentrated on the half that they fit. The draws are the same in every run.
    """
    design, offset = equations.design, equations.offset
    count, unknowns = len(design), design.shape[2]
    random = np.random.default_rng(0)
    drawn = np.argsort(random.random((DRAWS, count)), axis=1)[:, : min(DRAWN, count)]
    normal = np.einsum("nij,nik->njk", design, design)
    right = -np.einsum("nij,ni->nj", design, offset)
    # Draws that leave a direction open must not stop the others.
    ridge = 1e-9 * np.eye(unknowns)
    tried = np.linalg.solve(normal[drawn].sum(axis=1) + ridge, right[drawn].sum(axis=1)[:, :, None])[:, :, 0]
    squares = ((np.einsum("nij,mj->mni", design, tried) + offset) ** 2).sum(axis=2)
    half = min((count + unknowns + 1) // 2, count)
    best, least = np.asarray(tried[0]), np.inf
    for x in tried[np.argsort(np.median(squares, axis=1))[:FINALISTS]]:
        for _ in range(CONCENTRATIONS):
            kept = np.argsort((equations.residuals(x) ** 2).sum(axis=1))[:half]
            x = equations.of(kept).solved()  # noqa: PLW2901  concentrated step by step
        total = float(np.sort((equations.residuals(x) ** 2).sum(axis=1))[:half].sum())
        if total < least:
            best, least = x, total
    return best


def half_that_fits(residuals: Array) -> Mask:
    """The half of the poses with the smallest residuals (n, 3)."""
    squares = (residuals**2).sum(axis=1)
    return np.asarray(squares <= np.median(squares))


def max_allowed(residuals: Array, used: Mask) -> float:
    """The longest residual that noise explains, from the median of all and the shape of those in use.

    Noise may be a ball, a disc (turns behind a long arm) or a line (depth): the median and the tail of the
    squared length are those of a chi-square with as many degrees of freedom as its shape has (Satterthwaite).
    """
    spread = residuals[used].T @ residuals[used]
    power = float(np.trace(spread @ spread))
    freedom = float(np.trace(spread)) ** 2 / power if power > 0.0 else 3.0
    few = (1.0 + 5.0 / max(3 * len(residuals) - 6, 1)) ** 2
    median = float(np.median((residuals**2).sum(axis=1)))
    by_median = float(special.chdtri(freedom, 1.0 - AGREED_SHARE) / special.chdtri(freedom, 0.5))
    return max(float(np.sqrt(few * median * by_median)), MIN_ALLOWED)


def covariance_of(equations: Equations, x: Array, *, numbers: int) -> Array:
    """Covariance (k, k) of the solution x, of which so many numbers are wanted, from the residuals alone.

    The sandwich of White (1980) in its leave-one-out form (HC3, MacKinnon and White 1985), a pose for a
    block, since the noise of a pose has no known shape. Two things are added, so that the 95 % ellipsoid by
    the chi-square of these numbers holds the truth as often as it says: few poses know their own spread badly
    (by the F distribution), and neighbouring images that err alike count as one.
    """
    design, residuals = equations.design, equations.residuals(x)
    inverse = np.linalg.pinv(np.einsum("nij,nik->jk", design, design), hermitian=True)
    leverage = design @ inverse @ design.transpose(0, 2, 1)
    values, ways = np.linalg.eigh(leverage)
    left = 1.0 / (1.0 - np.minimum(values, MAX_LEVERAGE))
    unseen = np.einsum("nij,nj,nkj,nk->ni", ways, left, ways, residuals)
    scores = np.einsum("nij,ni->nj", design, unseen)
    sandwich = inverse @ (scores.T @ scores) @ inverse
    return np.asarray(sandwich * _few_poses(len(design), numbers) * alike_neighbours(residuals))


def alike_neighbours(residuals: Array) -> float:
    """By how much the variance grows since residuals (n, 3) in a row are alike; 1 where they are not."""
    count = len(residuals)
    power = float((residuals**2).sum())
    if count < 4 or power <= 0.0:
        return 1.0
    # Three standard deviations of what independent noise shows: below, nothing is claimed.
    probability = 3.0 / np.sqrt(3.0 * count)
    grown = 1.0
    for lag in range(1, count // 4):
        alike = float((residuals[lag:] * residuals[:-lag]).sum()) / power
        if alike < probability:
            break
        grown += 2.0 * alike
    return grown


def _few_poses(count: int, numbers: int) -> float:
    # How many degrees of freedom a sandwich of so many poses has: found by simulation of many kinds of noise.
    freedom = max(FREEDOM_BY_POSE * (count - 3), 1.0)
    return float(numbers * special.fdtri(numbers, freedom, 0.95) / special.chdtri(numbers, 0.05))
