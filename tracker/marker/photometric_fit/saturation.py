"""Match of a saturated (washed-out) square with the marker expected there.

Saturated cells neither confirm nor contradict the marker. A search must not accept such a square; tracking
may accept it at the predicted pose if the remaining cells do not contradict the model.
"""

import numpy as np

from tracker.edges import GreyImage
from tracker.geometry import Array
from tracker.marker.photometric_fit.estimator import Estimator, inside_square, shape_mask
from tracker.marker.photometric_fit.fit_kernels import SATURATED_GREY, correlation
from tracker.marker.photometric_fit.illumination import contrasts, highlights
from tracker.marker.photometric_fit.inverted_parts import MAX_INVERTED_RATIO, max_inverted_ratio
from tracker.marker.photometric_fit.occlusion import find_occlusion
from tracker.marker.photometric_fit.scale_space import scale_space_of

# A larger saturated part of the square is a highlight.
MIN_SATURATED_RATIO = 0.02
# These limits accept 1 % of other squares with as many of the marker's edges, and 90 % of washed-out markers.
MIN_CORRELATION, MIN_LOCAL_NCC, MIN_SEEN_RATIO = 0.5, 0.5, 0.25
LIGHT_ROUNDS = 4


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
    if not is_saturated or ncc < MIN_LOCAL_NCC:
        return False
    fit.offset_basis, fit.gain_basis = highlights(), contrasts()
    if not fit.solve(LIGHT_ROUNDS):
        return False
    occluded, _ = find_occlusion(fit.residuals, blur_sd_cells=fit.blur_sd_cells)
    informative, shape = fit.informative(~occluded), shape_mask(fit.picture)
    return bool(
        float(informative[shape].mean()) >= MIN_SEEN_RATIO
        and correlation(fit.observed, fit.residual, informative & inside, fit.offset_basis, 0.0)
        >= MIN_CORRELATION
        and max_inverted_ratio(fit, informative, shape, 0.0) <= MAX_INVERTED_RATIO
    )
