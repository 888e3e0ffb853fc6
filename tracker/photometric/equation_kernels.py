"""Normal equations of the photometric fit: robust weights, Gauss-Newton matrix and priors.

With them, the lack-of-fit test of residuals under planar illumination for smooth illumination.
"""

import numpy as np

from tracker.compiled import compiled
from tracker.geometry.geometry_kernels import add_products, median, products_of_four, solve_positive
from tracker.photometric.illumination_kernels import (
    MAX_SPLINE_PARAMETERS,
    PLANAR,
    SPLINE_SUPPORT,
    add_illumination_priors,
    sort_by_cell,
    spline_derivatives,
    spline_indices,
    typical_contrast,
)
from tracker.photometric.render_kernels import BATCH, paper_fraction
from tracker.photometric.response_kernels import (
    BLUR,
    ILLUMINATION,
    PLANAR_PARAMETERS,
    RESPONSE,
    apply_response,
    response_derivative,
    response_slope,
)

PLANAR_COUNT = ILLUMINATION + PLANAR_PARAMETERS
# Prior sd of the response parameter, which is about 0.5 for a gamma of 2.2.
RESPONSE_SD = 0.3
MIN_SCALE_GREY = 0.3
# The background beyond the paper is unknown: its sd is one marker contrast.
BEYOND_CONTRAST = 1.0
# Maximum number of parameters that affect one pixel under spline illumination, and about half of it.
MAX_ROW_PARAMETERS, HALF_ROW = ILLUMINATION + MAX_SPLINE_PARAMETERS, 12
# Number of planar terms, and of all terms up to cubic, of dark level and contrast together.
EVEN_ROWS, ROWS = 6, 20
# Maximum number of pixels of the test.
MAX_TEST_PIXELS = 800


@compiled
def pixel_reliability(at, lens, rotation, translation, side_mm, parameters, illumination, scale, reliability):
    """Compute the share of each pixel's variance that is image noise, 0..1, into `reliability` (n,).

    The rest of the variance comes from the unknown background beyond the paper, which blur mixes in. Pixels
    near the edge of the paper therefore get a low weight.
    """
    blur = parameters[BLUR : BLUR + 3]
    unknown = BEYOND_CONTRAST * typical_contrast(parameters, illumination) / scale
    paper_fraction(at, lens, rotation, translation, side_mm, blur, reliability)
    for i in range(len(reliability)):
        reliability[i] = 1.0 / (1.0 + (unknown * (1.0 - reliability[i])) ** 2)


@compiled
def weighted_row(rows, i, value, dark_contrast, response, reliability, unit, row):
    """Write the derivatives of one pixel into `row` (10,).

    Returns the signal after the camera response, the residual, the robust weight and the robust cost.
    """
    s, contrast = rows[0, i], dark_contrast[i, 1]
    signal = apply_response(s, response)
    r = value - dark_contrast[i, 0] - contrast * signal
    z = r * r * reliability[i] * unit
    # Geman-McClure weight: outliers belong to other objects and get no weight.
    w = 1.0 / (1.0 + z)
    cost = z * w
    slope = contrast * response_slope(s, response)
    for k in range(9):
        row[k] = slope * rows[1 + k, i]
    row[RESPONSE] = contrast * response_derivative(s, response)
    return signal, r, w * w * reliability[i], cost


@compiled
def weighted_rows(
    rows, at, values, dark_contrast, response, reliability, unit, begin, count, slopes, residuals, weights
):
    """Compute derivatives (16, many), residuals and weights under planar illumination; return the cost."""
    end, cost = begin + count, 0.0
    picture = rows[0, begin:end]
    response_row, signal_row, signal_u, signal_v = slopes[RESPONSE], slopes[13], slopes[14], slopes[15]
    ones, us, vs = slopes[10], slopes[11], slopes[12]
    signal_slope = np.empty(count)
    for k in range(count):
        i = begin + k
        s, contrast = picture[k], dark_contrast[i, 1]
        signal = apply_response(s, response)
        r = values[i] - dark_contrast[i, 0] - contrast * signal
        z = r * r * reliability[i] * unit
        w = 1.0 / (1.0 + z)
        cost += z * w
        residuals[k], weights[k] = r, w * w * reliability[i]
        signal_slope[k] = contrast * response_slope(s, response)
        response_row[k] = contrast * response_derivative(s, response)
        u, v = at[i, 0], at[i, 1]
        ones[k], us[k], vs[k] = 1.0, u, v
        signal_row[k], signal_u[k], signal_v[k] = signal, signal * u, signal * v
    for m in range(9):
        out, slope = slopes[m], rows[1 + m, begin:end]
        for k in range(count):
            out[k] = signal_slope[k] * slope[k]
    return cost


@compiled
def _planar_equations(rows, at, values, dark_contrast, parameters, reliability, unit, a, g):
    """Fill Gauss-Newton matrix (16, 16) and right side (16,), planar illumination; return cost and weight."""
    slopes, residuals, weights, workspace = (
        np.empty((PLANAR_COUNT, BATCH)),
        np.empty(BATCH),
        np.empty(BATCH),
        np.empty(BATCH),
    )
    cost, total = 0.0, 0.0
    for begin in range(0, len(values), BATCH):
        count = min(BATCH, len(values) - begin)
        cost += weighted_rows(
            rows,
            at,
            values,
            dark_contrast,
            parameters[RESPONSE],
            reliability,
            unit,
            begin,
            count,
            slopes,
            residuals,
            weights,
        )
        add_products(slopes, weights, count, workspace, a)
        for k in range(count):
            total += weights[k]
            residuals[k] *= weights[k]
        for m in range(0, PLANAR_COUNT, 4):
            four = products_of_four(
                residuals, (slopes[m], slopes[m + 1], slopes[m + 2], slopes[m + 3]), count
            )
            for k in range(4):
                g[m + k] += four[k]
    return cost / unit, total


