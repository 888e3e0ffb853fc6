"""The compiled loops of the light: how bright dark and bright are over the marker."""

import numpy as np

from tracker.compiled import compiled
from tracker.geometry.kernels import add_products, solve_positive

# Numbers of a fit: translation 3, turn 3, blur 3 (variances along u, v and between), response 1, then light.
BLUR, RESPONSE, LIGHT = 6, 9, 10
# Even light: brightness of the dark and contrast, each with its slope to the right and upwards.
PLANE = 6
# Uneven light: both at nodes x nodes points over the square and a quarter of half a side beyond.
NODES_REACH = 1.25
# A point is lit by three nodes each way.
AROUND = 9
# Light changes from node to node by so much of the contrast, unless the image says otherwise.
NODE_STEP_RATIO, SLOPE_RATIO = 0.15, 0.5


@compiled
def shaped_by(s, response):
    """What a camera of this response makes of a picture's value 0..1."""
    return s + response * s * (1.0 - s)


@compiled
def cell_of(x, y, nodes, index, weight):
    """The nine nodes around a point in half sides, into `index` (9,), and their weights (9,).

    A quadratic B-spline: glare is round on the scale of its net, and straight lines between nodes were off
    by several grey levels.
    """
    wx, wy = np.empty(3), np.empty(3)
    cells = nodes - 2
    fx = min(max((x / NODES_REACH + 1.0) * 0.5 * cells, 0.0), cells - 1e-6)
    fy = min(max((y / NODES_REACH + 1.0) * 0.5 * cells, 0.0), cells - 1e-6)
    c, r = int(fx), int(fy)
    fx -= c
    fy -= r
    wx[0], wx[1], wx[2] = 0.5 * (1 - fx) ** 2, 0.5 + fx - fx * fx, 0.5 * fx * fx
    wy[0], wy[1], wy[2] = 0.5 * (1 - fy) ** 2, 0.5 + fy - fy * fy, 0.5 * fy * fy
    for j in range(3):
        for i in range(3):
            index[3 * j + i] = (r + j) * nodes + c + i
            weight[3 * j + i] = wy[j] * wx[i]


@compiled
def light_up(at, numbers, nodes, lit):
    """Into `lit` (n, 2): dark and contrast at each pixel, in grey levels. 0 nodes: even light."""
    if nodes == 0:
        d, dx, dy, c, cx, cy = numbers[LIGHT : LIGHT + PLANE]
        for i in range(len(at)):
            lit[i, 0] = d + dx * at[i, 0] + dy * at[i, 1]
            lit[i, 1] = c + cx * at[i, 0] + cy * at[i, 1]
        return
    index, weight = np.empty(AROUND, np.int64), np.empty(AROUND)
    both = nodes * nodes
    for i in range(len(at)):
        cell_of(at[i, 0], at[i, 1], nodes, index, weight)
        dark, contrast = 0.0, 0.0
        for k in range(AROUND):
            dark += weight[k] * numbers[LIGHT + index[k]]
            contrast += weight[k] * numbers[LIGHT + both + index[k]]
        lit[i, 0], lit[i, 1] = dark, contrast


@compiled
def nodes_of_plane(numbers, nodes, out):
    """The numbers of an even light as those of an uneven one."""
    out[:LIGHT] = numbers[:LIGHT]
    both = nodes * nodes
    for r in range(nodes):
        for c in range(nodes):
            x = NODES_REACH * (2.0 * (c - 0.5) / (nodes - 2) - 1.0)
            y = NODES_REACH * (2.0 * (r - 0.5) / (nodes - 2) - 1.0)
            for half in range(2):
                k = LIGHT + 3 * half
                value = numbers[k] + numbers[k + 1] * x + numbers[k + 2] * y
                out[LIGHT + half * both + r * nodes + c] = value


@compiled
def typical_contrast(numbers, nodes):
    """Contrast in the middle of the marker, in grey levels, at least 1."""
    if nodes == 0:
        return max(abs(numbers[LIGHT + 3]), 1.0)
    both, total = nodes * nodes, 0.0
    for k in range(both):
        total += numbers[LIGHT + both + k]
    return max(abs(total / both), 1.0)


@compiled
def hold_light(a, g, numbers, scale, nodes):
    """Add to the normal equations that light changes little over the marker; returns its cost."""
    contrast = typical_contrast(numbers, nodes)
    cost = 0.0
    if nodes == 0:
        stiff = (scale / (SLOPE_RATIO * contrast)) ** 2
        for m in (1, 2, 4, 5):
            a[LIGHT + m, LIGHT + m] += stiff
            g[LIGHT + m] -= stiff * numbers[LIGHT + m]
            cost += stiff * numbers[LIGHT + m] ** 2
        return cost
    both = nodes * nodes
    for half in range(2):
        stiff = (scale / (NODE_STEP_RATIO * contrast)) ** 2
        for r in range(nodes):
            for c in range(nodes):
                i = LIGHT + half * both + r * nodes + c
                for way in range(2):
                    if (c if way == 0 else r) == nodes - 1:
                        continue
                    j = i + (1 if way == 0 else nodes)
                    apart = numbers[i] - numbers[j]
                    a[i, i] += stiff
                    a[j, j] += stiff
                    a[i, j] -= stiff
                    a[j, i] -= stiff
                    g[i] -= stiff * apart
                    g[j] += stiff * apart
                    cost += stiff * apart * apart
    return cost


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
