"""Homography sampling of a square, and local normalisation."""

import numpy as np

from tracker.compiled import compiled


@compiled
def square_to_quad(quad, h):
    """Compute the homography (8 numbers, h33 = 1) from the unit square to four clockwise corners."""
    x0, y0, x1, y1 = quad[0, 0], quad[0, 1], quad[1, 0], quad[1, 1]
    x2, y2, x3, y3 = quad[2, 0], quad[2, 1], quad[3, 0], quad[3, 1]
    sx, sy = x0 - x1 + x2 - x3, y0 - y1 + y2 - y3
    dx1, dy1, dx2, dy2 = x1 - x2, y1 - y2, x3 - x2, y3 - y2
    det = dx1 * dy2 - dy1 * dx2
    g, k = (sx * dy2 - sy * dx2) / det, (dx1 * sy - dy1 * sx) / det
    h[0], h[1], h[2] = x1 - x0 + g * x1, x3 - x0 + k * x3, x0
    h[3], h[4], h[5] = y1 - y0 + g * y1, y3 - y0 + k * y3, y0
    h[6], h[7] = g, k


@compiled
def through(h, a, b):
    """Map a point (a, b) by a homography (8,)."""
    w = h[6] * a + h[7] * b + 1.0
    return (h[0] * a + h[1] * b + h[2]) / w, (h[3] * a + h[4] * b + h[5]) / w


@compiled
def _row_through(h, first, spacing, b, max_u, max_v, us, vs):
    """Map a row of points (first + k apart, b) by a homography, clipped to the image."""
    for k in range(len(us)):
        a = first + k * spacing
        w = 1.0 / (h[6] * a + h[7] * b + 1.0)
        us[k] = min(max((h[0] * a + h[1] * b + h[2]) * w, 0.0), max_u)
        vs[k] = min(max((h[3] * a + h[4] * b + h[5]) * w, 0.0), max_v)


@compiled
def _between(image, u, v):
    """Interpolate the image bilinearly."""
    iu, iv = int(u), int(v)
    fu, fv = np.float32(u - iu), np.float32(v - iv)
    # Unsigned, because Numba checks signed indices for negative values.
    c, r, one = np.uint64(iu), np.uint64(iv), np.uint64(1)
    a, b = np.float32(image[r, c]), np.float32(image[r, c + one])
    r += one
    d, e = np.float32(image[r, c]), np.float32(image[r, c + one])
    upper, lower = a + fu * (b - a), d + fu * (e - d)
    return upper + fv * (lower - upper)


@compiled
def sample_quads(image, quads, cells, ring):
    """Sample grey values (q, n * n) at n = cells + 2 ring points a side of each quad, `ring` outside."""
    height, width = image.shape
    count, n = len(quads), cells + 2 * ring
    out = np.empty((count, n * n), np.float32)
    h, us, vs = np.empty(8), np.empty(n), np.empty(n)
    for q in range(count):
        square_to_quad(quads[q], h)
        for r in range(n):
            b = (r - ring + 0.5) / cells
            _row_through(h, (0.5 - ring) / cells, 1.0 / cells, b, width - 1.001, height - 1.001, us, vs)
            line = out[q, r * n : r * n + n]
            for c in range(n):
                line[c] = _between(image, us[c], vs[c])
    return out


@compiled
def sample_square(image, corners, samples, out):
    """Write the mean grey value of each cell of a square to `out` (n, n), of samples x samples in it."""
    height, width = image.shape
    fields = len(out)
    n = fields * samples
    out[:, :] = 0.0
    h, us, vs = np.empty(8), np.empty(n), np.empty(n)
    square_to_quad(corners, h)
    for r in range(n):
        _row_through(h, 0.5 / n, 1.0 / n, (r + 0.5) / n, width - 1.001, height - 1.001, us, vs)
        line = out[r // samples]
        for c in range(fields):
            total = 0.0
            for k in range(c * samples, c * samples + samples):
                total += _between(image, us[k], vs[k])
            line[c] += total
    for r in range(fields):
        for c in range(fields):
            out[r, c] /= samples * samples


@compiled
def normalise_locally(seen, rows, half, floor_grey, floor_ratio):
    """Normalise images (q, rows * rows) locally, in place.

    From each cell the mean of the cells within `half` of it is subtracted, and the result divided by their
    sd, so that a shadow edge or glare over one part leaves the rest unchanged. The result has mean 0 and
    length 1.
    """
    total = np.empty((rows + 1, rows + 1), np.float64)
    square = np.empty((rows + 1, rows + 1), np.float64)
    total[0, :], total[:, 0], square[0, :], square[:, 0] = 0.0, 0.0, 0.0, 0.0
    for q in range(len(seen)):
        cells = seen[q]
        for r in range(rows):
            line, line2 = 0.0, 0.0
            for c in range(rows):
                value = cells[r * rows + c]
                line += value
                line2 += value * value
                total[r + 1, c + 1], square[r + 1, c + 1] = total[r, c + 1] + line, square[r, c + 1] + line2
        n = rows * rows
        mean = total[rows, rows] / n
        floor = floor_grey**2 + floor_ratio**2 * max(square[rows, rows] / n - mean * mean, 0.0)
        sum1, sum2 = 0.0, 0.0
        for r in range(rows):
            a, b = max(r - half, 0), min(r + half + 1, rows)
            for c in range(rows):
                d, e = max(c - half, 0), min(c + half + 1, rows)
                count = (b - a) * (e - d)
                local = (total[b, e] - total[a, e] - total[b, d] + total[a, d]) / count
                spread = (square[b, e] - square[a, e] - square[b, d] + square[a, d]) / count - local * local
                value = (cells[r * rows + c] - local) / np.sqrt(max(spread, 0.0) + floor)
                cells[r * rows + c] = value
                sum1 += value
                sum2 += value * value
        mean = sum1 / n
        length = np.sqrt(max(sum2 - n * mean * mean, 1e-6))
        for i in range(n):
            cells[i] = (cells[i] - mean) / length
