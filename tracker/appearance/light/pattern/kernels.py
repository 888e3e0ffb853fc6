"""The compiled loops of that question; their types are those of their calls."""

import numpy as np

from tracker.appearance.light.kernels import shaped_by
from tracker.compiled import compiled
from tracker.geometry.kernels import add_products, solve_positive

# Even light, on dark and on bright, and what bends: squares and cubes over the marker, on each.
EVEN_ROWS, ROWS = 6, 20
# So many pixels tell.
MAX_ASKED = 800


@compiled
def _explained(a, g, count):
    """By how much the first numbers of normal equations lower the cost; 0 where they are not told."""
    some, out = np.ascontiguousarray(a[:count, :count]), np.zeros(count)
    sides = g[:count].copy()
    if not solve_positive(some, sides, out):
        return 0.0
    total = 0.0
    for k in range(count):
        total += out[k] * sides[k]
    return total


@compiled
def pattern_of_light(values, looked, response, scale, cut):
    """How much of a fit's residuals bent light explains, in squares by their variance.

    `looked`: of `whole_fit` in even light. Of white noise it is 14 on average, and of blocks of a compressed
    picture no more: both are uneven, but not smooth.
    """
    picture, at, lit, own = looked[0][0], looked[1], looked[2], looked[3]
    every = len(values) // MAX_ASKED + 1
    count = (len(values) + every - 1) // every
    rows, left, weights, room = np.empty((ROWS, count)), np.empty(count), np.empty(count), np.empty(count)
    unit = 1.0 / (cut * scale) ** 2
    for k in range(count):
        i = k * every
        u, v = at[i, 0], at[i, 1]
        shaped = shaped_by(picture[i], response)
        r = values[i] - lit[i, 0] - lit[i, 1] * shaped
        left[k], weights[k] = r, own[i] / (1.0 + r * r * own[i] * unit) ** 2
        rows[0, k], rows[1, k], rows[2, k] = 1.0, u, v
        rows[6, k], rows[7, k], rows[8, k] = u * u, u * v, v * v
        rows[9, k], rows[10, k], rows[11, k], rows[12, k] = u * u * u, u * u * v, u * v * v, v * v * v
        for m in range(3):
            rows[3 + m, k] = shaped * rows[m, k]
        for m in range(7):
            rows[13 + m, k] = shaped * rows[6 + m, k]
    a, g = np.zeros((ROWS, ROWS)), np.zeros(ROWS)
    add_products(rows, weights, count, room, a)
    for m in range(ROWS):
        for k in range(count):
            g[m] += weights[k] * left[k] * rows[m, k]
    return (_explained(a, g, ROWS) - _explained(a, g, EVEN_ROWS)) / (scale * scale)
