"""Separate fit of the marker's inner region, for outlines that are trimmed, framed or occluded along a side.

A marker that is trimmed too closely, or lies under a frame, has a smaller outline than its print. A fit that
includes the outline treats the inside as occluded, and its depth is wrong by 3 to 12 % at a tenth of that as
stated sd. The inner pixels alone then fit to the noise level, while the residuals of all pixels are several
times larger, so the pose of the inner pixels is used. An inner pattern printed at a wrong scale inside a true
outline gives the same residuals. The pose of all pixels therefore remains an alternative, and the covariance
includes both. An occluding strip along a side rotates the pose of a small marker by tens of degrees; there
the inner region keeps the mirrored planar solution. `tests/tracker/test_rims.py` tests it.
"""

from dataclasses import dataclass, replace

import numpy as np

from tracker.geometry import Array
from tracker.photometric.fit import FitResult, fit_pose, refit_all, robust_chi2_of, with_mirror_solution
from tracker.photometric.illumination_kernels import typical_contrast
from tracker.photometric.response_kernels import BLUR
from tracker.photometric.samples import Samples, subsample

# The inner region is fitted where the residuals of all pixels exceed these multiples of noise and contrast,
# or where the inlier ratio indicates occlusion. Noise alone gives 0.88.
RESIDUAL_NOISES, RESIDUAL_CONTRAST_RATIO, MIN_INLIER_RATIO = 1.4, 0.04, 0.86
# Width of the excluded rim: this many sd of the blur, and at least this ratio of a half side, for a trimmed
# or covered outline. Beyond the maximum the remaining pixels constrain the pose too little.
BLURS, MIN_RIM_RATIO, MAX_RIM_RATIO = 3.0, 0.14, 0.3
# Minimum number of inner pixels, and the number used by the test.
MIN_PIXELS, TEST_PIXELS = 100, 600
# The inner fit must leave a smaller residual by this ratio, or a larger inlier ratio, and the pose of all
# pixels must cost this much more there.
MAX_RESIDUAL_RATIO, MIN_INLIER_GAIN_RATIO, CONTRADICTION_CHI2 = 0.7, 0.04, 60.0
# Below this difference of chi-square inside, only the outline excluded the mirrored solution.
UNDECIDED_CHI2 = 18.0


@dataclass(frozen=True, slots=True, kw_only=True)
class InnerRegionFit:
    """Fit of the inner region of a marker whose outline is not reliable.

    Attributes:
        samples: the pixels to use from here on.
        fits: the fits to them.
        alternative: a pose that is possible too.
        delta_chi2: chi-square difference by which the inner region disfavours the alternative.
    """

    samples: Samples
    fits: list[FitResult]
    alternative: FitResult
    delta_chi2: float


def fit_inner_region(
    samples: Samples, fits: list[FitResult], starts: list[Array], *, side_px: float, noise_grey: float
) -> InnerRegionFit | None:
    """Fit the pixels clear of the outline where the fit of all pixels leaves large residuals.

    Where the inner pixels fit well alone and contradict the fit of all pixels, their fit replaces it, and the
    pose of all pixels becomes the alternative, because either the outline or the inner pattern may be wrong.
    Where only the outline excluded the mirrored planar solution, the fit of all pixels remains and the
    mirrored solution is the alternative. Returns None otherwise.

    Args:
        samples: all pixels of the marker.
        fits: fits of all pixels: one pose and possibly its mirrored solution.
        starts: rotations (3, 3) of the starts.
        side_px: approximate width of the marker.
        noise_grey: sd of the image noise.
    """
    best = min(fits, key=lambda one: one.residual_sd_grey)
    if not _has_large_residuals(best, noise_grey):
        return None
    inside = _clear_of_outline(samples, best, side_px / samples.step)
    if inside is None:
        return None
    subset = subsample(inside, TEST_PIXELS)
    begun = (
        fit_pose(subset, one.rotation, one.translation_mm, one.parameters, illumination=one.illumination)
        for one in fits
    )
    found = [one for one in begun if one is not None]
    if not found:
        return None
    both = with_mirror_solution(subset, found, starts)
    if _contradicts(subset, best, min(both, key=lambda one: one.residual_sd_grey)):
        both = both if subset is inside else refit_all(inside, both)
        return InnerRegionFit(samples=inside, fits=both, alternative=best, delta_chi2=0.0) if both else None
    if len(fits) > 1 or len(both) < 2:
        return None
    scale = min(one.residual_sd_grey for one in both)
    gap = robust_chi2_of(subset, both[1], scale) - robust_chi2_of(subset, both[0], scale)
    return (
        InnerRegionFit(samples=samples, fits=fits, alternative=both[1], delta_chi2=gap)
        if gap < UNDECIDED_CHI2
        else None
    )


def _contradicts(inside: Samples, whole: FitResult, alone: FitResult) -> bool:
    """Return whether the inner pixels fit better `alone` and contradict the pose of all pixels."""
    fits_better = (
        alone.residual_sd_grey < MAX_RESIDUAL_RATIO * whole.residual_sd_grey
        or alone.inlier_ratio > whole.inlier_ratio + MIN_INLIER_GAIN_RATIO
    )
    if not fits_better:
        return False
    costs = [robust_chi2_of(inside, one, alone.residual_sd_grey) for one in (whole, alone)]
    return costs[0] - costs[1] > CONTRADICTION_CHI2


def _has_large_residuals(one: FitResult, noise_grey: float) -> bool:
    contrast = float(typical_contrast(one.parameters, one.illumination))
    left = max(RESIDUAL_NOISES * noise_grey, RESIDUAL_CONTRAST_RATIO * contrast)
    return one.residual_sd_grey > left or one.inlier_ratio < MIN_INLIER_RATIO


def _clear_of_outline(samples: Samples, one: FitResult, side_px: float) -> Samples | None:
    """Return the pixels inside the blurred outline; None where there are too few.

    `side_px`: in averaged pixels.
    """
    blur = one.parameters[BLUR : BLUR + 2]
    rim = max(MIN_RIM_RATIO, 2.0 * BLURS * float(np.sqrt(blur.max())) / side_px)
    # In half sides from the centre.
    at: Array = one.prediction[1]
    clear = np.abs(at).max(axis=1) < 1.0 - rim
    if rim > MAX_RIM_RATIO or np.count_nonzero(clear) < MIN_PIXELS:
        return None
    return replace(
        samples,
        rays=np.ascontiguousarray(samples.rays[clear]),
        values=np.ascontiguousarray(samples.values[clear]),
    )
