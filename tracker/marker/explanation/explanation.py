"""Do blur, uneven light and something over its border explain what a square shows, and only they?

An image that is out of focus, has a shadow's edge or a highlight in it, or is partly covered, is not like the
model as it is printed. But each of these has its own law: blur spreads the outline as it spreads the inside;
light is bright or dim over whole regions, never negative; a cover is one piece that comes over the border.
What is left when these are fitted says far more than before of whether the inside is the model's.
"""

from dataclasses import replace

import numpy as np

from tracker.camera.blur.kernels import axes_of
from tracker.edges import GreyImage
from tracker.geometry import Array
from tracker.marker.explanation.acceptance import (
    MIN_BESIDE_NOISE,
    MIN_UNEVEN_PX,
    BesideNoise,
    Explanation,
)
from tracker.marker.explanation.cover import (
    Mask,
    covered,
    weights_beside_a_cover,
)
from tracker.marker.explanation.fields.kernels import FIELDS, SPREAD, WIDE
from tracker.marker.explanation.fit import UNIT, Fit, inside_square
from tracker.marker.explanation.flips import max_flipped
from tracker.marker.explanation.kernels import SATURATED_GREY, correlation
from tracker.marker.explanation.light import contrasts, highlights, shadow_in, smooth_light
from tracker.marker.explanation.pictures import pictures_of
from tracker.marker.explanation.poor_light import light_up
from tracker.marker.explanation.shape import any_shape_of, shape_of
from tracker.marker.explanation.turns import another_turn_is_nearer
from tracker.marker.explanation.washed_out import MIN_GLARING_RATIO
from tracker.marker.sampling.kernels import through

FIRST_ROUNDS, ROUNDS, ROUNDS_AGAIN = 3, 6, 4
MIN_HOPE = 0.55
WORTH_ANOTHER_LIGHT = 0.75
COVER_ROUNDS = 2
# What is so like the model as a whole, and inside, is worth the question whether it is a turn of it: what is
# less like it inside is not believed either way.
# Less like its own turns than this, and in full sight, it cannot be mistaken for one of them.
WORTH_TURNING, WORTH_TURNING_INSIDE, HALF_TURNED = 0.9, 0.85, 0.6
# How like the model part by part a square is that uneven light is worth fitting to.
WORTH_UNEVEN = 0.7
UNEVEN_ROUNDS = 6
# Turns of light and place: the first is too rough to be told from, the last is for what is nearly explained.
UNEVEN_TURNS, FIRST_TOLD_TURN, WORTH_ANOTHER_TURN = 3, 2, 0.85
SD_OF_MEDIAN = 1.4826


def explanation_of(
    image: GreyImage, square: GreyImage, corners_px: Array, *, side_px: float
) -> Explanation | None:
    """Explain a grey image (h, w) by a model (n, n) at about these corners (4, 2); None if it has none of it.

    `corners_px` are pixels of `image`: top-left, top-right, bottom-right, bottom-left of the printed face.
    """
    fit = Fit(image, pictures_of(square), corners_px, side_px)
    best = _in_usual_light(fit)
    if (best is None or not best.explains) and side_px >= MIN_UNEVEN_PX:
        uneven = _in_uneven_light(Fit(image, pictures_of(square), corners_px, side_px))
        if uneven is not None and uneven.explains:
            return uneven
    return best


def _in_usual_light(fit: Fit) -> Explanation | None:
    """By smooth light, by a shadow's edge in it, or by highlights: what explains it first, or best."""
    fit.look()
    first = fit.place
    if not fit.walk(FIRST_ROUNDS, weights_beside_a_cover(fit.seen, fit.picture)):
        return None
    # Even of a marker under a cover or glare most can be explained by now.
    if float(fit.weight[inside_square()].mean()) < MIN_HOPE or not fit.walk(ROUNDS, fit.weight):
        return None
    start = fit.place
    best = _told(fit)
    glaring = float(np.mean((first.seen >= SATURATED_GREY) & inside_square())) > MIN_GLARING_RATIO
    for brighten in (_in_shadow, _under_highlights):
        if best is not None and best.explains:
            break
        worth = glaring if brighten is _under_highlights else False
        if not worth and (best is None or best.correlation < WORTH_ANOTHER_LIGHT):
            continue
        # What a cover, or glare, did to the fit must not be carried into another light.
        fit.place = first if worth else start
        if not brighten(fit):
            continue
        found = _told(fit) if fit.walk(ROUNDS if worth else ROUNDS_AGAIN) else None
        if found is not None and (best is None or found.explains or found.correlation > best.correlation):
            best = found
    return best


