"""The compiled loops of the sampling; their types are those of their calls."""

import numpy as np

from tracker.compiled import compiled


@compiled
def square_to_quad(quad, h):
    """The homography (8 numbers, h33 = 1) from the unit square to four corners, clockwise from (0, 0)."""
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
    """Where a homography (8,) takes a point (a, b)."""
    w = h[6] * a + h[7] * b + 1.0
    return (h[0] * a + h[1] * b + h[2]) / w, (h[3] * a + h[4] * b + h[5]) / w


@compiled
def sample_quads(image, quads, cells, ring):
    """Grey (q, n * n) at n = cells + 2 ring points a side of each outline, `ring` of them beyond."""
    height, width = image.shape
    count, n = len(quads), cells + 2 * ring
    out = np.empty((count, n * n), np.float32)
    h = np.empty(8, np.float64)
    for q in range(count):
        square_to_quad(quads[q], h)
        for r in range(n):
            for c in range(n):
                u, v = through(h, (c - ring + 0.5) / cells, (r - ring + 0.5) / cells)
                u, v = min(max(u, 0.0), width - 1.001), min(max(v, 0.0), height - 1.001)
                iu, iv = int(u), int(v)
                fu, fv = np.float32(u - iu), np.float32(v - iv)
                upper = image[iv, iu] + fu * (np.float32(image[iv, iu + 1]) - image[iv, iu])
                lower = image[iv + 1, iu] + fu * (np.float32(image[iv + 1, iu + 1]) - image[iv + 1, iu])
                out[q, r * n + c] = upper + fv * (lower - upper)
    return out


@compiled
def sample_square(image, corners, fields, samples):
    """Mean grey of fields x fields cells of a square at these corners, samples x samples in each."""
    height, width = image.shape
    h = np.empty(8, np.float64)
    square_to_quad(corners, h)
    out = np.zeros((fields, fields))
    n = fields * samples
    for r in range(n):
        for c in range(n):
            u, v = through(h, (c + 0.5) / n, (r + 0.5) / n)
            u, v = min(max(u, 0.0), width - 1.001), min(max(v, 0.0), height - 1.001)
            iu, iv = int(u), int(v)
            fu, fv = u - iu, v - iv
            upper = (1 - fu) * image[iv, iu] + fu * image[iv, iu + 1]
            lower = (1 - fu) * image[iv + 1, iu] + fu * image[iv + 1, iu + 1]
            out[r // samples, c // samples] += (1 - fv) * upper + fv * lower
    return out / (samples * samples)


@compiled
def even_light(seen, rows, half, floor_grey, floor_ratio):
    """Make of pictures (q, rows * rows), in place, what they are beside their own surroundings.

    Each cell less the mean of the cells within `half` of it, over their sd: so a shadow's edge or glare over
    a part of the square leaves the rest of its picture as it is. Then mean 0 and length 1.
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
