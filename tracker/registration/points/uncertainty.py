"""Covariance of a point-based fit, and the expected error at a target.

Three points have three residual degrees of freedom. With Fisher's F distribution the stated 95 % region
contains the true pose in 0.92 to 0.98 of simulated cases; with a chi-square distribution it contains fewer.
"""

import numpy as np
import scipy

from tracker.geometry import Anchor, Array, Rigid, Vertebra, skew
from tracker.registration.points.fit import jacobians, weights_on_ct

# Degrees of freedom of the stated noise, which the residuals correct: the localisation error of a landmark is
# larger than that of the tip, and only the residuals contain it.
PRIOR_DEGREES_OF_FREEDOM = 4.0
# A fit better than the stated noise may be chance.
MIN_FACTOR = 0.8
# Residuals do not determine the anisotropy of the noise, which is four times larger or more along the
# camera's depth. By simulation the 95 % region contains 0.92 to 0.97 of the true values for isotropic and for
# anisotropic noise.
ANISOTROPY_FACTOR = 1.2


def degrees_of_freedom(count: int) -> int:
    """Return the residual degrees of freedom of a rigid fit of n points."""
    return 3 * count - 6


def fle_from_fre_mm(fre_mm: float, count: int) -> float:
    """Estimate the FLE (3-D RMS) from the FRE: FLE^2 = n / (n - 2) FRE^2 (Sibson 1979)."""
    return float(np.sqrt(count / (count - 2.0)) * fre_mm)


def expected_tre_mm(fixed_mm: Array, fle_mm: float, target_mm: Array) -> float:
    """Return the expected TRE (3-D RMS) at a target (3,) on the CT, from n landmarks (n, 3).

    TRE^2 = FLE^2 / n (1 + 1/3 sum of d_k^2 / f_k^2): d_k is the distance of the target from principal axis k
    of the landmarks, f_k their RMS distance from it (Fitzpatrick, West and Maurer 1998). Assumes isotropic
    noise, equal for all landmarks.
    """
    middle = fixed_mm.mean(axis=0)
    off = fixed_mm - middle
    squares, axes = np.linalg.eigh(off.T @ off / len(fixed_mm))
    along = axes.T @ (target_mm - middle)
    from_axis = along @ along - along**2
    landmarks_from_axis = squares.sum() - squares
    lever = float((from_axis / landmarks_from_axis).sum())
    return float(fle_mm * np.sqrt((1.0 + lever / 3.0) / len(fixed_mm)))


def variance_from_residuals_mm2(residuals_mm: Array, *, min_fle_mm: float) -> float:
    """Return the variance of a landmark along each axis, from the residuals (n, 3) of an unweighted fit only.

    Few points estimate their variance badly: it is inflated so that the ellipsoid at a target, nominally 95 %
    by a chi-square with three degrees of freedom, contains 95 % (Fisher's F).
    """
    freedom = degrees_of_freedom(len(residuals_mm))
    variance = float((residuals_mm**2).sum()) / freedom * small_sample_factor(freedom) * ANISOTROPY_FACTOR
    return max(variance, min_fle_mm**2 / 3.0)


def variance_ratio_with_more(fre_mm: float, count: int, more: int, *, min_fle_mm: float) -> float:
    """Return the expected ratio of the covariance of an unweighted fit with more landmarks to that without.

    The normal matrix grows with the number of landmarks, by n / (n + more) for equal spread; the variance of
    a landmark is as measured, and inflated less (`variance_from_residuals_mm2`). Not below the minimum FLE.
    """

    def of_mean_mm2(number: int) -> float:
        measured = count * fre_mm**2 / degrees_of_freedom(count)
        inflated = measured * small_sample_factor(degrees_of_freedom(number)) * ANISOTROPY_FACTOR
        return max(inflated, min_fle_mm**2 / 3.0) / number

    return of_mean_mm2(count + more) / of_mean_mm2(count)


