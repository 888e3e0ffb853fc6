"""The compiled loops of the normal equations; their types are those of their calls."""

import numpy as np

from tracker.appearance.light.kernels import (
    AROUND,
    BLUR,
    LIGHT,
    PLANE,
    RESPONSE,
    cell_of,
    hold_light,
    light_up,
    shaped_by,
    typical_contrast,
)
from tracker.appearance.picture.kernels import MANY, paper_seen
from tracker.compiled import compiled
from tracker.geometry.kernels import add_products, products_of_four

EVEN = LIGHT + PLANE
# A camera's response is bent by so much; gamma 2.2 is half.
RESPONSE_SD = 0.3
LEAST_SCALE_GREY = 0.3
# What lies beyond the paper is unknown: a whole contrast brighter or darker.
BEYOND_CONTRAST = 1.0


@compiled
def trust(at, lens, rotation, translation, side_mm, numbers, nodes, scale, own):
    """Into `own` (n,): what the noise is of a pixel's variance, 0..1; the rest is what lies beyond the paper.

    Blur brings the background in; near the paper's edge a pixel says little of the marker.
    """
    blur = numbers[BLUR : BLUR + 3]
    unknown = BEYOND_CONTRAST * typical_contrast(numbers, nodes) / scale
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
    slope = contrast * (1.0 + response * (1.0 - 2.0 * s))
    for k in range(9):
        row[k] = slope * rows[1 + k, i]
    row[RESPONSE] = contrast * s * (1.0 - s)
    return shaped, r, w * w * own[i], cost


@compiled
def _weighed_pixels(rows, at, values, lit, response, own, unit, begin, count, slopes, left, weights):
    """The same of many pixels in even light: derivatives (16, many), residuals and weights; their cost."""
    end, cost = begin + count, 0.0
    picture = rows[0, begin:end]
    by_response, shaped_row, shaped_u, shaped_v = slopes[RESPONSE], slopes[13], slopes[14], slopes[15]
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
        steep[k] = contrast * (1.0 + response * (1.0 - 2.0 * s))
        by_response[k] = contrast * s * (1.0 - s)
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
def _uneven_equations(rows, at, values, lit, numbers, nodes, own, unit, a, g):
    """The same in uneven light, of which each pixel sees nine nodes."""
    row, index, weight = np.empty(LIGHT), np.empty(AROUND, np.int64), np.empty(AROUND)
    where, share = np.empty(2 * AROUND, np.int64), np.empty(2 * AROUND)
    cost, total, both = 0.0, 0.0, nodes * nodes
    for i in range(len(values)):
        shaped, r, w, one = weighed_pixel(rows, i, values[i], lit, numbers[RESPONSE], own, unit, row)
        cost += one
        total += w
        cell_of(at[i, 0], at[i, 1], nodes, index, weight)
        for k in range(AROUND):
            where[k], share[k] = LIGHT + index[k], weight[k]
            where[AROUND + k], share[AROUND + k] = LIGHT + both + index[k], weight[k] * shaped
        wr = w * r
        for m in range(LIGHT):
            wm = w * row[m]
            g[m] += wr * row[m]
            for k in range(LIGHT):
                a[m, k] += wm * row[k]
            for k in range(2 * AROUND):
                a[m, where[k]] += wm * share[k]
        for m in range(2 * AROUND):
            g[where[m]] += wr * share[m]
            for k in range(2 * AROUND):
                a[where[m], where[k]] += w * share[m] * share[k]
    for m in range(LIGHT):
        for k in range(LIGHT, len(g)):
            a[k, m] = a[m, k]
    return cost / unit, total


@compiled
def _hold(a, g, numbers, scale, nodes):
    """Add to the normal equations what is known beforehand; returns what it costs."""
    for m in range(3):
        a[BLUR + m, BLUR + m] += (scale / (1.0 + numbers[BLUR] + numbers[BLUR + 1])) ** 2
    straight = (scale / RESPONSE_SD) ** 2
    a[RESPONSE, RESPONSE] += straight
    g[RESPONSE] -= straight * numbers[RESPONSE]
    return straight * numbers[RESPONSE] ** 2 + hold_light(a, g, numbers, scale, nodes)


@compiled
def equations(rows, at, values, lit, numbers, nodes, own, scale, cut, a, g):
    """The normal equations with what is known beforehand in them; returns their cost and weight."""
    a[:, :] = 0.0
    g[:] = 0.0
    light_up(at, numbers, nodes, lit)
    unit = 1.0 / (cut * scale) ** 2
    if nodes == 0:
        cost, total = _even_equations(rows, at, values, lit, numbers, own, unit, a, g)
    else:
        cost, total = _uneven_equations(rows, at, values, lit, numbers, nodes, own, unit, a, g)
    return cost + _hold(a, g, numbers, scale, nodes), total


@compiled
def typical_sd(rows, values, lit, response, own):
    """The sd of normally distributed residuals of these sizes, from at most 600 of them."""
    every = len(values) // 600 + 1
    sizes = np.empty((len(values) + every - 1) // every)
    for k in range(len(sizes)):
        i = k * every
        r = values[i] - lit[i, 0] - lit[i, 1] * shaped_by(rows[0, i], response)
        sizes[k] = abs(r) * np.sqrt(own[i])
    return max(1.4826 * np.median(sizes), LEAST_SCALE_GREY)