def _in_uneven_light(fit: Fit) -> Explanation | None:
    """By a shadow's edge and highlights at once, if the square is like the model part by part."""
    if fit.look_part_by_part() < WORTH_UNEVEN:
        return None
    weight, found = weights_beside_a_cover(fit.seen, fit.picture), None
    # Where it is, what light falls on it and what lies on it tell of each other.
    for turn in range(UNEVEN_TURNS):
        if not (light_up(fit, weight) and fit.walk(UNEVEN_ROUNDS)):
            return found
        if turn + 1 >= FIRST_TOLD_TURN:
            found = _told(fit, in_noise=True)
            if found is None or found.explains or found.correlation < WORTH_ANOTHER_TURN:
                return found
        weight, fit.visible = fit.weight, np.ones((WIDE, WIDE), np.bool_)
    return found


def _in_shadow(fit: Fit) -> bool:
    """Let there be a shadow's edge, if one explains much."""
    shadow = shadow_in(fit.seen, fit.picture, fit.visible)
    if shadow is None:
        return False
    fit.light = np.column_stack([smooth_light(2), shadow])
    fit.gains = np.column_stack([contrasts(), shadow])
    return True


def _under_highlights(fit: Fit) -> bool:
    """Let there be highlights."""
    fit.light, fit.gains = highlights(), contrasts()
    return True


def _told(fit: Fit, *, in_noise: bool = False) -> Explanation | None:
    """The explanation by this light; what is covered has no say, and without it shows more clearly."""
    for _ in range(COVER_ROUNDS):
        hidden, _ = covered(fit.left, blur_fields=fit.blur_fields)
        if not hidden.any():
            break
        fit.visible = ~hidden
        if not (fit.visible & inside_square()).any() or not fit.walk(ROUNDS_AGAIN):
            return None
    found = _explanation(fit, in_noise=in_noise)
    nearly = found.correlation >= WORTH_TURNING and found.inner_correlation >= WORTH_TURNING_INSIDE
    worth = found.explains if in_noise else nearly
    if not worth or not (found.is_covered or fit.pictures.turned_correlation > HALF_TURNED):
        return found
    return replace(found, is_turned=another_turn_is_nearer(fit))


def _explanation(fit: Fit, *, in_noise: bool) -> Explanation:
    hidden, inside = covered(fit.left, blur_fields=fit.blur_fields)
    visible = ~hidden & fit.visible
    telling = fit.telling(visible)
    shape = shape_of(fit.picture)
    return Explanation(
        side_px=fit.side_px,
        correlation=correlation(fit.seen, fit.rest, telling & inside_square(), fit.light, 0.0),
        inner_correlation=correlation(fit.seen, fit.rest, telling & shape, fit.light, 0.0),
        hidden_ratio=1.0 - float(visible[inside_square()].mean()),
        inner_hidden_ratio=1.0 - float(visible[shape].mean()),
        inner_untold_ratio=1.0 - float(telling[shape].mean()),
        inside_ratio=inside / FIELDS**2,
        corners_px=np.array([through(fit.to_px, a, b) for a, b in fit.corners]),
        moved_px=float(np.abs(fit.corners - UNIT).max()) * fit.side_px,
        under_highlights=fit.is_under_highlights,
        blur_px=_blur_px(fit.blur, fit.field_px),
        beside_noise=_beside_noise(fit, telling, shape) if in_noise else None,
        hidden=~visible,
    )


def _beside_noise(fit: Fit, telling: Mask, shape: Mask) -> BesideNoise:
    """What all squares share, outline and paper, shows by what is left of it how much is noise."""
    left = np.abs(fit.rest[telling & ~shape])
    noise = SD_OF_MEDIAN * float(np.median(left)) if len(left) else 0.0
    alike, inner = (
        correlation(fit.seen, fit.rest, telling & part, fit.light, noise) for part in (inside_square(), shape)
    )
    hopeful = min(alike, inner) >= MIN_BESIDE_NOISE
    return BesideNoise(
        correlation=alike,
        inner_correlation=inner,
        flipped_ratio=max_flipped(fit, telling, any_shape_of(fit.picture), noise) if hopeful else 1.0,
    )


def _blur_px(blur: Array, field_px: float) -> tuple[float, float]:
    larger, smaller, _, _ = axes_of(blur[0], blur[1], blur[2])
    least, most = (float(np.sqrt(max(one - SPREAD, 0.0))) for one in (smaller, larger))
    return least * field_px, most * field_px
