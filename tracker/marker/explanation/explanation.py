"""Do blur, uneven light and something over its border explain what a square shows, and only they?

An image that is out of focus, has a shadow's edge or a highlight in it, or is partly covered, is not like the
model as it is printed. But each of these has its own law: blur spreads the outline as it spreads the inside;
light is bright or dim over whole regions, never negative; a cover is one piece that comes over the border.
What is left when these are fitted says far more than before of whether the inside is the model's.
"""

from dataclasses import dataclass, replace

import numpy as np

from tracker.camera.blur.kernels import axes_of
from tracker.edges import GreyImage
from tracker.geometry import Array
from tracker.marker.explanation.cover import (
    LEAST_AREA_RATIO,
    PART_CONTRAST,
    Mask,
    covered,
    weights_beside_a_cover,
)
from tracker.marker.explanation.fit import UNIT, Fit, inside_square
from tracker.marker.explanation.flips import MOST_FLIPPED_RATIO, most_flipped
from tracker.marker.explanation.kernels import (
    FIELDS,
    RING,
    SATURATED_GREY,
    SPREAD,
    WIDE,
    likeness,
    picture_at,
)
from tracker.marker.explanation.light import contrasts, highlights, shadow_in, smooth_light
from tracker.marker.explanation.pictures import pictures_of
from tracker.marker.explanation.poor_light import light_up
from tracker.marker.explanation.shape import any_shape_of, shape_of
from tracker.marker.explanation.washed_out import LEAST_GLARING_RATIO
from tracker.marker.sampling.kernels import through

FIRST_ROUNDS, ROUNDS, ROUNDS_AGAIN, LIGHT_ROUNDS = 3, 6, 4, 3
LEAST_HOPE = 0.55
WORTH_ANOTHER_LIGHT = 0.75
COVER_ROUNDS = 2
# Light without highlights has a quadratic and a step.
MOST_SMOOTH_TERMS = 7
# By how many fields this turn of the model must explain more than the others do.
LEAST_APART = 2.0
# In empty scenes other squares from 16 px reach 0.91 with a fitted blur, in shadow too, and 0.84 under fitted
# highlights, which take away from both; the marker itself has 0.96 and more, at 20 px under glare 0.93.
# What is small has little to say, and what is covered less.
LIKENESS_SIDES_PX, LEAST_LIKENESS = (18.0, 24.0, 34.0), (0.975, 0.95, 0.94)
HIGHLIGHTS_LESS = 0.02
# What is so like the model as a whole is worth the question whether it is a turn of it.
# Less like its own turns than this, and in full sight, it cannot be mistaken for one of them.
WORTH_TURNING, HALF_TURNED = 0.9, 0.6
COVERED_MORE = 0.01
COVERED_RATIO, MOST_HIDDEN_RATIO = 0.03, 0.45
# The outline is what all squares share: enough of what is within must be seen.
MOST_INNER_HIDDEN_RATIO = 0.55
# In uneven light, the noise that the outline shows taken out, other squares reach 0.92 where they have 0.7
# with it, and wide ones 0.95 with 0.89 (9,000 looked at); of a wide square the noise hides less. Where the
# square is small, nothing is said.
LEAST_UNEVEN_PX, WORTH_UNEVEN = 18.0, 0.7
UNEVEN_ROUNDS = 6
IN_NOISE_SIDES_PX, LEAST_IN_NOISE, LEAST_BESIDE_NOISE = (30.0, 45.0), (0.8, 0.9), 0.94
# Blurred over more of its side all round, or hidden more, a part of the shape passes for light.
MOST_UNEVEN_BLUR_SIDE_RATIO, MOST_UNEVEN_HIDDEN_RATIO = 0.08, 0.4
MOST_UNEVEN_MOVED_PX, MOST_UNEVEN_MOVED_SIDE_RATIO = 2.0, 0.06
SD_OF_MEDIAN = 1.4826
MOST_MOVED_PX, MOST_MOVED_SIDE_RATIO = 2.0, 0.04
# A cover's own edge pulls a fit to it: where there is one, the edges must have been right already.
MOST_MOVED_COVERED_PX, MOST_MOVED_COVERED_SIDE_RATIO = 0.8, 0.02
# Edges of what is smeared are found at either end of its way, an sd and three quarters of it off the middle.
MOST_MOVED_BLURS = 1.75
# Blurred over so much of its side, one square is like another: like this one under highlights, and in every
# other light unless nearly all is explained. In blurred empty scenes other squares in full sight reach 0.93,
# covered ones 0.96 (10,000 looked at); smear leaves one direction sharp, and others 0.8.
BLURRED_SIDE_RATIO, SHARP_SIDE_RATIO, MOST_BLUR_SIDE_RATIO = 0.1, 0.05, 0.16
LEAST_LIKENESS_BLURRED, LEAST_LIKENESS_SMEARED, LEAST_LIKENESS_BLURRED_COVERED = 0.955, 0.94, 0.98


