"""Photometric verification of a square by blur, illumination and occlusion.

Defocus, a shadow edge, a highlight or partial occlusion make the image differ from the printed model. Each
has its own model: blur affects outline and inside equally; illumination is smooth and never negative; an
occluder is one component that extends over the border. The residuals of the fit with these models
discriminate better between the marker and other shapes.

Saturated cells neither confirm nor contradict the marker. A search must not accept such a square; tracking
may accept it at the predicted pose if the remaining cells do not contradict the model
(`matches_under_saturation`).
"""

from dataclasses import replace

import numpy as np

from tracker.camera.blur_kernels import axes_of
from tracker.edges import GreyImage
from tracker.geometry import Array
from tracker.marker.photometric_fit.acceptance import (
    MIN_NOISE_CORRECTED,
    MIN_NONUNIFORM_PX,
    NoiseCorrectedFit,
    PhotometricFit,
)
from tracker.marker.photometric_fit.estimator import (
    UNIT,
    Estimator,
    any_shape_mask,
    inside_square,
    shape_mask,
)
from tracker.marker.photometric_fit.fit_kernels import SATURATED_GREY, correlation
from tracker.marker.photometric_fit.grid_kernels import GRID_CELLS, SAMPLING_VARIANCE, SQUARE_CELLS
from tracker.marker.photometric_fit.illumination import contrasts, highlights, shadow_in, smooth_light
from tracker.marker.photometric_fit.inverted_parts import MAX_INVERTED_RATIO, max_inverted_ratio
from tracker.marker.photometric_fit.occlusion import (
    Mask,
    find_occlusion,
    unoccluded_weights,
)
from tracker.marker.photometric_fit.scale_space import scale_space_of
from tracker.marker.photometric_fit.stepwise_illumination import fit_illumination
from tracker.marker.photometric_fit.symmetry import rotation_is_ambiguous
from tracker.marker.sampling_kernels import through

FIRST_ROUNDS, ROUNDS, ROUNDS_AGAIN = 3, 6, 4
MIN_MEAN_WEIGHT = 0.55
MIN_RETRY_CORRELATION = 0.75
OCCLUSION_ROUNDS = 2
# From this correlation, whole and inside, rotations are tested; lower ones are rejected anyway. Below the
# self-correlation, an unoccluded marker cannot be mistaken for its own rotation.
SYMMETRY_TEST_CORRELATION, SYMMETRY_TEST_INNER_CORRELATION, MIN_SELF_CORRELATION = 0.9, 0.85, 0.6
# Minimum local correlation for a fit of nonuniform illumination.
MIN_LOCAL_NCC = 0.7
NONUNIFORM_ROUNDS = 6
# Alternations of illumination and position: the first is too rough to be tested, the last is for a fit that
# is nearly accepted.
MAX_ALTERNATIONS, FIRST_TESTED_ALTERNATION, MIN_ALTERNATION_CORRELATION = 3, 2, 0.85
SD_OF_MEDIAN = 1.4826
# A larger saturated part of the square is a highlight.
MIN_SATURATED_RATIO = 0.02
# These limits accept 1 % of other squares with as many of the marker's edges, and 90 % of washed-out markers.
MIN_SATURATED_CORRELATION, MIN_SATURATED_LOCAL_NCC, MIN_SATURATED_SEEN_RATIO = 0.5, 0.5, 0.25
SATURATED_ROUNDS = 4


def photometric_fit_of(
    image: GreyImage, square: GreyImage, corners_px: Array, *, side_px: float
) -> PhotometricFit | None:
    """Fit a model (n, n) to a grey image (h, w) near these corners (4, 2); None if it has no contrast there.

    `corners_px` are pixels of `image`: top-left, top-right, bottom-right, bottom-left of the printed face.
    """
    fit = Estimator(image, scale_space_of(square), corners_px, side_px)
    best = _fit_simple_illumination(fit)
    if (best is None or not best.is_accepted) and side_px >= MIN_NONUNIFORM_PX:
        uneven = _fit_stepwise_illumination(Estimator(image, scale_space_of(square), corners_px, side_px))
        if uneven is not None and uneven.is_accepted:
            return uneven
    return best


