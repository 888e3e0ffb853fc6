"""The compiled loops of the light: how bright dark and bright are over the marker."""

import numpy as np

from tracker.compiled import compiled
from tracker.geometry.kernels import add_products, solve_positive

# Numbers of a fit: translation 3, turn 3, blur 3 (variances along u, v and between), response 1, then light.
BLUR, RESPONSE, LIGHT = 6, 9, 10
# Fitted to powers of 1 to 3 and their inverses, where ink sends a tenth of what paper does.
LOPSIDED = 0.93
# Even light: brightness of the dark and contrast, each with its slope to the right and upwards.
PLANE = 6


@compiled
def shaped_by(s, response):
    """What a camera of this response makes of a picture's value 0..1.

    A power of the light, as cameras have it, bends dark values more than bright ones, and the more so the
    more it bends.
    """
    return s + response * s * (1.0 - s) * (1.0 + LOPSIDED * abs(response) * (1.0 - 2.0 * s))


@compiled
def slope_of(s, response):
    """How that grows with the picture's value."""
    more = LOPSIDED * abs(response) * (1.0 - 6.0 * s * (1.0 - s))
    return 1.0 + response * (1.0 - 2.0 * s + more)


@compiled
def by_response(s, response):
    """How that grows with the response."""
    return s * (1.0 - s) * (1.0 + 2.0 * LOPSIDED * abs(response) * (1.0 - 2.0 * s))


@compiled
def even_light(picture, at, values, numbers, scale, cut):
    """Fit an even light alone, robustly, into numbers[10:16]; False where there is none.

    `picture` (n,): what each pixel sees of it, 0..1.
    """
    a, g, out = np.empty((PLANE, PLANE)), np.empty(PLANE), np.zeros(PLANE)
    n, response = len(values), numbers[RESPONSE]
    rows, left, weights, room = np.empty((PLANE, n)), np.empty(n), np.ones(n), np.empty(n)
    for i in range(n):
        u, v = at[i, 0], at[i, 1]
        shaped = shaped_by(picture[i], response)
        rows[0, i], rows[1, i], rows[2, i] = 1.0, u, v
        rows[3, i], rows[4, i], rows[5, i] = shaped, shaped * u, shaped * v
    for turn in range(3):
        a[:, :] = 0.0
        add_products(rows, weights, n, room, a)
        for m in range(PLANE):
            total = 0.0
            for i in range(n):
                total += weights[i] * rows[m, i] * values[i]
            g[m] = total
        # Slopes of the light are small unless the image says otherwise.
        for m in (1, 2, 4, 5):
            a[m, m] += 0.02 * a[0, 0]
        if not solve_positive(a, g, out):
            return False
        left[:] = values
        for m in range(PLANE):
            for i in range(n):
                left[i] -= out[m] * rows[m, i]
        if turn == 0:
            scale = max(1.4826 * np.median(np.abs(left)), scale)
        for i in range(n):
            weights[i] = 1.0 / (1.0 + (left[i] / (cut * scale)) ** 2) ** 2
    numbers[LIGHT : LIGHT + PLANE] = out
    return True