@dataclass(frozen=True, slots=True, kw_only=True)
class BesideNoise:
    """How like the model a square is where noise does not hide it.

    Attributes:
        likeness, inner_likeness: as in `Explanation`, without the noise that the outline shows.
        flipped_ratio: how far the most doubtful part of the shape is from the model, towards dark for bright.
    """

    likeness: float
    inner_likeness: float
    flipped_ratio: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Explanation:
    """How far blur, light and cover explain the pixels of a square.

    Attributes:
        side_px: of the square in the image.
        likeness: correlation of what is visible with the model, blur and light fitted, -1..1.
        inner_likeness: the same where the model has its shape, the outline left out.
        hidden_ratio: part of the square that is covered, 0..1.
        inner_hidden_ratio: the same of where the model has its shape.
        inside_ratio: area of the largest piece that contradicts and is not covered, by the square's.
        corners_px: (4, 2), where they explain it best.
        moved_px: how far the corners (4, 2) had to be moved to explain it best, the farthest.
        blur_px: (2,), sd along the sharpest and the most blurred direction.
        under_highlights: whether highlights had to be fitted.
        is_turned: whether the model, turned by a quarter or more, explains as much.
        beside_noise: in uneven light, what is left of both likenesses when the noise is taken out.
        hidden: which fields of the square and its paper (n, n), from the top left, something covers.
    """

    side_px: float
    likeness: float
    inner_likeness: float
    hidden_ratio: float
    inner_hidden_ratio: float
    inside_ratio: float
    corners_px: Array
    moved_px: float
    blur_px: tuple[float, float]
    hidden: Mask
    under_highlights: bool = False
    is_turned: bool = False
    beside_noise: BesideNoise | None = None

    @property
    def is_covered(self) -> bool:
        """Whether something covers more of the square than a fit leaves over by itself."""
        return self.hidden_ratio > COVERED_RATIO

    def covers(self, at_ratio: Array) -> Mask:
        """Whether something covers these points (n, 2) of the marker's plane.

        They are in sides from its centre, to the right and upwards of the printed face.
        """
        if not self.is_covered:
            return np.zeros(len(at_ratio), np.bool_)
        fields = np.floor((at_ratio * (1.0, -1.0) + 0.5) * FIELDS).astype(np.int64) + RING
        inside = ((fields >= 0) & (fields < WIDE)).all(axis=1)
        columns, rows = np.clip(fields, 0, WIDE - 1).T
        return np.asarray(inside & self.hidden[rows, columns])

    @property
    def explains(self) -> bool:
        """Whether nothing is left that would need another shape to explain it."""
        covered = self.is_covered
        px, ratio = (
            (MOST_MOVED_COVERED_PX, MOST_MOVED_COVERED_SIDE_RATIO)
            if covered
            else (MOST_MOVED_PX, MOST_MOVED_SIDE_RATIO)
        )
        least = float(np.interp(self.side_px, LIKENESS_SIDES_PX, LEAST_LIKENESS))
        if self.beside_noise is not None and not self._explains_beside_noise:
            return False
        if self.blur_px[1] > BLURRED_SIDE_RATIO * self.side_px:
            if self.under_highlights:
                return False
            is_smeared = self.blur_px[0] <= SHARP_SIDE_RATIO * self.side_px
            least = LEAST_LIKENESS_SMEARED if is_smeared else LEAST_LIKENESS_BLURRED
            least = LEAST_LIKENESS_BLURRED_COVERED if covered else least
        return (
            not self.is_turned
            and (
                self.beside_noise is not None
                or min(self.likeness, self.inner_likeness)
                >= least + COVERED_MORE * covered - HIGHLIGHTS_LESS * self.under_highlights
            )
            and self.inside_ratio < LEAST_AREA_RATIO
            and self.hidden_ratio <= MOST_HIDDEN_RATIO
            and self.inner_hidden_ratio <= MOST_INNER_HIDDEN_RATIO
            and self.moved_px <= max(px, ratio * self.side_px, MOST_MOVED_BLURS * self.blur_px[1])
            and self.blur_px[0] <= BLURRED_SIDE_RATIO * self.side_px
            and self.blur_px[1] <= MOST_BLUR_SIDE_RATIO * self.side_px
        )

    @property
    def _explains_beside_noise(self) -> bool:
        """Whether in uneven light the shape stands out of the noise, and little but noise is left of it."""
        without = self.beside_noise
        moved_px = max(MOST_UNEVEN_MOVED_PX, MOST_UNEVEN_MOVED_SIDE_RATIO * self.side_px)
        least = float(np.interp(self.side_px, IN_NOISE_SIDES_PX, LEAST_IN_NOISE))
        return (
            without is not None
            and self.side_px >= LEAST_UNEVEN_PX
            and max(self.hidden_ratio, self.inner_hidden_ratio) <= MOST_UNEVEN_HIDDEN_RATIO
            and self.moved_px <= moved_px
            and self.blur_px[0] <= MOST_UNEVEN_BLUR_SIDE_RATIO * self.side_px
            and min(self.likeness, self.inner_likeness) >= least
            and min(without.likeness, without.inner_likeness) >= LEAST_BESIDE_NOISE
            and without.flipped_ratio <= MOST_FLIPPED_RATIO
        )