def _fit_simple_illumination(fit: Estimator) -> PhotometricFit | None:
    """Fit smooth illumination, a shadow edge or highlights: the first accepted fit, or the best."""
    fit.sample()
    first = fit.state
    if not fit.solve(FIRST_ROUNDS, unoccluded_weights(fit.observed, fit.picture)):
        return None
    # A marker fits in most cells by now, even under an occluder or glare.
    if float(fit.weight[inside_square()].mean()) < MIN_MEAN_WEIGHT or not fit.solve(ROUNDS, fit.weight):
        return None
    start = fit.state
    best = _fit_with_occlusion(fit)
    is_saturated = float(np.mean((first.observed >= SATURATED_GREY) & inside_square())) > MIN_SATURATED_RATIO
    for brighten in (_with_shadow, _with_highlights):
        if best is not None and best.is_accepted:
            break
        is_eligible = is_saturated if brighten is _with_highlights else False
        if not is_eligible and (best is None or best.correlation < MIN_RETRY_CORRELATION):
            continue
        # The effect of an occluder or glare on the fit must not be carried into another illumination.
        fit.state = first if is_eligible else start
        if not brighten(fit):
            continue
        found = _fit_with_occlusion(fit) if fit.solve(ROUNDS if is_eligible else ROUNDS_AGAIN) else None
        if found is not None and (best is None or found.is_accepted or found.correlation > best.correlation):
            best = found
    return best


def _fit_stepwise_illumination(fit: Estimator) -> PhotometricFit | None:
    """Fit a shadow edge and highlights together, if the local correlation allows."""
    if fit.local_ncc() < MIN_LOCAL_NCC:
        return None
    weight, found = unoccluded_weights(fit.observed, fit.picture), None
    # Position, illumination and occlusion depend on each other.
    for alternation in range(MAX_ALTERNATIONS):
        if not (fit_illumination(fit, weight) and fit.solve(NONUNIFORM_ROUNDS)):
            return found
        if alternation + 1 >= FIRST_TESTED_ALTERNATION:
            found = _fit_with_occlusion(fit, correct_noise=True)
            if found is None or found.is_accepted or found.correlation < MIN_ALTERNATION_CORRELATION:
                return found
        weight, fit.visible = fit.weight, np.ones((GRID_CELLS, GRID_CELLS), np.bool_)
    return found


def _with_shadow(fit: Estimator) -> bool:
    """Add a shadow edge to the illumination basis, if it reduces the residuals enough."""
    shadow = shadow_in(fit.observed, fit.picture, fit.visible)
    if shadow is None:
        return False
    fit.offset_basis = np.column_stack([smooth_light(2), shadow])
    fit.gain_basis = np.column_stack([contrasts(), shadow])
    return True


def _with_highlights(fit: Estimator) -> bool:
    """Set the illumination basis to highlights."""
    fit.offset_basis, fit.gain_basis = highlights(), contrasts()
    return True


def _fit_with_occlusion(fit: Estimator, *, correct_noise: bool = False) -> PhotometricFit | None:
    """Return the fit under this illumination with occluded cells excluded."""
    for _ in range(OCCLUSION_ROUNDS):
        occluded, _ = find_occlusion(fit.residuals, blur_sd_cells=fit.blur_sd_cells)
        if not occluded.any():
            break
        fit.visible = ~occluded
        if not (fit.visible & inside_square()).any() or not fit.solve(ROUNDS_AGAIN):
            return None
    found = _photometric_fit(fit, correct_noise=correct_noise)
    nearly = (
        found.correlation >= SYMMETRY_TEST_CORRELATION
        and found.inner_correlation >= SYMMETRY_TEST_INNER_CORRELATION
    )
    is_eligible = found.is_accepted if correct_noise else nearly
    if not is_eligible or not (found.is_occluded or fit.pictures.rotated_correlation > MIN_SELF_CORRELATION):
        return found
    return replace(found, is_rotation_ambiguous=rotation_is_ambiguous(fit))


