"""Intervals of standard deviations, variance components, shares and jackknifed figures, at 95 %."""

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt
import scipy

from tracker.geometry import Array

TAIL = 0.025


@dataclass(frozen=True, slots=True, kw_only=True)
class Estimate:
    """A value with the bounds of its 95 % confidence interval."""

    value: float
    low: float
    high: float


@dataclass(frozen=True, slots=True, kw_only=True)
class VarianceComponents:
    """One-way random-effects analysis of vectors in groups, with anisotropic covariances.

    A vector of dimension 3 whose covariance has unequal eigenvalues has fewer than three degrees of freedom:
    h = trace(C)^2 / trace(C^2), between 1 and 3 (Satterthwaite 1946).

    Attributes:
        between_mm2, within_mm2: (3, 3), mean squares; their expectations are within + size * component, and
            within.
        between_vectors, within_vectors: degrees of freedom in vectors.
        size: mean size of a group.
    """

    between_mm2: Array
    within_mm2: Array
    between_vectors: float
    within_vectors: float
    size: float

    @property
    def total_mm2(self) -> Array:
        """Return the covariance (3, 3) of one vector.

        A between component that is estimated as negative counts as zero: postures that are the same in all
        groups have effects that add to the mean square within groups, and cancel between them.
        """
        return np.asarray(self.within_mm2 + self.component_mm2)

    @property
    def component_mm2(self) -> Array:
        """Return the covariance (3, 3) of the effects of groups, without its negative eigenvalues."""
        values, vectors = np.linalg.eigh((self.between_mm2 - self.within_mm2) / self.size)
        return np.asarray((vectors * np.maximum(values, 0.0)) @ vectors.T)

    @property
    def between_freedom(self) -> float:
        """Return the effective degrees of freedom of the trace of `between_mm2`."""
        return self.between_vectors * effective_dimension(self.between_mm2)

    @property
    def within_freedom(self) -> float:
        """Return the effective degrees of freedom of the trace of `within_mm2`."""
        return self.within_vectors * effective_dimension(self.within_mm2)


def variance_components(
    vectors: Array, groups: npt.NDArray[np.int_], *, fitted_parameters: int
) -> VarianceComponents:
    """Return the components of residual vectors (n, 3) in groups (n,).

    `fitted_parameters` of the fit that left these residuals are subtracted from the degrees of freedom
    between groups: the pose of a plate follows the means of its divots.
    """
    count = len(vectors)
    sizes = np.bincount(groups)
    means = np.stack([np.bincount(groups, axis) / sizes for axis in vectors.T], axis=1)
    inside = vectors - means[groups]
    between_vectors = len(sizes) - fitted_parameters / 3.0
    within_vectors = float(count - len(sizes))
    return VarianceComponents(
        between_mm2=(means * sizes[:, None]).T @ means / between_vectors,
        within_mm2=inside.T @ inside / within_vectors,
        between_vectors=between_vectors,
        within_vectors=within_vectors,
        size=(count - (sizes**2).sum() / count) / (len(sizes) - 1),
    )


def effective_dimension(covariance: Array) -> float:
    """Return trace(C)^2 / trace(C^2) of a covariance (3, 3); 1 for a zero matrix."""
    square = float((covariance * covariance).sum())
    return float(np.trace(covariance) ** 2 / square) if square > 0.0 else 1.0


def rms_estimate(mean_square: float, freedom: float) -> Estimate:
    """Return the root of a mean square with its chi-square interval."""
    low, high = (freedom * mean_square / scipy.stats.chi2.ppf(p, freedom) for p in (1.0 - TAIL, TAIL))
    return Estimate(value=mean_square**0.5, low=float(low) ** 0.5, high=float(high) ** 0.5)


def component_estimate(found: VarianceComponents) -> Estimate:
    """Return the RMS of the group effects, with the interval of Ting, Burdick, Graybill et al. (1990)."""
    between, within = float(np.trace(found.between_mm2)), float(np.trace(found.within_mm2))
    n1, n2 = found.between_freedom, found.within_freedom
    f_low, f_high = (float(scipy.stats.f.ppf(p, n1, n2)) for p in (TAIL, 1.0 - TAIL))
    g1, g2 = (1.0 - n / float(scipy.stats.chi2.ppf(1.0 - TAIL, n)) for n in (n1, n2))
    h1, h2 = (n / float(scipy.stats.chi2.ppf(TAIL, n)) - 1.0 for n in (n1, n2))
    g12 = ((f_high - 1.0) ** 2 - (g1 * f_high) ** 2 - h2**2) / f_high
    h12 = ((1.0 - f_low) ** 2 - (h1 * f_low) ** 2 - g2**2) / f_low
    value = (between - within) / found.size
    down = (g1 * between) ** 2 + (h2 * within) ** 2 + g12 * between * within
    up = (h1 * between) ** 2 + (g2 * within) ** 2 + h12 * between * within
    low = value - max(down, 0.0) ** 0.5 / found.size
    high = value + max(up, 0.0) ** 0.5 / found.size
    return Estimate(value=max(value, 0.0) ** 0.5, low=max(low, 0.0) ** 0.5, high=max(high, value, 0.0) ** 0.5)