def explanation_of(
    image: GreyImage, square: GreyImage, corners_px: Array, *, side_px: float
) -> Explanation | None:
    """Explain a grey image (h, w) by a model (n, n) at about these corners (4, 2); None if it has none of it.

    `corners_px` are pixels of `image`: top-left, top-right, bottom-right, bottom-left of the printed face.
    """
    fit = Fit(image, pictures_of(square), corners_px, side_px)
    best = _in_usual_light(fit)
    if (best is None or not best.explains) and side_px >= LEAST_UNEVEN_PX:
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
    if float(fit.weight[inside_square()].mean()) < LEAST_HOPE or not fit.walk(ROUNDS, fit.weight):
        return None
    start = fit.place
    best = _told(fit)
    glaring = float(np.mean((first.seen >= SATURATED_GREY) & inside_square())) > LEAST_GLARING_RATIO
    for brighten in (_in_shadow, _under_highlights):
        if best is not None and best.explains:
            break
        worth = glaring if brighten is _under_highlights else False
        if not worth and (best is None or best.likeness < WORTH_ANOTHER_LIGHT):
            continue
        # What a cover, or glare, did to the fit must not be carried into another light.
        fit.place = first if worth else start
        if not brighten(fit):
            continue
        found = _told(fit) if fit.walk(ROUNDS if worth else ROUNDS_AGAIN) else None
        if found is not None and (best is None or found.explains or found.likeness > best.likeness):
            best = found
    return best


def _in_uneven_light(fit: Fit) -> Explanation | None:
    """By a shadow's edge and highlights at once, if the square is like the model part by part."""
    if fit.look_part_by_part() < WORTH_UNEVEN:
        return None
    # Where it is, and what lies on it, tell of each other.
    if not (light_up(fit, weights_beside_a_cover(fit.seen, fit.picture)) and fit.walk(UNEVEN_ROUNDS)):
        return None
    if not (light_up(fit, fit.weight) and fit.walk(UNEVEN_ROUNDS)):
        return None
    return _told(fit, in_noise=True)


