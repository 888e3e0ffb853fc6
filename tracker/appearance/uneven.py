"""Light that varies over the marker: which kind of it explains the pixels."""

import numpy as np

from tracker.appearance.fit import CUT, ROUNDS, STRAIGHT_SD2, Fitted, again, cost_of, fitted, in_question
from tracker.appearance.light.fields.kernels import (
    FREE,
    GLARING,
    SHADED,
    from_plain,
    numbers_of,
    typical_contrast,
)
from tracker.appearance.light.kernels import RESPONSE
from tracker.appearance.light.pattern.kernels import pattern_of_light
from tracker.appearance.samples import Samples, some_of

# Uneven light is a net of so many nodes a side: a shadow's edge is a fifth of the marker wide, a highlight
# less.
NODES = 10
# What even light leaves unexplained, in units of the noise and of the contrast, before light may vary.
EVEN_LEAVES_NOISES, EVEN_LEAVES_CONTRAST_RATIO = 1.4, 0.02
# Noise, blocks of a compressed picture and things behind the marker have under 30 of the pattern of light; a
# shadow that takes half of it, or a highlight of half its height, over 150.
LEAST_PATTERN_SD2 = 80.0
# Two fields explain what one does too, and by chance a little more.
FREE_PRICE_SD2 = 50.0
# So many pixels, and so many steps, tell which light it is; one that then costs so much more is let go.
TELLING_PIXELS, TELLING_ROUNDS, LET_GO_SD2 = 600, 2, 60.0


def leaves_much(fits: list[Fitted], noise_grey: float) -> bool:
    """Whether the best of some fits in even light leaves more than noise."""
    best = min(fits, key=lambda one: one.scale_grey)
    contrast = float(typical_contrast(best.numbers, best.light))
    return best.scale_grey > max(EVEN_LEAVES_NOISES * noise_grey, EVEN_LEAVES_CONTRAST_RATIO * contrast)


def is_uneven(seen: Samples, even: list[Fitted]) -> bool:
    """Whether what the best of some fits in even light leaves looks like light."""
    best = min(even, key=lambda one: one.scale_grey)
    pattern = pattern_of_light(seen.values, best.looked, float(best.numbers[RESPONSE]), best.scale_grey, CUT)
    return float(pattern) > LEAST_PATTERN_SD2


def in_light_that_explains(seen: Samples, even: list[Fitted], noise_grey: float) -> list[Fitted]:
    """The same poses in the simplest light that explains the pixels; as they were where none does."""
    some = some_of(seen, TELLING_PIXELS)
    first = _explained(some, even[0], noise_grey)
    if first is None:
        return even
    others = [_begun(some, one, first.light[0], rounds=ROUNDS) for one in even[1:]]
    fits = [first, *(one for one in others if one is not None)]
    return fits if some is seen else [one for one in (again(seen, one) for one in fits) if one is not None]


def _explained(seen: Samples, even: Fitted, noise_grey: float) -> Fitted | None:
    """About this pose in the light that explains the pixels; None where nothing can be fitted."""
    begun = [_begun(seen, even, kind) for kind in (SHADED, GLARING)]
    told = in_question(seen, [one for one in begun if one is not None], LET_GO_SD2)
    fits = [one for one in (again(seen, one) for one in told) if one is not None]
    # What leaves no more than noise leaves nothing to explain.
    if not fits or min(one.scale_grey for one in fits) > noise_grey:
        free = _begun(seen, even, FREE, rounds=ROUNDS)
        fits += [] if free is None else [free]
    if not fits:
        return None
    scale = min(one.scale_grey for one in fits)

    def price(one: Fitted) -> float:
        return cost_of(seen, one, scale) + (FREE_PRICE_SD2 if one.light[0] == FREE else 0.0)

    return min(fits, key=price)


def _begun(seen: Samples, even: Fitted, kind: int, *, rounds: int = TELLING_ROUNDS) -> Fitted | None:
    """The same pose in such a light, after some steps."""
    light = (kind, NODES)
    numbers = np.zeros(numbers_of(light))
    from_plain(even.numbers, light, numbers)
    return fitted(
        seen, even.rotation, even.translation_mm, numbers, light=light, settled=STRAIGHT_SD2, rounds=rounds
    )
