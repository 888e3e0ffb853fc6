"""Selection of the illumination model: planar, multiplicative (shadow), additive (highlight) or both.

Shadows and lamps are static from image to image, so the illumination of one image is reused for the next ten
as long as the residuals do not grow; a step under a shadow's edge or a highlight then takes 3 to 8 ms instead
of 6 to 24. It is reused only where one planar solution is possible, because a fitted illumination belongs to
one pose. A change of its kind may be detected some images late.
"""

from dataclasses import dataclass

import numpy as np

from tracker.geometry import Array
from tracker.photometric.equation_kernels import illumination_pattern_chi2
from tracker.photometric.fit import (
    CONVERGED_REFIT_CHI2,
    CUTOFF_SDS,
    MAX_ITERATIONS,
    FitResult,
    fit_pose,
    plausible_fits,
    refit,
    refit_all,
    robust_chi2_of,
)
from tracker.photometric.illumination_kernels import (
    ADDITIVE,
    FREE,
    MULTIPLICATIVE,
    PLANAR,
    from_planar,
    parameter_count,
    typical_contrast,
)
from tracker.photometric.response_kernels import RESPONSE
from tracker.photometric.samples import Samples, subsample

# Spline nodes per side: the edge of a shadow is a fifth of the marker wide, a highlight less.
SPLINE_NODES = 10
# Residuals under planar illumination, in units of noise and of contrast, above which a spline is tried.
PLANAR_RESIDUAL_NOISES, PLANAR_RESIDUAL_CONTRAST_RATIO = 1.4, 0.02
# Noise, compression blocks and background give a chi-square below 30; a shadow that halves the illumination,
# or a highlight of half the contrast, above 150.
MIN_PATTERN_CHI2 = 80.0
# Penalty on the model with two splines, which always fits at least as well as the nested model with one.
FREE_PENALTY_CHI2 = 50.0
# Pixels and iterations of the model selection; a model that then costs this much more is dropped.
TEST_PIXELS, TEST_ROUNDS, DROP_CHI2 = 600, 2, 60.0
# The illumination of an image is reused this often while the residuals grow by at most this factor.
MAX_IMAGES, MAX_RESIDUAL_GROWTH = 10, 1.15


@dataclass(frozen=True, slots=True, kw_only=True)
class KnownIllumination:
    """Spline illumination fitted to an earlier image.

    Attributes:
        illumination: kind, and spline nodes per side.
        parameters: blur, response and illumination, as `refine_pose` orders them.
        residual_sd_grey: sd of the residuals of that fit.
        images: number of images it has been reused for.
    """

    illumination: tuple[int, int]
    parameters: Array
    residual_sd_grey: float
    images: int


def known_illumination_from(one: FitResult, before: KnownIllumination | None) -> KnownIllumination | None:
    """Return the illumination of a fit for reuse; None where it is planar."""
    if one.illumination[0] == PLANAR:
        return None
    images = 0 if before is None else before.images + 1
    return KnownIllumination(
        illumination=one.illumination,
        parameters=one.parameters,
        residual_sd_grey=one.residual_sd_grey,
        images=images,
    )


def fit_in_known_illumination(
    samples: Samples, rotation: Array, translation_mm: Array, known: KnownIllumination
) -> FitResult | None:
    """Fit a pose near the illumination of the previous image; None where the residuals have grown."""
    if known.images >= MAX_IMAGES:
        return None
    subset = subsample(samples, TEST_PIXELS)
    one = fit_pose(
        subset,
        rotation,
        translation_mm,
        known.parameters,
        illumination=known.illumination,
        min_gain_chi2=CONVERGED_REFIT_CHI2,
    )
    if one is None or one.residual_sd_grey > MAX_RESIDUAL_GROWTH * known.residual_sd_grey:
        return None
    return one if subset is samples else refit(samples, one)


def has_large_residuals(fits: list[FitResult], noise_grey: float) -> bool:
    """Return whether the residuals of the best fit under planar illumination exceed the noise level."""
    best = min(fits, key=lambda one: one.residual_sd_grey)
    contrast = float(typical_contrast(best.parameters, best.illumination))
    return best.residual_sd_grey > max(
        PLANAR_RESIDUAL_NOISES * noise_grey, PLANAR_RESIDUAL_CONTRAST_RATIO * contrast
    )


def has_illumination_pattern(samples: Samples, even: list[FitResult]) -> bool:
    """Return whether the residuals of the best planar-illumination fit contain smooth illumination."""
    best = min(even, key=lambda one: one.residual_sd_grey)
    pattern = illumination_pattern_chi2(
        samples.values, best.prediction, float(best.parameters[RESPONSE]), best.residual_sd_grey, CUTOFF_SDS
    )
    return float(pattern) > MIN_PATTERN_CHI2


def select_illumination(samples: Samples, even: list[FitResult], noise_grey: float) -> list[FitResult]:
    """Refit the poses under the simplest adequate illumination model; return them unchanged if none fits."""
    subset = subsample(samples, TEST_PIXELS)
    first = _best_illumination(samples, subset, even[0], noise_grey)
    if first is None:
        return even
    others = [
        _start_in_illumination(subset, one, first.illumination[0], max_iterations=MAX_ITERATIONS)
        for one in even[1:]
    ]
    return [first, *_fit_subset_to_all(samples, subset, others)]


def _best_illumination(
    samples: Samples, subset: Samples, even: FitResult, noise_grey: float
) -> FitResult | None:
    """Return the fit under the best illumination near this pose; None where none converges."""
    begun = [_start_in_illumination(subset, even, kind) for kind in (MULTIPLICATIVE, ADDITIVE)]
    plausible = plausible_fits(subset, [one for one in begun if one is not None], DROP_CHI2)
    fits = refit_all(samples, plausible)
    # A model whose residuals are at the noise level needs no extension.
    if not fits or min(one.residual_sd_grey for one in fits) > noise_grey:
        fits += _fit_subset_to_all(
            samples, subset, [_start_in_illumination(subset, even, FREE, max_iterations=MAX_ITERATIONS)]
        )
    if not fits:
        return None
    scale = min(one.residual_sd_grey for one in fits)

    def price(one: FitResult) -> float:
        return robust_chi2_of(samples, one, scale) + (
            FREE_PENALTY_CHI2 if one.illumination[0] == FREE else 0.0
        )

    return min(fits, key=price)


def _fit_subset_to_all(samples: Samples, subset: Samples, fits: list[FitResult | None]) -> list[FitResult]:
    """Continue fits of a subset on all pixels; fits that fail are dropped."""
    return [one for one in fits if one is not None] if subset is samples else refit_all(samples, fits)


def _start_in_illumination(
    samples: Samples, even: FitResult, kind: int, *, max_iterations: int = TEST_ROUNDS
) -> FitResult | None:
    """Start the same pose under another illumination model and run some iterations."""
    illumination = (kind, SPLINE_NODES)
    parameters = np.zeros(parameter_count(illumination))
    from_planar(even.parameters, illumination, parameters)
    return fit_pose(
        samples,
        even.rotation,
        even.translation_mm,
        parameters,
        illumination=illumination,
        min_gain_chi2=CONVERGED_REFIT_CHI2,
        max_iterations=max_iterations,
    )