def quantile_95_mm(covariance_mm2: Array) -> float:
    """Return the 95th percentile of the length of a normal vector with this covariance (3, 3).

    The squared length is approximated by a scaled chi-square distribution with the same first two moments.
    """
    dimension = effective_dimension(covariance_mm2)
    return float(np.sqrt(np.trace(covariance_mm2) / dimension * scipy.stats.chi2.ppf(0.95, dimension)))


def share_estimate(inside: npt.NDArray[np.bool_], effective_count: float) -> Estimate:
    """Return the share of true values, with the interval of Clopper and Pearson for an effective count."""
    share = float(inside.mean())
    hits = share * effective_count
    misses = effective_count - hits
    low = float(scipy.stats.beta.ppf(TAIL, hits, misses + 1.0)) if hits > 0.0 else 0.0
    high = float(scipy.stats.beta.ppf(1.0 - TAIL, hits + 1.0, misses)) if misses > 1e-9 else 1.0
    return Estimate(value=share, low=low, high=high)


def mean_square_estimate(squares: Array) -> Estimate:
    """Return the root mean of squares (n,), one for each capture, with its Student interval."""
    mean = float(squares.mean())
    half = float(scipy.stats.t.ppf(1.0 - TAIL, len(squares) - 1) * squares.std(ddof=1) / len(squares) ** 0.5)
    return Estimate(value=mean**0.5, low=max(mean - half, 0.0) ** 0.5, high=(mean + half) ** 0.5)


@dataclass(frozen=True, slots=True, kw_only=True)
class JackknifeRms:
    """A root mean square with its uncertainty from a jackknife over groups.

    Groups and not samples are left out one after the other, because samples of one group share an error. The
    distribution is of the logarithm of the mean square. Unlike a chi-square interval it holds for noise that
    differs between near and far, or between one posture of the tool and another.

    Attributes:
        mean_square: the estimate.
        log_sd: standard deviation of its logarithm.
        groups: number of groups.
    """

    mean_square: float
    log_sd: float
    groups: int

    @property
    def estimate(self) -> Estimate:
        """Return the root mean square with its 95 % interval."""
        return Estimate(value=self.mean_square**0.5, low=self._limit(TAIL), high=self._limit(1.0 - TAIL))

    @property
    def upper_95(self) -> float:
        """Return the one-sided upper 95 % limit of the root mean square."""
        return self._limit(0.95)

    def _limit(self, probability: float) -> float:
        log = float(scipy.stats.t.ppf(probability, self.groups - 1)) * self.log_sd
        return float(np.sqrt(self.mean_square * np.exp(log)))


def jackknife_rms(
    mean_square: Callable[[npt.NDArray[np.bool_]], float],
    groups: npt.NDArray[np.int_],
    *,
    value: float | None = None,
    freedom: float | None = None,
) -> JackknifeRms:
    """Return a root mean square with its uncertainty.

    Args:
        mean_square: called with a mask (n,) of the samples that remain.
        groups: (n,) group of each sample.
        value: a better estimate of the mean square; default: that of all samples.
        freedom: degrees of freedom of normal samples, below whose uncertainty a jackknife of few groups can
            be by chance.
    """
    of_all = mean_square(np.ones(len(groups), dtype=np.bool_))
    count = int(groups.max()) + 1
    logs = np.zeros(count)
    if of_all > 0.0:
        logs = np.log([max(mean_square(groups != one), 1e-12 * of_all) for one in range(count)])
    sd = float(np.sqrt((count - 1) / count * ((logs - logs.mean()) ** 2).sum()))
    if freedom is not None and of_all > 0.0:
        sd = max(sd, (2.0 / freedom) ** 0.5)
    return JackknifeRms(mean_square=of_all if value is None else value, log_sd=sd, groups=count)
