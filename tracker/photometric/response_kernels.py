"""Camera response curve, and a robust fit of planar illumination."""

import numpy as np

from tracker.compiled import compiled
from tracker.geometry.geometry_kernels import add_products, copy_vector, median, solve_positive

# Parameters of a fit: translation 3, rotation 3, blur 3 (variances along u, v, covariance), response 1,
# illumination.
BLUR, RESPONSE, ILLUMINATION = 6, 9, 10
# Fitted to gamma curves with exponents of 1 to 3 and their inverses, where ink reflects a tenth of paper.
RESPONSE_ASYMMETRY = 0.93
# Planar illumination: dark level and contrast, each with its slopes to the right and upwards.
PLANAR_PARAMETERS = 6


@compiled
def apply_response(s, response):
    """Apply the camera response to a linear value 0..1.

    Like a gamma curve it changes dark values more than bright ones; `response` 0 is linear.
    """
    return s + response * s * (1.0 - s) * (1.0 + RESPONSE_ASYMMETRY * abs(response) * (1.0 - 2.0 * s))


@compiled
def response_slope(s, response):
    """Return the derivative of the response by the linear value."""
    more = RESPONSE_ASYMMETRY * abs(response) * (1.0 - 6.0 * s * (1.0 - s))
    return 1.0 + response * (1.0 - 2.0 * s + more)


@compiled
def response_derivative(s, response):
    """Return the derivative of the response by the response parameter."""
    return s * (1.0 - s) * (1.0 + 2.0 * RESPONSE_ASYMMETRY * abs(response) * (1.0 - 2.0 * s))


@compiled
def fit_planar_illumination(picture, at, values, parameters, scale, cutoff):
    """Fit planar illumination robustly into `parameters[10:16]`; return False where the system is singular.

    `picture` (n,): rendered value of each pixel, 0..1.
    """
    a, g, out = (
        np.empty((PLANAR_PARAMETERS, PLANAR_PARAMETERS)),
        np.empty(PLANAR_PARAMETERS),
        np.zeros(PLANAR_PARAMETERS),
    )
    n, response = len(values), parameters[RESPONSE]
    rows, residuals, weights, workspace = (
        np.empty((PLANAR_PARAMETERS, n)),
        np.empty(n),
        np.ones(n),
        np.empty(n),
    )
    for i in range(n):
        u, v = at[i, 0], at[i, 1]
        signal = apply_response(picture[i], response)
        rows[0, i], rows[1, i], rows[2, i] = 1.0, u, v
        rows[3, i], rows[4, i], rows[5, i] = signal, signal * u, signal * v
    for iteration in range(3):
        a[:, :] = 0.0
        add_products(rows, weights, n, workspace, a)
        for m in range(PLANAR_PARAMETERS):
            total = 0.0
            for i in range(n):
                total += weights[i] * rows[m, i] * values[i]
            g[m] = total
        # Weak prior: slopes of the illumination are small.
        for m in (1, 2, 4, 5):
            a[m, m] += 0.02 * a[0, 0]
        if not solve_positive(a, g, out):
            return False
        for i in range(n):
            residuals[i] = values[i]
        for m in range(PLANAR_PARAMETERS):
            for i in range(n):
                residuals[i] -= out[m] * rows[m, i]
        if iteration == 0:
            for i in range(n):
                workspace[i] = abs(residuals[i])
            scale = max(1.4826 * median(workspace, n), scale)
        for i in range(n):
            weights[i] = 1.0 / (1.0 + (residuals[i] / (cutoff * scale)) ** 2) ** 2
    copy_vector(out, parameters[ILLUMINATION:])
    return True
