"""The inside of a marker asked alone: its outline may be trimmed, framed, or covered along a side."""

from dataclasses import replace

import numpy as np

from tracker.appearance.fit import Fitted, all_again, cost_of, fitted, in_question
from tracker.appearance.light.fields.kernels import typical_contrast
from tracker.appearance.light.kernels import BLUR
from tracker.appearance.mirrored import with_mirrored
from tracker.appearance.samples import Samples, some_of
from tracker.geometry import Array

# The inside is asked where the whole leaves so much, in units of the noise and of the contrast, or where so
# few of its pixels have a say. Of noise alone 0.88 have one.
LEAVES_NOISES, LEAVES_CONTRAST_RATIO, LEAST_SAY_RATIO = 1.4, 0.04, 0.86
# The outline reaches so many blurs inwards; what was cut off or lies over it, at least so much of a half
# side. Where it reaches farther than the most, the inside tells too little.
BLURS, LEAST_RIM_RATIO, MOST_RIM_RATIO = 3.0, 0.14, 0.3
# So many pixels of it tell whether it contradicts.
FEWEST_PIXELS, TELLING_PIXELS = 100, 600
# It leaves so much less than the whole does, or so many more of its pixels have a say; and there the pose of
# the whole costs so much more.
LEAVES_RATIO, SAY_MORE_RATIO, CONTRADICTS_SD2 = 0.7, 0.04, 60.0
# Where the other planar solution costs less than so much more inside, the outline alone spoke against it.
UNDECIDED_SD2 = 18.0


def by_inside(
    seen: Samples, fits: list[Fitted], starts: list[Array], *, side_px: float, noise_grey: float
) -> tuple[Samples, list[Fitted]] | None:
    """The pixels clear of the outline and the fits to them, where the outline must not be believed.

    That is where the whole is not explained, and the inside either contradicts it and is, or leaves open the
    other planar solution, which the outline spoke against. Else None.

    Args:
        seen: the pixels of the whole.
        fits: of one pose and perhaps its rival, to them.
        starts: rotations (3, 3) that were begun from.
        side_px: about how wide the marker is.
        noise_grey: sd of the image's noise.
    """
    best = min(fits, key=lambda one: one.scale_grey)
    if not _leaves_much(best, noise_grey):
        return None
    inside = _clear_of_outline(seen, best, side_px / seen.step)
    if inside is None:
        return None
    some = some_of(inside, TELLING_PIXELS)
    begun = (fitted(some, one.rotation, one.translation_mm, one.numbers, light=one.light) for one in fits)
    found = [one for one in begun if one is not None]
    if not found:
        return None
    found = with_mirrored(some, found, starts)
    is_open = len(fits) == 1 and len(in_question(some, found, UNDECIDED_SD2)) > 1
    if not is_open and not _contradicts(some, best, min(found, key=lambda one: one.scale_grey)):
        return None
    found = found if some is inside else all_again(inside, found)
    return (inside, found) if found else None


def _contradicts(inside: Samples, whole: Fitted, alone: Fitted) -> bool:
    """Whether these pixels are explained `alone`, and speak clearly against the pose of the whole."""
    explains_more = (
        alone.scale_grey < LEAVES_RATIO * whole.scale_grey
        or alone.explained_ratio > whole.explained_ratio + SAY_MORE_RATIO
    )
    if not explains_more:
        return False
    costs = [cost_of(inside, one, alone.scale_grey) for one in (whole, alone)]
    return costs[0] - costs[1] > CONTRADICTS_SD2


def _leaves_much(one: Fitted, noise_grey: float) -> bool:
    contrast = float(typical_contrast(one.numbers, one.light))
    left = max(LEAVES_NOISES * noise_grey, LEAVES_CONTRAST_RATIO * contrast)
    return one.scale_grey > left or one.explained_ratio < LEAST_SAY_RATIO


def _clear_of_outline(seen: Samples, one: Fitted, side_px: float) -> Samples | None:
    """Those pixels that the outline's blur does not reach; None where few are.

    `side_px`: in pixels as they were averaged.
    """
    blur = one.numbers[BLUR : BLUR + 2]
    rim = max(LEAST_RIM_RATIO, 2.0 * BLURS * float(np.sqrt(blur.max())) / side_px)
    # In half sides from the centre.
    at: Array = one.looked[1]
    clear = np.abs(at).max(axis=1) < 1.0 - rim
    if rim > MOST_RIM_RATIO or np.count_nonzero(clear) < FEWEST_PIXELS:
        return None
    return replace(
        seen, rays=np.ascontiguousarray(seen.rays[clear]), values=np.ascontiguousarray(seen.values[clear])
    )
