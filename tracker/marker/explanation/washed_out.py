"""Is what glare has left of a square still the marker that was there before?

Where the sensor is full nothing is seen, and nothing speaks against the marker either. A search must not be
content with that; an image in which it is expected just there may, if what is left of it does not contradict.
"""

import numpy as np

from tracker.edges import GreyImage
from tracker.geometry import Array
from tracker.marker.explanation.cover import covered
from tracker.marker.explanation.fit import Fit, inside_square
from tracker.marker.explanation.flips import MAX_FLIPPED_RATIO, max_flipped
from tracker.marker.explanation.kernels import SATURATED_GREY, correlation
from tracker.marker.explanation.light import contrasts, highlights
from tracker.marker.explanation.pictures import pictures_of
from tracker.marker.explanation.shape import shape_of

# Of the square at the sensor's limit: there is a highlight.
MIN_GLARING_RATIO = 0.02
# Of other squares with as many of the marker's edges a hundredth passes, of washed-out markers nine tenths.
MIN_ALIKE, MIN_PART_BY_PART, MIN_SEEN_RATIO = 0.5, 0.5, 0.25
LIGHT_ROUNDS = 4


def is_washed_out(image: GreyImage, square: GreyImage, corners_px: Array, *, side_px: float) -> bool:
    """Whether glare hides a part of the model (n, n) at these corners (4, 2), and the rest agrees with it.

    No part of the shape that is seen may be nearer to dark for bright than to the model.
    """
    fit = Fit(image, pictures_of(square), corners_px, side_px)
    alike = fit.look_part_by_part()
    inside = inside_square()
    glaring = float(np.mean(fit.seen[inside] >= SATURATED_GREY)) > MIN_GLARING_RATIO
    if not glaring or alike < MIN_PART_BY_PART:
        return False
    fit.light, fit.gains = highlights(), contrasts()
    if not fit.walk(LIGHT_ROUNDS):
        return False
    hidden, _ = covered(fit.left, blur_fields=fit.blur_fields)
    telling, shape = fit.telling(~hidden), shape_of(fit.picture)
    return bool(
        float(telling[shape].mean()) >= MIN_SEEN_RATIO
        and correlation(fit.seen, fit.rest, telling & inside, fit.light, 0.0) >= MIN_ALIKE
        and max_flipped(fit, telling, shape, 0.0) <= MAX_FLIPPED_RATIO
    )
