"""The compiled loops of the marker; their types are those of their calls."""

import numpy as np

from tracker.compiled import compiled
from tracker.edges.kernels import crossing

BLOCK = 64


@compiled
def peek(image, quads, cells, templates, dark, light):
    """Correlation (t, q) of templates (t, n * n), n = cells + 2, with parallelograms, a pixel a cell.

    What is as dark or light as these, or more so, counts as 0 and 1.
    """
    height, width = image.shape
    count, n = len(quads), cells + 2
    size, scale = n * n, np.float32(1.0) / (light - dark)
    out = np.empty((len(templates), count), np.float32)
    # Quads lie side by side in a block, so that the machine works on many at once.
    block = np.empty((size, BLOCK), np.float32)
    for start in range(0, count, BLOCK):
        many = min(BLOCK, count - start)
        for k in range(many):
            quad = quads[start + k]
            ax, ay = (quad[1, 0] - quad[0, 0]) / cells, (quad[1, 1] - quad[0, 1]) / cells
            bx, by = (quad[3, 0] - quad[0, 0]) / cells, (quad[3, 1] - quad[0, 1]) / cells
            ox, oy = quad[0, 0] - 0.5 * (ax + bx) + 0.5, quad[0, 1] - 0.5 * (ay + by) + 0.5
            total, square = np.float32(0.0), np.float32(0.0)
            for r in range(n):
                for c in range(n):
                    u = min(max(int(ox + c * ax + r * bx), 0), width - 1)
                    v = min(max(int(oy + c * ay + r * by), 0), height - 1)
                    value = min(max((image[v, u] - dark) * scale, np.float32(0.0)), np.float32(1.0))
                    block[r * n + c, k] = value
                    total += value
                    square += value * value
            mean = total / size
            length = np.float32(1.0) / np.sqrt(max(square - size * mean * mean, np.float32(1e-3)))
            for i in range(size):
                block[i, k] = (block[i, k] - mean) * length
        for t in range(len(templates)):
            line = out[t, start : start + many]
            line[:] = 0.0
            for i in range(size):
                weight = templates[t, i]
                for k in range(many):
                    line[k] += weight * block[i, k]
    return out


@compiled
def products(rows, columns):
    """The matrix product of rows (n, k) and columns (k, m).

    A library's product would start threads for so little, and wait for them.
    """
    out = np.zeros((len(rows), columns.shape[1]), np.float32)
    for i in range(len(rows)):
        line = out[i]
        for k in range(columns.shape[0]):
            weight = rows[i, k]
            column = columns[k]
            for j in range(columns.shape[1]):
                line[j] += weight * column[j]
    return out


@compiled
def crossings(gx, gy, points, normals, reach):
    """Offsets and strengths (n,) of the edges that cross the normals at these points."""
    n = len(points)
    offset, response = np.zeros(n), np.zeros(n)
    for i in range(n):
        offset[i], response[i] = crossing(
            gx, gy, points[i, 0], points[i, 1], normals[i, 0], normals[i, 1], reach
        )
    return offset, response


@compiled
def explained(at, ex, ey, enx, eny, strength, points, normals, corners, radius, margin, least):
    """How many edgels inside the corners are near a model edge of their direction, and how many there are."""
    height, width = at.shape
    u0 = max(int(corners[:, 0].min() - margin), 0)
    u1 = min(int(corners[:, 0].max() + margin) + 1, width - 1)
    v0 = max(int(corners[:, 1].min() - margin), 0)
    v1 = min(int(corners[:, 1].max() + margin) + 1, height - 1)
    common, present = 0, 0
    for v in range(v0, v1 + 1):
        for u in range(u0, u1 + 1):
            i = at[v, u]
            if i < 0 or strength[i] < least:
                continue
            x, y = ex[i], ey[i]
            inside = True
            for k in range(4):
                ax, ay = corners[k, 0], corners[k, 1]
                bx, by = corners[(k + 1) % 4, 0], corners[(k + 1) % 4, 1]
                side = np.sqrt((bx - ax) ** 2 + (by - ay) ** 2)
                if (bx - ax) * (y - ay) - (by - ay) * (x - ax) < -margin * side:
                    inside = False
                    break
            if not inside:
                continue
            present += 1
            for j in range(len(points)):
                dx, dy = points[j, 0] - x, points[j, 1] - y
                if dx * dx + dy * dy > radius * radius:
                    continue
                # The same polarity, within 60 degrees: at a corner the image's edge is rounder.
                if enx[i] * normals[j, 0] + eny[i] * normals[j, 1] > 0.5:
                    common += 1
                    break
    return common, present


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
                a, b = (c - ring + 0.5) / cells, (r - ring + 0.5) / cells
                w = h[6] * a + h[7] * b + 1.0
                u = min(max((h[0] * a + h[1] * b + h[2]) / w, 0.0), width - 1.001)
                v = min(max((h[3] * a + h[4] * b + h[5]) / w, 0.0), height - 1.001)
                iu, iv = int(u), int(v)
                fu, fv = np.float32(u - iu), np.float32(v - iv)
                upper = image[iv, iu] + fu * (np.float32(image[iv, iu + 1]) - image[iv, iu])
                lower = image[iv + 1, iu] + fu * (np.float32(image[iv + 1, iu + 1]) - image[iv + 1, iu])
                out[q, r * n + c] = upper + fv * (lower - upper)
    return out


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
            a, b = (c + 0.5) / n, (r + 0.5) / n
            w = h[6] * a + h[7] * b + 1.0
            u = min(max((h[0] * a + h[1] * b + h[2]) / w, 0.0), width - 1.001)
            v = min(max((h[3] * a + h[4] * b + h[5]) / w, 0.0), height - 1.001)
            iu, iv = int(u), int(v)
            fu, fv = u - iu, v - iv
            upper = (1 - fu) * image[iv, iu] + fu * image[iv, iu + 1]
            lower = (1 - fu) * image[iv + 1, iu] + fu * image[iv + 1, iu + 1]
            out[r // samples, c // samples] += (1 - fv) * upper + fv * lower
    return out / (samples * samples)
