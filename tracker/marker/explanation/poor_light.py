"""The light on a square, cause after cause: a shadow's edge, and highlights, as long as each explains much.

A net of highlights takes in half of what is small in the shape, and what is left then says little. A few
causes, each of its own form, leave the shape what is the shape's.

Light and place are fitted in turn up to three times, and a highlight takes the form that explains most:
highlights from a fixed set leave residuals as large as noise leaves of the shape. The outline, which all
squares share, shows how much of the residual is noise; the inside must be explained but for that. Where
half of the shape is too bright to judge, or blur exceeds a tenth of the side, nothing is claimed. Of two
places that both fit, the one that fits in plain light wins. Some markers under strong highlights, and most
of 20 px, are therefore missed.
"""

from dataclasses import dataclass

import numpy as np

from tracker.geometry import Array
from tracker.marker.explanation.fit import Fit
from tracker.marker.explanation.kernels import OUTLIER_CONTRAST
from tracker.marker.explanation.light import contrasts, highlight_in, shadow_in, smooth_light

MAX_CAUSES = 3
FIRST_ROUNDS, ROUNDS = 4, 3
# A cause must take away this share of what is unlike, and some fields' worth of it.
MAX_LEFT_RATIO, MIN_FIELDS = 0.93, 5.0
MIN_GAIN_RATIO = 0.25


@dataclass(frozen=True, slots=True, kw_only=True)
class Lit:
    """A fit's light, and what it leaves.

    Attributes:
        light: what is added (fields, n).
        gains: how contrast may vary (fields, m).
        weight: how much each field says (n, n).
        unlike: how many fields, about, are not explained.
    """

    light: Array
    gains: Array
    weight: Array
    unlike: float


def light_up(fit: Fit, weight: Array | None) -> bool:
    """Fit the light of a square, place and blur held; False where the model has no contrast.

    `weight` (n, n) is how much each field says to begin with.
    """
    best = _lit(fit, smooth_light(2), contrasts(), weight, rounds=FIRST_ROUNDS)
    if best is None:
        return False
    for _ in range(MAX_CAUSES):
        tried = [one for one in (_in_shadow(fit, best), _under_a_highlight(fit, best)) if one is not None]
        better = min(tried, key=lambda one: one.unlike, default=best)
        enough = better.unlike < min(MAX_LEFT_RATIO * best.unlike, best.unlike - MIN_FIELDS)
        best = better if enough else best
        if _lit(fit, best.light, best.gains, best.weight, rounds=1) is None:
            return False
        if not enough:
            break
    return True


def _in_shadow(fit: Fit, lit: Lit) -> Lit | None:
    """The same with a shadow's edge; None where it has one, or none explains much."""
    if lit.gains.shape[1] > contrasts().shape[1]:
        return None
    # Light is added by a highlight; what a shadow takes away is contrast.
    edge = shadow_in(fit.rest + fit.gain * fit.picture, fit.picture, fit.visible)
    if edge is None:
        return None
    light, gains = (np.column_stack([one, edge]) for one in (lit.light, lit.gains))
    return _lit(fit, light, gains, lit.weight, rounds=ROUNDS)


def _under_a_highlight(fit: Fit, lit: Lit) -> Lit | None:
    """The same with one more highlight; None where none explains much."""
    explained = np.hstack([fit.light, fit.gains * fit.picture.reshape(-1, 1)])
    highlight = highlight_in(fit.rest, explained, fit.weight * fit.visible)
    if highlight is None:
        return None
    return _lit(fit, np.column_stack([lit.light, highlight]), lit.gains, lit.weight, rounds=ROUNDS)


def _lit(fit: Fit, light: Array, gains: Array, weight: Array | None, *, rounds: int) -> Lit | None:
    fit.light, fit.gains = light, gains
    if not fit.walk(rounds, None if weight is None else weight.copy(), free=0):
        return None
    contrast = np.maximum(fit.gain, MIN_GAIN_RATIO * float(np.median(fit.gain)))
    off = np.minimum((fit.rest / (OUTLIER_CONTRAST * contrast)) ** 2, 1.0)
    return Lit(light=light, gains=gains, weight=fit.weight, unlike=float(off[fit.visible].sum()))
