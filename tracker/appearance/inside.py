"""The inside of a marker asked alone: its outline may be trimmed, framed, or covered along a side.

A marker that is cut out too near, or lies under a frame, is smaller by its outline than by its print: a fit
that takes the outline calls the inside covered and is off in depth by 3 to 12 % with a tenth of that
stated. The pixels clear of the outline then leave only noise where the whole leaves several times as much,
so the pose is theirs. A badly printed inside in a true outline looks the same up to a scale, so the pose by
the whole stays possible and the covariance spans both: a trimmed marker never has a small covariance. A
strip along a side tilts a small marker by tens of degrees; there the inside keeps the other planar solution
possible. `tests/tracker/test_rims.py` holds it.
"""

from dataclasses import dataclass, replace

import numpy as np

from tracker.appearance.fit import Fitted, all_again, cost_of, fitted
from tracker.appearance.light.fields.kernels import typical_contrast
from tracker.appearance.light.kernels import BLUR
from tracker.appearance.mirrored import with_mirrored
from tracker.appearance.samples import Samples, some_of
from tracker.geometry import Array

# The inside is asked where the whole leaves so much, in units of the noise and of the contrast, or where so
# few of its pixels have a say that something must cover it. Of noise alone 0.88 have one.
LEAVES_NOISES, LEAVES_CONTRAST_RATIO, MIN_SAY_RATIO = 1.4, 0.04, 0.86
# The outline reaches so many blurs inwards; what was cut off or lies over it, at least so much of a half
# side. Where it reaches farther than the most, the inside tells too little.
BLURS, MIN_RIM_RATIO, MAX_RIM_RATIO = 3.0, 0.14, 0.3
# So many pixels of it tell whether it contradicts.
FEWEST_PIXELS, TELLING_PIXELS = 100, 600
# It leaves so much less than the whole does, or so many more of its pixels have a say; and there the pose of
# the whole costs so much more.
LEAVES_RATIO, SAY_MORE_RATIO, CONTRADICTS_SD2 = 0.7, 0.04, 60.0
# Where the other planar solution costs less than so much more inside, the outline alone spoke against it.
UNDECIDED_SD2 = 18.0


@dataclass(frozen=True, slots=True, kw_only=True)
class ByInside:
    """What the inside makes of a marker whose outline must not be believed.

    Attributes:
        seen: the pixels to go by from here on.
        fits: to them.
        other: the pose that may as well be true.
        gap_sd2: by how much the inside speaks against that one, in squared residuals by their variance.
    """

    seen: Samples
    fits: list[Fitted]
    other: Fitted
    gap_sd2: float


def by_inside(
    seen: Samples, fits: list[Fitted], starts: list[Array], *, side_px: float, noise_grey: float
) -> ByInside | None:
    """What the pixels clear of the outline say where the whole marker is not explained.

    Where they contradict it and are explained alone, they are gone by, and the pose of the whole may as well
    be true: which of outline and inside is false, nobody knows. Where they leave open the other planar
    solution, which the outline alone spoke against, the whole is gone by, and that one may as well be true.
    Else None.

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
    both = with_mirrored(some, found, starts)
    if _contradicts(some, best, min(both, key=lambda one: one.scale_grey)):
        both = both if some is inside else all_again(inside, both)
        return ByInside(seen=inside, fits=both, other=best, gap_sd2=0.0) if both else None
    if len(fits) > 1 or len(both) < 2:
        return None
    scale = min(one.scale_grey for one in both)
    gap = cost_of(some, both[1], scale) - cost_of(some, both[0], scale)
    return ByInside(seen=seen, fits=fits, other=both[1], gap_sd2=gap) if gap < UNDECIDED_SD2 else None


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
    return one.scale_grey > left or one.explained_ratio < MIN_SAY_RATIO


def _clear_of_outline(seen: Samples, one: Fitted, side_px: float) -> Samples | None:
    """Those pixels that the outline's blur does not reach; None where few are.

    `side_px`: in pixels as they were averaged.
    """
    blur = one.numbers[BLUR : BLUR + 2]
    rim = max(MIN_RIM_RATIO, 2.0 * BLURS * float(np.sqrt(blur.max())) / side_px)
    # In half sides from the centre.
    at: Array = one.looked[1]
    clear = np.abs(at).max(axis=1) < 1.0 - rim
    if rim > MAX_RIM_RATIO or np.count_nonzero(clear) < FEWEST_PIXELS:
        return None
    return replace(
        seen, rays=np.ascontiguousarray(seen.rays[clear]), values=np.ascontiguousarray(seen.values[clear])
    )
