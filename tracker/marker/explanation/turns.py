"""Is it the model, or that turned or mirrored? Asked where covers and highlights hide what tells.

A highlight fitted to a quarter turn can explain a marker that is nearly its own turn (correlation 0.83)
better than the highlight fitted to the right turn does. So a marker is claimed only where no other turn
explains as much, each with a highlight of its own, and under covers or highlights not where its mirror
image explains more. Two contradicting fits at one place claim neither. This removes ten of twelve turned
claims in a thousand scenes under glare.
"""

import numpy as np
import numpy.typing as npt

from tracker.geometry import Array
from tracker.marker.explanation.cover import PART_CONTRAST, weights_beside_a_cover
from tracker.marker.explanation.fields.kernels import WIDE, picture_at
from tracker.marker.explanation.fit import Fit, inside_square
from tracker.marker.sampling.kernels import through

# By how many fields this turn of the model must explain more than the others do. A highlight that was fitted
# to a wrong one explains up to 5 more of it than of the right one, where the shape is nearly its own turn.
MIN_APART = 8.0
# A marker may well be nearly its own mirror image.
MAX_ALIKE = 0.9
LIGHT_ROUNDS, ROUNDS = 3, 6


def another_turn_is_nearer(fit: Fit) -> bool:
    """Whether the model, turned by a quarter or more, explains nearly as much, or its mirror image more.

    Highlights make room for many shapes: there, each turn looks for a place, a blur and a light of its own.
    """
    own = _left(fit)
    if _is_nearer_where_it_is(fit):
        return True
    return fit.is_under_highlights and any(_left_by_own_walk(fit, turns) < own for turns in (1, 2, 3))


def _left(fit: Fit) -> float:
    """How many fields of the square a fit leaves unexplained."""
    off = fit.rest / (PART_CONTRAST * np.maximum(fit.gain, 0.25 * float(np.median(fit.gain))))
    return float(np.minimum(off**2, 1.0)[inside_square()].sum())


def _is_nearer_where_it_is(fit: Fit) -> bool:
    """Whether another turn leaves less where this one is, or not enough more; or a mirror image less."""
    visible, fit.visible = fit.visible, np.ones((WIDE, WIDE), np.bool_)
    shown, weight, held = fit.shown.copy(), fit.weight.copy(), fit.held.copy()
    own, *others = (_left_as(fit, turns, weight) for turns in range(4))
    mirrored = [_left_as(fit, turns, weight, mirror_of=shown[0]) for turns in range(4)]
    fit.visible, fit.shown, fit.weight, fit.held = visible, shown, weight, held
    return own > min(others) - MIN_APART or own > min(mirrored)


def _left_as(
    fit: Fit, turns: int, weight: Array, *, mirror_of: npt.NDArray[np.float32] | None = None
) -> float:
    """What the model leaves here when turned, or mirrored too; all, if that is like what it mirrors."""
    sign = 1.0 if mirror_of is None else -1.0
    blur, ahead = fit.blur * (1.0, 1.0, sign), fit.ahead * np.array([[sign], [1.0]])
    for _ in range(turns):
        # The picture is turned back afterwards.
        blur, ahead = np.array([blur[1], blur[0], -blur[2]]), np.array([ahead[1], -ahead[0]])
    picture_at(fit.pictures.layers, fit.pictures.blurs_fields, blur, ahead, fit.shown)
    fit.shown[0] = np.rot90(fit.shown[0], turns).copy()
    if mirror_of is not None:
        fit.shown[0] = fit.shown[0][:, ::-1].copy()
        inside = inside_square()
        if np.corrcoef(fit.shown[0][inside], mirror_of[inside])[0, 1] > MAX_ALIKE:
            return np.inf
    return _left(fit) if fit.walk(LIGHT_ROUNDS, weight.copy(), free=0) else np.inf


def _left_by_own_walk(fit: Fit, turns: int) -> float:
    """What the model leaves, so many quarters turned to the left, after a walk from where this fit is."""
    corners_px = np.array([through(fit.to_px, a, b) for a, b in fit.corners])
    other = Fit(fit.image, fit.pictures, np.roll(corners_px, -turns, axis=0), fit.side_px)
    other.light, other.gains = _turned(fit.light, turns), _turned(fit.gains, turns)
    other.look()
    walked = other.walk(ROUNDS, weights_beside_a_cover(other.seen, other.picture))
    return _left(other) if walked else np.inf


def _turned(light: Array, turns: int) -> Array:
    """What light may add (fields, n), on fields that are turned by so many quarters."""
    turned = np.rot90(light.reshape(WIDE, WIDE, -1), turns)
    return np.ascontiguousarray(turned.reshape(WIDE * WIDE, -1))
