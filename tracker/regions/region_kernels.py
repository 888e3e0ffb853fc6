"""Run-length labelling of dark regions, quads fitted to them, and border following (crack following)."""

import numpy as np

from tracker.compiled import compiled
from tracker.geometry.geometry_kernels import is_plausible_foreshortening

# Part of a side that is straight despite the blur at the corners.
STRAIGHT_FROM, STRAIGHT_TO = 0.14, 0.86
# Maximum distance of a region's outline from its four sides, in addition to one pixel.
MAX_OFF_SIDE_RATIO = 0.14
# Maximum ratio of the area of the convex hull to that of the largest inscribed quadrilateral: 1 for a
# parallelogram, 1.57 for an ellipse.
MAX_ROUND = 1.4
MIN_FILLED = 0.62


@compiled
def median_difference(image, rows_apart, columns_apart):
    """Return the median difference of pixels to their right neighbours on a grid, in grey; 0 for none."""
    height, width = image.shape
    counts = np.zeros(256, np.int64)
    for v in range(0, height, rows_apart):
        line = image[v]
        for u in range(0, width - 1, columns_apart):
            counts[abs(np.int64(line[u]) - np.int64(line[u + 1]))] += 1
    half = 0.0
    for count in counts:
        half += 0.5 * count
    if half == 0.0:
        return 0.0
    # The median of integers, interpolated within its level.
    level, below = 0, 0
    while below + counts[level] < half:
        below += counts[level]
        level += 1
    return max(level - 0.5 + (half - below) / counts[level], 0.0)


@compiled
def _find_root(parent, i):
    while parent[i] != i:
        parent[i] = parent[parent[i]]
        i = parent[i]
    return i


