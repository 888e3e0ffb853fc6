"""The compiled loops of the normal equations; their types are those of their calls."""

import numpy as np

from tracker.appearance.light.fields.kernels import (
    AROUND,
    MAX_SHARES,
    PLAIN,
    by_cells,
    hold_light,
    shared_numbers,
    shares_of,
    typical_contrast,
)
from tracker.appearance.light.kernels import BLUR, LIGHT, PLANE, RESPONSE, by_response, shaped_by, slope_of
from tracker.appearance.picture.kernels import MANY, paper_seen
from tracker.compiled import compiled
from tracker.geometry.kernels import add_products, products_of_four

EVEN = LIGHT + PLANE
# A camera's response is bent by so much; gamma 2.2 is half.
RESPONSE_SD = 0.3
MIN_SCALE_GREY = 0.3
# What lies beyond the paper is unknown: a whole contrast brighter or darker.
BEYOND_CONTRAST = 1.0
# Numbers that a pixel in uneven light sees, at most, and about half of them.
WIDEST, HALF = LIGHT + MAX_SHARES, 12


@compiled
def trust(at, lens, rotation, translation, side_mm, numbers, light, scale, own):
    """Into `own` (n,): what the noise is of a pixel's variance, 0..1; the rest is what lies beyond the paper.

    Blur brings the background in; near the paper's edge a pixel says little of the marker.
    """
    blur = numbers[BLUR : BLUR + 3]
    unknown = BEYOND_CONTRAST * typical_contrast(numbers, light) / scale
    paper_seen(at, lens, rotation, translation, side_mm, blur, own)
    for i in range(len(own)):
        own[i] = 1.0 / (1.0 + (unknown * (1.0 - own[i])) ** 2)


@compiled
def weighed_pixel(rows, i, value, lit, response, own, unit, row):
    """One pixel's derivatives into `row` (10,); returns the picture, residual, weight and robust cost."""
    s, contrast = rows[0, i], lit[i, 1]
    shaped = shaped_by(s, response)
    r = value - lit[i, 0] - contrast * shaped
    z = r * r * own[i] * unit
    # Geman and McClure: what is far off belongs to something else and has no say.
    w = 1.0 / (1.0 + z)
    cost = z * w
    slope = contrast * slope_of(s, response)
    for k in range(9):
        row[k] = slope * rows[1 + k, i]
    row[RESPONSE] = contrast * by_response(s, response)
    return shaped, r, w * w * own[i], cost


@compiled
def _weighed_pixels(rows, at, values, lit, response, own, unit, begin, count, slopes, left, weights):
    """The same of many pixels in even light: derivatives (16, many), residuals and weights; their cost."""
    end, cost = begin + count, 0.0
    picture = rows[0, begin:end]
    bent, shaped_row, shaped_u, shaped_v = slopes[RESPONSE], slopes[13], slopes[14], slopes[15]
    ones, us, vs = slopes[10], slopes[11], slopes[12]
    steep = np.empty(count)
    for k in range(count):
        i = begin + k
        s, contrast = picture[k], lit[i, 1]
        shaped = shaped_by(s, response)
        r = values[i] - lit[i, 0] - contrast * shaped
        z = r * r * own[i] * unit
        w = 1.0 / (1.0 + z)
        cost += z * w
        left[k], weights[k] = r, w * w * own[i]
        steep[k] = contrast * slope_of(s, response)
        bent[k] = contrast * by_response(s, response)
        u, v = at[i, 0], at[i, 1]
        ones[k], us[k], vs[k] = 1.0, u, v
        shaped_row[k], shaped_u[k], shaped_v[k] = shaped, shaped * u, shaped * v
    for m in range(9):
        out, slope = slopes[m], rows[1 + m, begin:end]
        for k in range(count):
            out[k] = steep[k] * slope[k]
    return cost


@compiled
def _even_equations(rows, at, values, lit, numbers, own, unit, a, g):
    """Gauss-Newton's matrix (16, 16) and right side (16,) in even light; returns robust cost and weight."""
    slopes, left, weights, room = np.empty((EVEN, MANY)), np.empty(MANY), np.empty(MANY), np.empty(MANY)
    cost, total = 0.0, 0.0
    for begin in range(0, len(values), MANY):
        count = min(MANY, len(values) - begin)
        cost += _weighed_pixels(
            rows, at, values, lit, numbers[RESPONSE], own, unit, begin, count, slopes, left, weights
        )
        add_products(slopes, weights, count, room, a)
        for k in range(count):
            total += weights[k]
            left[k] *= weights[k]
        for m in range(0, EVEN, 4):
            four = products_of_four(left, (slopes[m], slopes[m + 1], slopes[m + 2], slopes[m + 3]), count)
            for k in range(4):
                g[m + k] += four[k]
    return cost / unit, total


