"""Test whether residuals under planar illumination contain smooth illumination (lack-of-fit test)."""

import numpy as np

from tracker.compiled import compiled
from tracker.geometry.geometry_kernels import add_products, solve_positive
from tracker.photometric.response_kernels import apply_response

# Number of planar terms, and of all terms up to cubic, of dark level and contrast together.
EVEN_ROWS, ROWS = 6, 20
# Maximum number of pixels of the test.
MAX_TEST_PIXELS = 800


@compiled
def _chi2_decrease(a, g, count):
    """Return the decrease of chi-square by fitting the first `count` parameters; 0 for a singular system."""
    some, sides, out = np.empty((count, count)), np.empty(count), np.zeros(count)
    for j in range(count):
        sides[j] = g[j]
        for k in range(count):
            some[j, k] = a[j, k]
    if not solve_positive(some, sides, out):
        return 0.0
    total = 0.0
    for k in range(count):
        total += out[k] * sides[k]
    return total


@compiled
def illumination_pattern_chi2(values, prediction, response, scale, cutoff):
    """Return the decrease of chi-square when quadratic and cubic illumination terms are added.

    `prediction`: of `refine_pose` under planar illumination. White noise gives 14 on average, as expected for
    14 added parameters; compression blocks give no more, because they are not smooth.
    """
    picture, at, dark_contrast, reliability = prediction[0][0], prediction[1], prediction[2], prediction[3]
    every = len(values) // MAX_TEST_PIXELS + 1
    count = (len(values) + every - 1) // every
    rows, residuals, weights, workspace = (
        np.empty((ROWS, count)),
        np.empty(count),
        np.empty(count),
        np.empty(count),
    )
    unit = 1.0 / (cutoff * scale) ** 2
    for k in range(count):
        i = k * every
        u, v = at[i, 0], at[i, 1]
        signal = apply_response(picture[i], response)
        r = values[i] - dark_contrast[i, 0] - dark_contrast[i, 1] * signal
        residuals[k], weights[k] = r, reliability[i] / (1.0 + r * r * reliability[i] * unit) ** 2
        rows[0, k], rows[1, k], rows[2, k] = 1.0, u, v
        rows[6, k], rows[7, k], rows[8, k] = u * u, u * v, v * v
        rows[9, k], rows[10, k], rows[11, k], rows[12, k] = u * u * u, u * u * v, u * v * v, v * v * v
        for m in range(3):
            rows[3 + m, k] = signal * rows[m, k]
        for m in range(7):
            rows[13 + m, k] = signal * rows[6 + m, k]
    a, g = np.zeros((ROWS, ROWS)), np.zeros(ROWS)
    add_products(rows, weights, count, workspace, a)
    for m in range(ROWS):
        for k in range(count):
            g[m] += weights[k] * residuals[k] * rows[m, k]
    return (_chi2_decrease(a, g, np.int64(ROWS)) - _chi2_decrease(a, g, np.int64(EVEN_ROWS))) / (
        scale * scale
    )
