"""One photometric fit of pose, blur, camera response and illumination to a set of pixels.

Where every fit has converged to one planar solution, the mirrored one is started again. A single remaining
solution is no evidence that the other is wrong. While blur is unknown both starts can converge to the same
solution, and the delta chi-square is then infinite: the rotation of a nearly frontal marker in motion was
wrong by 11 degrees at a stated sd of half a degree in 8 of 1,000 scenes. The mirrored pose is therefore
fitted again to a few pixels, and to more where blur is wide. Tracking by edges treats an infinite difference
as undecided. `tests/tracker/test_tilt_uncertainty.py` tests it. It takes a hundredth of the time of a search.
"""

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np

from tracker.geometry import Array
from tracker.geometry.geometry_kernels import mirror, rotation_angle_between
from tracker.photometric.refinement_kernels import refine_pose, robust_cost
from tracker.photometric.samples import Samples

PIXEL_PX2, MIN_BLUR_PX2 = 1.0 / 12.0, 0.07
MAX_ITERATIONS = 14
MAX_MOVE_PX = 0.7
# Scale of the Geman-McClure weight, in sd of the residuals.
CUTOFF_SDS = 4.0
# A fit has converged when the predicted decrease of chi-square is below this. A refit that starts from the
# converged fit of a subset may stop earlier.
CONVERGED_CHI2, CONVERGED_REFIT_CHI2 = 0.04, 5.0
# Below this angle the two solutions are identical.
MIN_APART_RAD = float(np.radians(0.5))


@dataclass(frozen=True, slots=True, kw_only=True)
class FitResult:
    """Result of one fit, as `refine_pose` returns it.

    `matrix` is the normal matrix with the priors; `prediction` holds the rendered rows, plane coordinates,
    illumination and reliability of the pixels at the last evaluation.
    """

    rotation: Array
    translation_mm: Array
    parameters: Array
    illumination: tuple[int, int]
    matrix: Array
    residual_sd_grey: float
    inlier_ratio: float
    prediction: tuple[Array, ...]


def fit_pose(
    samples: Samples,
    rotation: Array,
    translation_mm: Array,
    parameters: Array,
    *,
    illumination: tuple[int, int],
    residual_sd_grey: float = 0.0,
    min_gain_chi2: float = CONVERGED_CHI2,
    max_iterations: int = MAX_ITERATIONS,
) -> FitResult | None:
    """Fit pose and nuisance parameters from a start; return None where the fit fails.

    Args:
        samples: the pixels.
        rotation: (3, 3) of the start.
        translation_mm: (3,) of the start.
        parameters: start values of blur, response and illumination, as `refine_pose` orders them.
        illumination: kind of illumination model, and spline nodes per side.
        residual_sd_grey: sd of the residuals if known; 0 estimates planar illumination and the sd first.
        min_gain_chi2: the fit ends with a step whose predicted decrease of chi-square is smaller.
        max_iterations: limit of Gauss-Newton iterations.
    """
    rotation, translation_mm, parameters = rotation.copy(), translation_mm.copy(), parameters.copy()
    matrix, scale, weight, good, prediction = refine_pose(
        samples.rays,
        samples.values,
        samples.lens,
        rotation,
        translation_mm,
        samples.side_mm,
        samples.textures.arrays,
        parameters,
        illumination,
        residual_sd_grey,
        MIN_BLUR_PX2 + samples.step * samples.step * PIXEL_PX2,
        max_iterations,
        CUTOFF_SDS,
        MAX_MOVE_PX * samples.step,
        min_gain_chi2,
    )
    if not good:
        return None
    return FitResult(
        rotation=rotation,
        translation_mm=translation_mm,
        parameters=parameters,
        illumination=illumination,
        matrix=matrix,
        residual_sd_grey=float(scale),
        inlier_ratio=float(weight),
        prediction=prediction,
    )


def refit(samples: Samples, near: FitResult) -> FitResult | None:
    """Continue a converged fit on these pixels; return None where it fails."""
    return fit_pose(
        samples,
        near.rotation,
        near.translation_mm,
        near.parameters,
        illumination=near.illumination,
        residual_sd_grey=near.residual_sd_grey,
        min_gain_chi2=CONVERGED_REFIT_CHI2,
    )


def refit_all(samples: Samples, near: Iterable[FitResult | None]) -> list[FitResult]:
    """Continue several fits on these pixels; fits that fail are dropped."""
    fits = (None if one is None else refit(samples, one) for one in near)
    return [one for one in fits if one is not None]


def robust_chi2_of(samples: Samples, one: FitResult, residual_sd_grey: float) -> float:
    """Return the robust sum of squared residuals of a fit, in units of the squared residual sd."""
    return float(
        robust_cost(
            samples.rays,
            samples.values,
            samples.lens,
            one.rotation,
            one.translation_mm,
            samples.side_mm,
            samples.textures.arrays,
            one.parameters,
            one.illumination,
            residual_sd_grey,
            CUTOFF_SDS,
        )
    )


def plausible_fits(samples: Samples, fits: list[FitResult], max_delta_chi2: float) -> list[FitResult]:
    """Return the fits whose robust chi-square is within `max_delta_chi2` of the smallest.

    The limit grows with the chi-square per pixel of the best fit where that exceeds 1, because model errors
    then add to the difference.
    """
    if len(fits) < 2:
        return fits
    scale = min(one.residual_sd_grey for one in fits)
    costs = [robust_chi2_of(samples, one, scale) for one in fits]
    max_delta_chi2 *= max(1.0, min(costs) / len(samples.values))
    return [one for one, cost in zip(fits, costs, strict=True) if cost < min(costs) + max_delta_chi2]


def with_mirror_solution(samples: Samples, fits: list[FitResult], starts: list[Array]) -> list[FitResult]:
    """Return the fits, plus one that starts from the mirrored best pose if a start but no fit was near it.

    Args:
        samples: the pixels.
        fits: fits of the pixels under the selected illumination model.
        starts: rotations (3, 3) of the starts.
    """
    scale = min(one.residual_sd_grey for one in fits)
    best = min(fits, key=lambda one: robust_chi2_of(samples, one, scale))
    there = np.empty((3, 3))
    mirror(best.rotation, best.translation_mm, there)

    def is_there(rotation: Array) -> bool:
        return bool(rotation_angle_between(rotation, there) < rotation_angle_between(rotation, best.rotation))

    was_started_from = rotation_angle_between(best.rotation, there) > MIN_APART_RAD and any(
        map(is_there, starts)
    )
    if not was_started_from or any(is_there(one.rotation) for one in fits):
        return fits
    mirrored = fit_pose(
        samples,
        there,
        best.translation_mm,
        best.parameters,
        illumination=best.illumination,
        residual_sd_grey=best.residual_sd_grey,
    )
    return fits if mirrored is None else [*fits, mirrored]
