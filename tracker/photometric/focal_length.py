"""Error of the stated focal length, from the perspective of one marker in one image.

A marker of known shape determines the focal length wherever it is tilted: its far side is smaller than its
near one by a ratio that depends on distance over size, while its size in the image depends on focal length
over distance. A stated focal length that is wrong by 2 % puts a marker 1 m away 20 mm too far or too near,
and leaves no trace in the pose; the residuals of the photometric fit contain it.

The focal length is one more unknown of the normal equations of that fit. A change of its logarithm scales the
depth of each point, so its derivative is that by a translation along the optical axis, times the depth.
"""

from dataclasses import dataclass, replace

import numpy as np

from tracker.edges import GreyImage
from tracker.geometry import Array, Camera, Marker, Rigid
from tracker.photometric.equation_kernels import PLANAR_COUNT, add_priors, weighted_rows
from tracker.photometric.fit import CUTOFF_SDS, FitResult, fit_pose
from tracker.photometric.illumination_kernels import PLANAR
from tracker.photometric.refinement import averaging_step, focus_blur_px2, wide_blur_px2
from tracker.photometric.response_kernels import BLUR, ILLUMINATION, RESPONSE
from tracker.photometric.samples import Samples, sample_pixels, subsample
from tracker.photometric.texture import Textures

# A focal length that is wrong by 1 % displaces a tip 100 mm nearer than the reference by a millimetre. An
# error of this many standard deviations is no chance.
MAX_FOCAL_LENGTH_ERROR_RATIO, SIGNIFICANT_SDS = 0.01, 4.0
# Linearised twice: one step is short by a seventh of the error.
STEPS = 2
# Occlusion, shadow and reflections displace edges by more than a wrong focal length does.
MIN_CLEAN_INLIER_RATIO, MAX_CLEAN_RESIDUAL_RATIO = 0.8, 0.05
# More pixels would delay the image more than they would add.
MAX_PIXELS = 3000
# Index of the translation along the optical axis among the unknowns of the fit.
TRANSLATION_Z = 2


@dataclass(frozen=True, slots=True)
class FocalLengthError:
    """Relative error of a stated focal length.

    Attributes:
        ratio: stated by true focal length, minus 1.
        sd: standard deviation of the ratio.
    """

    ratio: float
    sd: float

    @property
    def is_doubtful(self) -> bool:
        """Return whether the stated focal length is wrong by more than allowed, and not by chance."""
        return abs(self.ratio) > max(MAX_FOCAL_LENGTH_ERROR_RATIO, SIGNIFICANT_SDS * self.sd)


def focal_length_error(
    image: GreyImage,
    lens: Array,
    textures: Textures,
    start: Rigid[Camera, Marker],
    *,
    side_mm: float,
    side_px: float,
) -> FocalLengthError | None:
    """Return the error of the focal length in `lens` by one image; None where the marker is not clean.

    The standard deviation is that of independent pixel errors. Errors of print, lens and light are common to
    images of one view, so that only different views together give a reliable result.

    Args:
        image: the whole grey image (h, w).
        lens: `CameraModel.lens`.
        textures: of the marker.
        start: the pose, refined.
        side_mm: side of the marker.
        side_px: approximate side of the marker in the image.
    """
    step = averaging_step(side_px)
    focus_px2 = focus_blur_px2(step)
    seen = sample_pixels(image, lens, textures, start, side_mm=side_mm, step=step, blur_px2=focus_px2)
    samples = subsample(seen, MAX_PIXELS)
    parameters = np.zeros(PLANAR_COUNT)
    parameters[BLUR : BLUR + 3] = focus_px2
    log_ratio, sd, translation_mm = 0.0, np.inf, start.translation_mm
    for _ in range(STEPS):
        # With a shorter focal length the same pixels see larger angles, and the marker is nearer.
        turned = replace(samples, rays=samples.rays * np.exp(log_ratio))
        nearer_mm = translation_mm * [1.0, 1.0, np.exp(-log_ratio)]
        fit = fit_pose(turned, start.rotation, nearer_mm, parameters, illumination=(PLANAR, 0))
        if fit is None:
            return None
        change, sd = _focal_length_step(turned, fit)
        # Tested last, so that the image of the warm-up, which is not clean, loads all kernels.
        if not _is_clean(fit, focus_px2):
            return None
        log_ratio += change
    return FocalLengthError(ratio=float(np.expm1(log_ratio)), sd=sd) if np.isfinite(sd) else None


def _is_clean(fit: FitResult, focus_px2: Array) -> bool:
    contrast_grey = abs(float(fit.parameters[ILLUMINATION + 3]))
    return (
        fit.inlier_ratio >= MIN_CLEAN_INLIER_RATIO
        and fit.residual_sd_grey <= MAX_CLEAN_RESIDUAL_RATIO * contrast_grey
        and wide_blur_px2(fit.parameters, focus_px2) is None
    )


def _focal_length_step(samples: Samples, fit: FitResult) -> tuple[float, float]:
    """Return the Gauss-Newton step of the logarithm of stated by true focal length, and its sd.

    The other unknowns are eliminated by the Schur complement. The sd is infinite for a frontal marker.
    """
    rows, at, dark_contrast, reliability = fit.prediction
    scale, count = fit.residual_sd_grey, len(samples.values)
    slopes, residuals, weights = np.empty((PLANAR_COUNT, count)), np.empty(count), np.empty(count)
    weighted_rows(
        rows,
        at,
        samples.values,
        dark_contrast,
        fit.parameters[RESPONSE],
        reliability,
        1.0 / (CUTOFF_SDS * scale) ** 2,
        0,
        count,
        slopes,
        residuals,
        weights,
    )
    normal, sides = (slopes * weights) @ slopes.T, slopes @ (weights * residuals)
    add_priors(normal, sides, fit.parameters, scale, fit.illumination)
    depths_mm = fit.translation_mm[2] + 0.5 * samples.side_mm * (at @ fit.rotation[2, :2])
    by_focal_length = slopes[TRANSLATION_Z] * depths_mm
    mixed = slopes @ (weights * by_focal_length)
    eliminated = np.linalg.solve(normal, mixed)
    information = float(by_focal_length @ (weights * by_focal_length) - mixed @ eliminated)
    if information <= 0.0:
        return 0.0, np.inf
    score = float(by_focal_length @ (weights * residuals) - sides @ eliminated)
    return score / information, scale / float(np.sqrt(information))