def _another_turn_is_nearer(fit: Fit) -> bool:
    """Whether the model, turned by a quarter or more where it is, leaves less of what is seen."""
    layers, blurs = fit.pictures.layers, fit.pictures.blurs_fields
    visible, fit.visible = fit.visible, np.ones((WIDE, WIDE), np.bool_)
    shown, weight = fit.shown.copy(), fit.weight.copy()
    held = fit.held.copy()
    costs = []
    for turns in range(4):
        swapped = np.array([fit.blur[1], fit.blur[0], -fit.blur[2]]) if turns % 2 else fit.blur
        picture_at(layers, blurs, swapped, fit.shown)
        fit.shown[0] = np.rot90(fit.shown[0], turns).copy()
        seen = fit.walk(LIGHT_ROUNDS, weight.copy(), free=0)
        off = fit.rest / (PART_CONTRAST * np.maximum(fit.gain, 0.25 * float(np.median(fit.gain))))
        costs.append(float(np.minimum(off**2, 1.0)[inside_square()].sum()) if seen else np.inf)
    fit.visible, fit.shown, fit.weight, fit.held = visible, shown, weight, held
    return costs[0] > min(costs[1:]) - LEAST_APART


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
    worth = found.explains if in_noise else found.likeness >= WORTH_TURNING
    if not worth or not (found.is_covered or fit.pictures.turned_likeness > HALF_TURNED):
        return found
    return replace(found, is_turned=_another_turn_is_nearer(fit))


def _explanation(fit: Fit, *, in_noise: bool) -> Explanation:
    hidden, inside = covered(fit.left, blur_fields=fit.blur_fields)
    visible = ~hidden & fit.visible
    telling = visible & (fit.seen < SATURATED_GREY) & fit.clear
    shape = shape_of(fit.picture)
    return Explanation(
        side_px=fit.side_px,
        likeness=likeness(fit.seen, fit.rest, telling & inside_square(), fit.light, 0.0),
        inner_likeness=likeness(fit.seen, fit.rest, telling & shape, fit.light, 0.0),
        hidden_ratio=1.0 - float(visible[inside_square()].mean()),
        inner_hidden_ratio=1.0 - float(visible[shape].mean()),
        inside_ratio=inside / FIELDS**2,
        corners_px=np.array([through(fit.to_px, a, b) for a, b in fit.corners]),
        moved_px=float(np.abs(fit.corners - UNIT).max()) * fit.side_px,
        under_highlights=fit.light.shape[1] > MOST_SMOOTH_TERMS,
        blur_px=_blur_px(fit.blur, fit.field_px),
        beside_noise=_beside_noise(fit, telling, shape) if in_noise else None,
        hidden=~visible,
    )


def _beside_noise(fit: Fit, telling: Mask, shape: Mask) -> BesideNoise:
    """What all squares share, outline and paper, shows by what is left of it how much is noise."""
    left = np.abs(fit.rest[telling & ~shape])
    noise = SD_OF_MEDIAN * float(np.median(left)) if len(left) else 0.0
    alike, inner = (
        likeness(fit.seen, fit.rest, telling & part, fit.light, noise) for part in (inside_square(), shape)
    )
    hopeful = min(alike, inner) >= LEAST_BESIDE_NOISE
    return BesideNoise(
        likeness=alike,
        inner_likeness=inner,
        flipped_ratio=most_flipped(fit, telling, any_shape_of(fit.picture), noise) if hopeful else 1.0,
    )


def _blur_px(blur: Array, field_px: float) -> tuple[float, float]:
    larger, smaller, _, _ = axes_of(blur[0], blur[1], blur[2])
    least, most = (float(np.sqrt(max(one - SPREAD, 0.0))) for one in (smaller, larger))
    return least * field_px, most * field_px