@compiled
def _uneven_equations(rows, at, values, lit, numbers, light, own, unit, a, g):
    """The same in uneven light: the pixels of one cell of its net see the same few numbers."""
    nodes, response, n = light[1], numbers[RESPONSE], len(values)
    order, begins = np.empty(n, np.int64), np.empty((nodes - 2) ** 2 + 1, np.int64)
    by_cells(at, nodes, order, begins)
    there, room = np.arange(WIDEST), np.empty(AROUND)
    four, weights = np.zeros((4, WIDEST)), np.zeros(4)
    products, sides = np.empty((WIDEST, WIDEST)), np.empty(WIDEST)
    cost, total = 0.0, 0.0
    for cell in range(len(begins) - 1):
        begin, end = begins[cell], begins[cell + 1]
        if begin == end:
            continue
        products[:, :], sides[:] = 0.0, 0.0
        first, many = order[begin], 0
        count = LIGHT + shared_numbers(at[first, 0], at[first, 1], light, there[LIGHT:])
        for k in range(begin, end):
            i, row = order[k], four[many]
            shaped, r, weights[many], one = weighed_pixel(rows, i, values[i], lit, response, own, unit, row)
            shares_of(at[i, 0], at[i, 1], shaped, lit[i, 1], numbers, light, room, row[LIGHT:])
            cost += one
            total += weights[many]
            r *= weights[many]
            for m in range(WIDEST):
                sides[m] += r * row[m]
            many += 1
            if many == 4:
                _add_four(four, weights, count, products)
                many = 0
        if many > 0:
            weights[many:] = 0.0
            _add_four(four, weights, count, products)
        _put(products, sides, there[:count], a, g)
    return cost / unit, total


@compiled
def _add_four(four, weights, count, products):
    """Add the weighted products of the first numbers of four pixels' rows (4, WIDEST) with one another.

    The lower half alone is right.
    """
    r0, r1, r2, r3 = four[0], four[1], four[2], four[3]
    for m in range(count):
        w0, w1, w2, w3 = weights[0] * r0[m], weights[1] * r1[m], weights[2] * r2[m], weights[3] * r3[m]
        line = products[m]
        # As many each time, so that the machine takes all of a row in few steps.
        for k in range(HALF):
            line[k] += w0 * r0[k] + w1 * r1[k] + w2 * r2[k] + w3 * r3[k]
        if m >= HALF:
            for k in range(HALF, WIDEST):
                line[k] += w0 * r0[k] + w1 * r1[k] + w2 * r2[k] + w3 * r3[k]


@compiled
def _put(products, sides, there, a, g):
    """Add the products and sides of some numbers to the normal equations, where `there` has them."""
    for m in range(len(there)):
        i = there[m]
        g[i] += sides[m]
        a[i, i] += products[m, m]
        for k in range(m):
            j = there[k]
            a[i, j] += products[m, k]
            a[j, i] += products[m, k]


@compiled
def hold(a, g, numbers, scale, light):
    """Add to the normal equations what is known beforehand; returns what it costs."""
    for m in range(3):
        a[BLUR + m, BLUR + m] += (scale / (1.0 + numbers[BLUR] + numbers[BLUR + 1])) ** 2
    straight = (scale / RESPONSE_SD) ** 2
    a[RESPONSE, RESPONSE] += straight
    g[RESPONSE] -= straight * numbers[RESPONSE]
    return straight * numbers[RESPONSE] ** 2 + hold_light(a, g, numbers, scale, light)


@compiled
def equations(rows, at, values, lit, numbers, light, own, scale, cut, a, g):
    """The normal equations with what is known beforehand in them; returns their cost and weight."""
    a[:, :] = 0.0
    g[:] = 0.0
    unit = 1.0 / (cut * scale) ** 2
    if light[0] == PLAIN:
        cost, total = _even_equations(rows, at, values, lit, numbers, own, unit, a, g)
    else:
        cost, total = _uneven_equations(rows, at, values, lit, numbers, light, own, unit, a, g)
    return cost + hold(a, g, numbers, scale, light), total


@compiled
def typical_sd(rows, values, lit, response, own):
    """The sd of normally distributed residuals of these sizes, from at most 600 of them."""
    every = len(values) // 600 + 1
    sizes = np.empty((len(values) + every - 1) // every)
    for k in range(len(sizes)):
        i = k * every
        r = values[i] - lit[i, 0] - lit[i, 1] * shaped_by(rows[0, i], response)
        sizes[k] = abs(r) * np.sqrt(own[i])
    return max(1.4826 * np.median(sizes), MIN_SCALE_GREY)
