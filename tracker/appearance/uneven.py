"""Light that varies over the marker: which kind of it explains the pixels.

Shadows and lamps stay where they are from image to image, so the light of one image serves the next ten as
long as it leaves no larger residuals; a step under a shadow's edge or a highlight then takes 3 to 8 ms
instead of 6 to 24. It is used only where one planar solution is possible, because fitted light belongs to
one pose. A light that changes its kind may be noticed some images late.
"""

from dataclasses import dataclass

import numpy as np

from tracker.appearance.fit import (
    CUT,
    ROUNDS,
    STRAIGHT_SD2,
    Fitted,
    again,
    all_again,
    cost_of,
    fitted,
    in_question,
)
from tracker.appearance.light.fields.kernels import (
    FREE,
    GLARING,
    PLAIN,
    SHADED,
    from_plain,
    numbers_of,
    typical_contrast,
)
from tracker.appearance.light.kernels import RESPONSE
from tracker.appearance.light.pattern.kernels import pattern_of_light
from tracker.appearance.samples import Samples, some_of
from tracker.geometry import Array

# Uneven light is a net of so many nodes a side: a shadow's edge is a fifth of the marker wide, a highlight
# less.
NODES = 10
# What even light leaves unexplained, in units of the noise and of the contrast, before light may vary.
EVEN_LEAVES_NOISES, EVEN_LEAVES_CONTRAST_RATIO = 1.4, 0.02
# Noise, blocks of a compressed picture and things behind the marker have under 30 of the pattern of light; a
# shadow that takes half of it, or a highlight of half its height, over 150.
MIN_PATTERN_SD2 = 80.0
# Two fields explain what one does too, and by chance a little more.
FREE_PRICE_SD2 = 50.0
# So many pixels, and so many steps, tell which light it is; one that then costs so much more is let go.
TELLING_PIXELS, TELLING_ROUNDS, LET_GO_SD2 = 600, 2, 60.0
# The light of an image serves so many more, as long as it leaves at most so many times as much: then it is
# asked anew which light it is.
MAX_IMAGES, MAX_MORE_LEFT = 10, 1.15


@dataclass(frozen=True, slots=True, kw_only=True)
class KnownLight:
    """Uneven light that explained an image.

    Attributes:
        light: its kind, and the nodes of its net.
        numbers: of blur, response and light, as `whole_fit` has them.
        scale_grey: of the residuals that it left.
        images: how many it has served since it was asked which light it is.
    """

    light: tuple[int, int]
    numbers: Array
    scale_grey: float
    images: int


def known_from(one: Fitted, before: KnownLight | None) -> KnownLight | None:
    """The light of a fit, found anew or from that of the image before; None where it is even."""
    if one.light[0] == PLAIN:
        return None
    images = 0 if before is None else before.images + 1
    return KnownLight(light=one.light, numbers=one.numbers, scale_grey=one.scale_grey, images=images)


def in_known_light(seen: Samples, rotation: Array, translation_mm: Array, known: KnownLight) -> Fitted | None:
    """A pose from a start, in about the light of the image before; None where that explains less now."""
    if known.images >= MAX_IMAGES:
        return None
    some = some_of(seen, TELLING_PIXELS)
    one = fitted(some, rotation, translation_mm, known.numbers, light=known.light, settled=STRAIGHT_SD2)
    if one is None or one.scale_grey > MAX_MORE_LEFT * known.scale_grey:
        return None
    return one if some is seen else again(seen, one)


def leaves_much(fits: list[Fitted], noise_grey: float) -> bool:
    """Whether the best of some fits in even light leaves more than noise."""
    best = min(fits, key=lambda one: one.scale_grey)
    contrast = float(typical_contrast(best.numbers, best.light))
    return best.scale_grey > max(EVEN_LEAVES_NOISES * noise_grey, EVEN_LEAVES_CONTRAST_RATIO * contrast)


def is_uneven(seen: Samples, even: list[Fitted]) -> bool:
    """Whether what the best of some fits in even light leaves looks like light."""
    best = min(even, key=lambda one: one.scale_grey)
    pattern = pattern_of_light(seen.values, best.looked, float(best.numbers[RESPONSE]), best.scale_grey, CUT)
    return float(pattern) > MIN_PATTERN_SD2


def in_light_that_explains(seen: Samples, even: list[Fitted], noise_grey: float) -> list[Fitted]:
    """The same poses in the simplest light that explains the pixels; as they were where none does."""
    some = some_of(seen, TELLING_PIXELS)
    first = _explained(seen, some, even[0], noise_grey)
    if first is None:
        return even
    others = [_begun(some, one, first.light[0], rounds=ROUNDS) for one in even[1:]]
    return [first, *_by_all(seen, some, others)]


def _explained(seen: Samples, some: Samples, even: Fitted, noise_grey: float) -> Fitted | None:
    """About this pose in the light that explains the pixels; None where nothing can be fitted."""
    begun = [_begun(some, even, kind) for kind in (SHADED, GLARING)]
    told = in_question(some, [one for one in begun if one is not None], LET_GO_SD2)
    fits = all_again(seen, told)
    # What leaves no more than noise leaves nothing to explain.
    if not fits or min(one.scale_grey for one in fits) > noise_grey:
        fits += _by_all(seen, some, [_begun(some, even, FREE, rounds=ROUNDS)])
    if not fits:
        return None
    scale = min(one.scale_grey for one in fits)

    def price(one: Fitted) -> float:
        return cost_of(seen, one, scale) + (FREE_PRICE_SD2 if one.light[0] == FREE else 0.0)

    return min(fits, key=price)


def _by_all(seen: Samples, some: Samples, fits: list[Fitted | None]) -> list[Fitted]:
    """Fits to some of the pixels, by all of them; those that fail are left out."""
    return [one for one in fits if one is not None] if some is seen else all_again(seen, fits)


def _begun(seen: Samples, even: Fitted, kind: int, *, rounds: int = TELLING_ROUNDS) -> Fitted | None:
    """The same pose in such a light, after some steps."""
    light = (kind, NODES)
    numbers = np.zeros(numbers_of(light))
    from_plain(even.numbers, light, numbers)
    return fitted(
        seen, even.rotation, even.translation_mm, numbers, light=light, settled=STRAIGHT_SD2, rounds=rounds
    )
