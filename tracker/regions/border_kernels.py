"""Border following of dark regions between pixels (crack following)."""

import numpy as np

from tracker.compiled import compiled


@compiled
def _follow(mask, walked, u0, v0, u, v):
    """Follow one border up along the pixel over (u0, v0); write its corners u, v (n,)."""
    height, width = mask.shape
    at_u, at_v, du, dv = u0, v0, 0, -1
    n = 0
    while True:
        if dv < 0:
            walked[at_v - 1, at_u] = True
        u[n], v[n] = at_u, at_v
        n += 1
        at_u, at_v = at_u + du, at_v + dv
        # The pixels ahead to the left and to the right.
        lu, lv = at_u + (du + dv - 1) // 2, at_v + (dv - du - 1) // 2
        ru, rv = at_u + (du - dv - 1) // 2, at_v + (dv + du - 1) // 2
        if 0 <= lu < width and 0 <= lv < height and mask[lv, lu] != 0:
            du, dv = dv, -du
        elif not (0 <= ru < width and 0 <= rv < height and mask[rv, ru] != 0):
            du, dv = -dv, du
        if n == len(u) or (at_u == u0 and at_v == v0 and dv < 0):
            return n


@compiled
def trace_borders(mask, row, first, minimum, maximum):
    """Trace the region borders, dark on the right: x, y (n,) along them, and the start of each.

    A border runs between pixels; each point smooths two of its steps. Borders of fewer than `minimum` steps,
    or of `maximum` or more, are dropped. Each starts at a point far from others, usually a corner, so that no
    side is split.
    """
    height, width = mask.shape
    walked = np.zeros((height, width), np.bool_)
    u, v = np.empty(maximum, np.int32), np.empty(maximum, np.int32)
    capacity = 2 * height * width + 4
    x, y = np.empty(capacity, np.float32), np.empty(capacity, np.float32)
    starts = np.empty(len(row) + 1, np.int32)
    n, c = 0, 0
    starts[0] = 0
    for i in range(len(row)):
        if walked[row[i], first[i]]:
            continue
        m = _follow(mask, walked, first[i], row[i] + 1, u, v)
        if m < minimum or m == maximum or n + m > capacity:
            continue
        far, begin = -1, 0
        for k in range(m):
            d = (u[k] - u[0]) ** 2 + (v[k] - v[0]) ** 2
            if d > far:
                far, begin = d, k
        # Midpoint of two step midpoints, hence weights 1/4, 1/2, 1/4; -0.5 because pixel centres are
        # integers.
        j, k = begin, begin + 1 if begin + 1 < m else 0
        for _ in range(m):
            after = k + 1 if k + 1 < m else 0
            x[n] = np.float32(0.25) * (u[j] + 2 * u[k] + u[after]) - np.float32(0.5)
            y[n] = np.float32(0.25) * (v[j] + 2 * v[k] + v[after]) - np.float32(0.5)
            j, k = k, after
            n += 1
        c += 1
        starts[c] = n
    return x[:n].copy(), y[:n].copy(), starts[: c + 1].copy()