def _photometric_fit(fit: Estimator, *, correct_noise: bool) -> PhotometricFit:
    occluded, inside = find_occlusion(fit.residuals, blur_sd_cells=fit.blur_sd_cells)
    visible = ~occluded & fit.visible
    informative = fit.informative(visible)
    shape = shape_mask(fit.picture)
    return PhotometricFit(
        side_px=fit.side_px,
        correlation=correlation(
            fit.observed, fit.residual, informative & inside_square(), fit.offset_basis, 0.0
        ),
        inner_correlation=correlation(fit.observed, fit.residual, informative & shape, fit.offset_basis, 0.0),
        occluded_ratio=1.0 - float(visible[inside_square()].mean()),
        inner_occluded_ratio=1.0 - float(visible[shape].mean()),
        inner_unobserved_ratio=1.0 - float(informative[shape].mean()),
        inside_ratio=inside / SQUARE_CELLS**2,
        corners_px=np.array([through(fit.to_px, a, b) for a, b in fit.corners]),
        moved_px=float(np.abs(fit.corners - UNIT).max()) * fit.side_px,
        has_highlights=fit.has_highlight_terms,
        blur_px=_blur_px(fit.blur, fit.cell_px),
        noise_corrected=_noise_corrected(fit, informative, shape) if correct_noise else None,
        occluded=~visible,
    )


def _noise_corrected(fit: Estimator, informative: Mask, shape: Mask) -> NoiseCorrectedFit:
    """Return the correlations corrected for the noise measured on outline and paper."""
    left = np.abs(fit.residual[informative & ~shape])
    noise = SD_OF_MEDIAN * float(np.median(left)) if len(left) else 0.0
    ncc, inner = (
        correlation(fit.observed, fit.residual, informative & part, fit.offset_basis, noise)
        for part in (inside_square(), shape)
    )
    hopeful = min(ncc, inner) >= MIN_NOISE_CORRECTED
    return NoiseCorrectedFit(
        correlation=ncc,
        inner_correlation=inner,
        inverted_ratio=max_inverted_ratio(fit, informative, any_shape_mask(fit.picture), noise)
        if hopeful
        else 1.0,
    )


def _blur_px(blur: Array, cell_px: float) -> tuple[float, float]:
    larger, smaller, _, _ = axes_of(blur[0], blur[1], blur[2])
    minimum, maximum = (float(np.sqrt(max(one - SAMPLING_VARIANCE, 0.0))) for one in (smaller, larger))
    return minimum * cell_px, maximum * cell_px


def matches_under_saturation(
    image: GreyImage, square: GreyImage, corners_px: Array, *, side_px: float
) -> bool:
    """Return whether saturation hides part of the model (n, n) and the visible rest agrees with it.

    `corners_px` (4, 2): where it is compared. No visible part may be nearer to the inverted model.
    """
    fit = Estimator(image, scale_space_of(square), corners_px, side_px)
    ncc = fit.local_ncc()
    inside = inside_square()
    is_saturated = float(np.mean(fit.observed[inside] >= SATURATED_GREY)) > MIN_SATURATED_RATIO
    if not is_saturated or ncc < MIN_SATURATED_LOCAL_NCC:
        return False
    fit.offset_basis, fit.gain_basis = highlights(), contrasts()
    if not fit.solve(SATURATED_ROUNDS):
        return False
    occluded, _ = find_occlusion(fit.residuals, blur_sd_cells=fit.blur_sd_cells)
    informative, shape = fit.informative(~occluded), shape_mask(fit.picture)
    return bool(
        float(informative[shape].mean()) >= MIN_SATURATED_SEEN_RATIO
        and correlation(fit.observed, fit.residual, informative & inside, fit.offset_basis, 0.0)
        >= MIN_SATURATED_CORRELATION
        and max_inverted_ratio(fit, informative, shape, 0.0) <= MAX_INVERTED_RATIO
    )