def variance_factor(residuals_mm: Array, weights: Array) -> float:
    """Return the factor of stated covariances, from the residuals (n, 3) and their inverses (n, 3, 3).

    The stated noise is corrected by the residuals: strongly if they are larger, weakly if they are smaller.
    By simulation the 95 % region contains 0.95 to 0.98 of the truths if the noise is stated correctly, and
    0.92 if it is 1.4 times as large.
    """
    squares = float(np.einsum("ni,nij,nj->", residuals_mm, weights, residuals_mm))
    return _factor(squares, degrees_of_freedom(len(residuals_mm)))


def factor_ratio_with_more(residuals_mm: Array, weights: Array, more: int) -> float:
    """Return the expected ratio of the covariance of a weighted fit with more landmarks to that without.

    As `variance_ratio_with_more`, of landmarks as precise as these: their weighted squares grow with the
    degrees of freedom, and the factor (`variance_factor`) is inflated less.
    """
    count = len(residuals_mm)
    squares = float(np.einsum("ni,nij,nj->", residuals_mm, weights, residuals_mm))
    now, then = degrees_of_freedom(count), degrees_of_freedom(count + more)
    return _factor(squares * then / now, then) / _factor(squares, now) * count / (count + more)


def _factor(squares: float, freedom_of_residuals: int) -> float:
    freedom = PRIOR_DEGREES_OF_FREEDOM + freedom_of_residuals
    return max(
        (PRIOR_DEGREES_OF_FREEDOM + squares)
        / freedom
        * small_sample_factor(freedom + PRIOR_DEGREES_OF_FREEDOM),
        MIN_FACTOR,
    )


def expected_covariance(fixed_mm: Array, sd_mm: float, *, more: int = 0) -> Array:
    """Return the covariance (6, 6) that an unweighted fit of landmarks (n, 3) is expected to state.

    Of the translation and of a small left-multiplied rotation about the origin of the CT. Each landmark is
    localised with the standard deviation `sd_mm` along each axis, and none has a gross error. n is at least
    4, and the landmarks are not collinear. `more`: so many more landmarks, spread as these.
    """
    middle = fixed_mm.mean(axis=0)
    count = len(fixed_mm)
    factor = small_sample_factor(degrees_of_freedom(count + more)) * ANISOTROPY_FACTOR
    variance_mm2 = sd_mm**2 * factor * count / (count + more)
    weights = np.tile(np.eye(3) / variance_mm2, (count, 1, 1))
    carried = np.eye(6)
    carried[:3, 3:] = skew(middle)
    return np.asarray(carried @ np.linalg.inv(normal_matrix(fixed_mm - middle, weights)) @ carried.T)


def normal_matrix(arms_mm: Array, weights: Array) -> Array:
    """Return the normal matrix (6, 6) of a shift and a rotation, of points at these arms (n, 3)."""
    rows = jacobians(arms_mm)
    return np.asarray(np.einsum("nik,nij,njl->kl", rows, weights, rows))


def common_tip_jacobian(
    fit: Rigid[Vertebra, Anchor], moving_mm: Array, noise_mm2: Array, anchor_from_marker: Array
) -> Array:
    """Return the derivative of the fit (6) with respect to the common tip (3) in the marker frame.

    Captures with equal orientation shift the whole fit, which the residuals do not contain.
    """
    weights = weights_on_ct(fit, noise_mm2)
    rows = jacobians(moving_mm @ fit.rotation.T)
    normal = np.einsum("nik,nij,njl->kl", rows, weights, rows)
    pull = np.einsum("nik,nij,njl->kl", rows, weights, fit.rotation @ anchor_from_marker)
    return np.asarray(-np.linalg.solve(normal, pull))


def small_sample_factor(freedom: float) -> float:
    """Return the inflation of a variance estimated with this number of degrees of freedom."""
    return float(3.0 * scipy.special.fdtri(3, freedom, 0.95) / scipy.special.chdtri(3, 0.05))