@compiled
def find_runs(mask):
    """Find the runs of a mask: row, first and last column (n,), and the first run of each run's region."""
    height, width = mask.shape
    maximum = height * (width // 2 + 1)
    row, first, last = np.empty(maximum, np.int32), np.empty(maximum, np.int32), np.empty(maximum, np.int32)
    parent = np.empty(maximum, np.int32)
    n, above, above_end = 0, 0, 0
    changes = np.empty(width + 2, np.int32)
    for v in range(height):
        begin, line = n, mask[v]
        k = above
        # Branchless: each column is written but the counter advances only at changes, because a branch would
        # be mispredicted too often.
        count, before = 0, np.uint8(0)
        for u in range(width):
            changes[count] = u
            count += line[u] != before
            before = line[u]
        changes[count] = width
        for c in range(0, count, 2):
            start, u = changes[c], changes[c + 1]
            row[n], first[n], last[n], parent[n] = v, start, u - 1, n
            # 8-connectivity: a run above is connected if it touches diagonally.
            while k < above_end and last[k] < start - 1:
                k += 1
            j = k
            while j < above_end and first[j] <= u:
                a, b = _find_root(parent, j), _find_root(parent, n)
                if a < b:
                    parent[b] = a
                elif b < a:
                    parent[a] = b
                j += 1
            n += 1
        above, above_end = begin, n
    for i in range(n):
        parent[i] = parent[parent[i]]
    return row[:n], first[:n], last[:n], parent[:n]


@compiled
def regions_of(row, first, last, parent, size_wh, minimum, maximum):
    """Return the boxes (r, 4: left, top, right, bottom) of regions of plausible size inside the image.

    Also the linked runs of each: `head` (r,) is the first and `after` (n,) the next one, -1 at the end.
    """
    n = row.size
    box = np.empty((n, 4), np.int32)
    after, tail = np.full(n, -1, np.int32), np.empty(n, np.int32)
    for i in range(n):
        k = parent[i]
        if k == i:
            box[k, 0], box[k, 1], box[k, 2], box[k, 3] = first[i], row[i], last[i], row[i]
        else:
            box[k, 0], box[k, 2] = min(box[k, 0], first[i]), max(box[k, 2], last[i])
            box[k, 3] = row[i]
            after[tail[k]] = i
        tail[k] = i
    head = np.empty(n, np.int32)
    r = 0
    for i in range(n):
        if parent[i] != i:
            continue
        wide, high = box[i, 2] - box[i, 0] + 1, box[i, 3] - box[i, 1] + 1
        if max(wide, high) < minimum or min(wide, high) < 0.4 * minimum or max(wide, high) > maximum:
            continue
        if box[i, 0] < 1 or box[i, 1] < 1 or box[i, 2] > size_wh[0] - 2 or box[i, 3] > size_wh[1] - 2:
            continue
        head[r] = i
        box[r] = box[i]
        r += 1
    return box[:r].copy(), head[:r].copy(), after


@compiled
def _outline(first, last, row, after, i, box, extremes):
    """Write a region's left and right border per row into `extremes`; return the filled area."""
    top = box[1]
    for y in range(box[3] - top + 1):
        extremes[0, y], extremes[1, y] = 1 << 30, -1
    while i >= 0:
        y = row[i] - top
        extremes[0, y], extremes[1, y] = min(extremes[0, y], first[i]), max(extremes[1, y], last[i])
        i = after[i]
    filled = 0
    for y in range(box[3] - top + 1):
        filled += extremes[1, y] - extremes[0, y] + 1
    return filled


@compiled
def _columns(first, last, row, after, i, box, extremes):
    """Write a region's top and bottom border per column into `extremes`."""
    left = box[0]
    for x in range(box[2] - left + 1):
        extremes[2, x], extremes[3, x] = 1 << 30, -1
    while i >= 0:
        for x in range(first[i] - left, last[i] - left + 1):
            extremes[2, x] = min(extremes[2, x], row[i])
            extremes[3, x] = row[i]
        i = after[i]


@compiled
def _hull(extremes, top, rows, hull):
    """Compute the convex hull of a region, clockwise on the screen; return the number of its corners."""
    n = 0
    for y in range(rows):  # down the right side
        x = extremes[1, y] + 0.5
        while (
            n > 1
            and (hull[n - 1, 0] - hull[n - 2, 0]) * (y + top - hull[n - 2, 1])
            - (hull[n - 1, 1] - hull[n - 2, 1]) * (x - hull[n - 2, 0])
            <= 0.0
        ):
            n -= 1
        hull[n, 0], hull[n, 1] = x, y + top
        n += 1
    base = n
    for y in range(rows - 1, -1, -1):  # up the left side
        x = extremes[0, y] - 0.5
        while (
            n > base + 1
            and (hull[n - 1, 0] - hull[n - 2, 0]) * (y + top - hull[n - 2, 1])
            - (hull[n - 1, 1] - hull[n - 2, 1]) * (x - hull[n - 2, 0])
            <= 0.0
        ):
            n -= 1
        hull[n, 0], hull[n, 1] = x, y + top
        n += 1
    return n


@compiled
def _farthest(hull, n, nx, ny):
    best, far = 0, -1e30
    for i in range(n):
        d = hull[i, 0] * nx + hull[i, 1] * ny
        if d > far:
            far, best = d, i
    return best


@compiled
def _largest_quad(hull, n, quad):
    """Approximate the largest quad of hull corners: for each diagonal the farthest corners."""
    cx, cy = 0.0, 0.0
    for i in range(n):
        cx += hull[i, 0] / n
        cy += hull[i, 1] / n
    a, far = 0, -1.0
    for i in range(n):
        d = (hull[i, 0] - cx) ** 2 + (hull[i, 1] - cy) ** 2
        if d > far:
            far, a = d, i
    c, far = 0, -1.0
    for i in range(n):
        d = (hull[i, 0] - hull[a, 0]) ** 2 + (hull[i, 1] - hull[a, 1]) ** 2
        if d > far:
            far, c = d, i
    b = d = 0
    for _ in range(4):
        nx, ny = -(hull[c, 1] - hull[a, 1]), hull[c, 0] - hull[a, 0]
        b, d = _farthest(hull, n, -nx, -ny), _farthest(hull, n, nx, ny)
        mx, my = -(hull[d, 1] - hull[b, 1]), hull[d, 0] - hull[b, 0]
        na, nc = _farthest(hull, n, mx, my), _farthest(hull, n, -mx, -my)
        if na == a and nc == c:
            break
        a, c = na, nc
    for k, corner in enumerate((a, b, c, d)):
        quad[k, 0], quad[k, 1] = hull[corner, 0], hull[corner, 1]


@compiled
def _area(points, n):
    total = 0.0
    for i in range(n):
        j = (i + 1) % n
        total += points[i, 0] * points[j, 1] - points[j, 0] * points[i, 1]
    return 0.5 * total


@compiled
def _fit_side(extremes, box, p, q, line):
    """Fit a line (point, direction) to the border between two corners; return the number of points used.

    Returns 0 where there are too few.
    """
    dx, dy = q[0] - p[0], q[1] - p[1]
    flat = abs(dx) > abs(dy)
    along, across = (0, 1) if flat else (1, 0)
    which = (2 if dx > 0 else 3) if flat else (1 if dy > 0 else 0)
    # Half a pixel beyond the outermost dark pixel.
    beyond = 0.5 if which in (1, 3) else -0.5
    length = dx if flat else dy
    slope = (dy / dx) if flat else (dx / dy)
    lo, hi = p[along] + STRAIGHT_FROM * length, p[along] + STRAIGHT_TO * length
    if lo > hi:
        lo, hi = hi, lo
    start, end = max(int(np.ceil(lo)), box[along]), min(int(hi), box[along + 2])
    limit = 1.2 + MAX_OFF_SIDE_RATIO * np.sqrt(dx * dx + dy * dy)
    offset = p[across] - slope * p[along]
    used = 0
    for _ in range(3):
        n, sx, sy, sxx, sxy, srr = 0, 0.0, 0.0, 0.0, 0.0, 0.0
        for k in range(start, end + 1):
            y = extremes[which, k - box[along]] + beyond
            r = y - offset - slope * k
            if abs(r) > limit:
                continue
            t = k - start
            n += 1
            sx += t
            sy += y
            sxx += t * t
            sxy += t * y
            srr += r * r
        det = n * sxx - sx * sx
        if n < 3 or det <= 0.0:
            return 0
        slope = (n * sxy - sx * sy) / det
        offset = (sy - slope * sx) / n - slope * start
        limit = min(limit, max(0.8, 1.8 * np.sqrt(srr / n)))
        used = n
    if used < 0.5 * (end - start + 1):
        return 0
    line[along], line[across] = 0.0, offset
    line[2 + along], line[2 + across] = 1.0, slope
    return used


@compiled
def _intersection(a, b, out):
    """Intersect two lines (point, direction); False where they are nearly parallel."""
    cross = a[2] * b[3] - a[3] * b[2]
    if abs(cross) < 1e-3:
        return False
    t = ((b[0] - a[0]) * b[3] - (b[1] - a[1]) * b[2]) / cross
    out[0], out[1] = a[0] + t * a[2], a[1] + t * a[3]
    return True


@compiled
def could_be_square(quad, min_side, min_squash):
    """Return whether four corners, clockwise on the screen, can be a tilted square."""
    for k in range(4):
        p, q, r = quad[k], quad[(k + 1) % 4], quad[(k + 2) % 4]
        if (q[0] - p[0]) * (r[1] - q[1]) - (q[1] - p[1]) * (r[0] - q[0]) <= 0.0:
            return False
        o = quad[(k + 3) % 4]
        side = np.sqrt((q[0] - p[0]) ** 2 + (q[1] - p[1]) ** 2)
        opposite = np.sqrt((r[0] - o[0]) ** 2 + (r[1] - o[1]) ** 2)
        if side < min_side or side > 2.0 * opposite:
            return False
    ax, ay = (
        quad[1, 0] + quad[2, 0] - quad[0, 0] - quad[3, 0],
        quad[1, 1] + quad[2, 1] - quad[0, 1] - quad[3, 1],
    )
    bx, by = (
        quad[2, 0] + quad[3, 0] - quad[0, 0] - quad[1, 0],
        quad[2, 1] + quad[3, 1] - quad[0, 1] - quad[1, 1],
    )
    return is_plausible_foreshortening(
        ax * ax + ay * ay + bx * bx + by * by, (ax * by - ay * bx) ** 2, min_squash
    )


@compiled
def region_quads(row, first, last, after, box, head, min_side, min_squash):
    """Return corners (q, 4, 2), clockwise on the screen, of regions with four straight sides."""
    count = len(head)
    maximum = 0
    for i in range(count):
        maximum = max(maximum, box[i, 2] - box[i, 0] + 1, box[i, 3] - box[i, 1] + 1)
    extremes = np.empty((4, maximum + 1), np.int32)
    hull = np.empty((2 * maximum + 2, 2), np.float64)
    rough, lines = np.empty((4, 2), np.float64), np.empty((4, 4), np.float64)
    quads = np.empty((count, 4, 2), np.float64)
    n = 0
    for i in range(count):
        filled = _outline(first, last, row, after, head[i], box[i], extremes)
        size = _hull(extremes, box[i, 1], box[i, 3] - box[i, 1] + 1, hull)
        _largest_quad(hull, size, rough)
        area, whole = _area(rough, 4), _area(hull, size)
        if area <= 0.0 or whole > MAX_ROUND * area or filled < MIN_FILLED * whole:
            continue
        _columns(first, last, row, after, head[i], box[i], extremes)
        ok = True
        for k in range(4):
            ok = ok and _fit_side(extremes, box[i], rough[k], rough[(k + 1) % 4], lines[k]) > 0
        for k in range(4):
            ok = ok and _intersection(lines[(k + 3) % 4], lines[k], quads[n, k])
        if ok and could_be_square(quads[n], min_side, min_squash):
            n += 1
    return quads[:n].copy()


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