@compiled
def _spline_equations(rows, at, values, dark_contrast, parameters, illumination, reliability, unit, a, g):
    """Fill the normal equations under spline illumination; return robust cost and weight.

    All pixels of one grid cell share the same spline coefficients, so they are accumulated cell by cell.
    """
    nodes, response, n = illumination[1], parameters[RESPONSE], len(values)
    order, begins = np.empty(n, np.int64), np.empty((nodes - 2) ** 2 + 1, np.int64)
    sort_by_cell(at, nodes, order, begins)
    there, workspace = np.arange(MAX_ROW_PARAMETERS), np.empty(SPLINE_SUPPORT)
    four, weights = np.zeros((4, MAX_ROW_PARAMETERS)), np.zeros(4)
    products, sides = np.empty((MAX_ROW_PARAMETERS, MAX_ROW_PARAMETERS)), np.empty(MAX_ROW_PARAMETERS)
    cost, total = 0.0, 0.0
    for cell in range(len(begins) - 1):
        begin, end = begins[cell], begins[cell + 1]
        if begin == end:
            continue
        products[:, :], sides[:] = 0.0, 0.0
        first, many = order[begin], 0
        count = ILLUMINATION + spline_indices(at[first, 0], at[first, 1], illumination, there[ILLUMINATION:])
        for k in range(begin, end):
            i, row = order[k], four[many]
            signal, r, weights[many], one = weighted_row(
                rows, i, values[i], dark_contrast, response, reliability, unit, row
            )
            spline_derivatives(
                at[i, 0],
                at[i, 1],
                signal,
                dark_contrast[i, 1],
                parameters,
                illumination,
                workspace,
                row[ILLUMINATION:],
            )
            cost += one
            total += weights[many]
            r *= weights[many]
            for m in range(MAX_ROW_PARAMETERS):
                sides[m] += r * row[m]
            many += 1
            if many == 4:
                _add_outer_products(four, weights, count, products)
                many = 0
        if many > 0:
            for k in range(many, 4):
                weights[k] = 0.0
            _add_outer_products(four, weights, count, products)
        _scatter(products, sides, there[:count], a, g)
    return cost / unit, total


@compiled
def _add_outer_products(four, weights, count, products):
    """Add the weighted outer products of four rows (4, MAX_ROW_PARAMETERS) to `products`.

    Only the lower triangle is valid.
    """
    r0, r1, r2, r3 = four[0], four[1], four[2], four[3]
    for m in range(count):
        w0, w1, w2, w3 = weights[0] * r0[m], weights[1] * r1[m], weights[2] * r2[m], weights[3] * r3[m]
        line = products[m]
        # Fixed loop counts, so that the compiler vectorises them.
        for k in range(HALF_ROW):
            line[k] += w0 * r0[k] + w1 * r1[k] + w2 * r2[k] + w3 * r3[k]
        if m >= HALF_ROW:
            for k in range(HALF_ROW, MAX_ROW_PARAMETERS):
                line[k] += w0 * r0[k] + w1 * r1[k] + w2 * r2[k] + w3 * r3[k]


@compiled
def _scatter(products, sides, there, a, g):
    """Add a cell's products and right sides to the normal equations at the indices `there`."""
    for m in range(len(there)):
        i = there[m]
        g[i] += sides[m]
        a[i, i] += products[m, m]
        for k in range(m):
            j = there[k]
            a[i, j] += products[m, k]
            a[j, i] += products[m, k]


@compiled
def add_priors(a, g, parameters, scale, illumination):
    """Add the Gaussian priors of blur, response and illumination; return their cost."""
    for m in range(3):
        a[BLUR + m, BLUR + m] += (scale / (1.0 + parameters[BLUR] + parameters[BLUR + 1])) ** 2
    straight = (scale / RESPONSE_SD) ** 2
    a[RESPONSE, RESPONSE] += straight
    g[RESPONSE] -= straight * parameters[RESPONSE]
    return straight * parameters[RESPONSE] ** 2 + add_illumination_priors(
        a, g, parameters, scale, illumination
    )


@compiled
def normal_equations(
    rows, at, values, dark_contrast, parameters, illumination, reliability, scale, cutoff, a, g
):
    """Fill the normal equations including the priors; return their cost and the total weight."""
    a[:, :] = 0.0
    g[:] = 0.0
    unit = 1.0 / (cutoff * scale) ** 2
    if illumination[0] == PLANAR:
        cost, total = _planar_equations(rows, at, values, dark_contrast, parameters, reliability, unit, a, g)
    else:
        cost, total = _spline_equations(
            rows, at, values, dark_contrast, parameters, illumination, reliability, unit, a, g
        )
    return cost + add_priors(a, g, parameters, scale, illumination), total


@compiled
def robust_sd(rows, values, dark_contrast, response, reliability):
    """Return 1.4826 times the median absolute residual, from at most 600 pixels, in grey levels."""
    every = len(values) // 600 + 1
    sizes = np.empty((len(values) + every - 1) // every)
    for k in range(len(sizes)):
        i = k * every
        r = values[i] - dark_contrast[i, 0] - dark_contrast[i, 1] * apply_response(rows[0, i], response)
        sizes[k] = abs(r) * np.sqrt(reliability[i])
    return max(1.4826 * median(sizes, len(sizes)), MIN_SCALE_GREY)


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
