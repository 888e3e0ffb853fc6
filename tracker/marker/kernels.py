"""The compiled loops of the marker; their types are those of their calls."""

import numpy as np

from tracker.compiled import compiled
from tracker.edges.kernels import crossing

MOST_SUCCESSORS = 8
MOST_CORNER_QUADS = 12000
BLOCK = 64
CELL_PX = 16
MOST_GAP_PX = 30.0
LEAST_SIDE_PX = 4.0


@compiled
def _length(s):
    return np.sqrt((s[2] - s[0]) ** 2 + (s[3] - s[1]) ** 2)


@compiled
def _corner(a, b, out):
    """Where the lines of two segments meet; False when they are nearly parallel."""
    dax, day = a[2] - a[0], a[3] - a[1]
    dbx, dby = b[2] - b[0], b[3] - b[1]
    cross = dax * dby - day * dbx
    if abs(cross) < 1e-6:
        return False
    t = ((b[0] - a[0]) * dby - (b[1] - a[1]) * dbx) / cross
    out[0], out[1] = a[0] + t * dax, a[1] + t * day
    return True


@compiled
def successors_of(segments):
    """For each segment those that may follow it round a corner, nearest first."""
    n = len(segments)
    columns = int(segments[:, :].max() / CELL_PX) + 3
    head = np.full(columns * columns, -1, np.int32)
    after = np.full(n, -1, np.int32)
    for j in range(n):
        cell = (
            (int(max(segments[j, 1], 0.0)) // CELL_PX + 1) * columns
            + int(max(segments[j, 0], 0.0)) // CELL_PX
            + 1
        )
        after[j] = head[cell]
        head[cell] = j
    successors = np.full((n, MOST_SUCCESSORS), -1, np.int32)
    gaps = np.empty((n, MOST_SUCCESSORS), np.float32)
    counts = np.zeros(n, np.int32)
    corner = np.empty(2, np.float32)
    length, dx, dy = np.empty(n, np.float32), np.empty(n, np.float32), np.empty(n, np.float32)
    for i in range(n):
        length[i] = _length(segments[i])
        dx[i] = (segments[i, 2] - segments[i, 0]) / length[i]
        dy[i] = (segments[i, 3] - segments[i, 1]) / length[i]
    for i in range(n):
        a = segments[i]
        la, dax, day, au, av = length[i], dx[i], dy[i], a[2], a[3]
        reach = min(np.float32(3.0) + np.float32(0.3) * la, np.float32(MOST_GAP_PX))
        cu, cv = int(max(a[2], 0.0)) // CELL_PX + 1, int(max(a[3], 0.0)) // CELL_PX + 1
        cells = int(reach) // CELL_PX + 1
        for row in range(max(cv - cells, 0), min(cv + cells + 1, columns)):
            for column in range(max(cu - cells, 0), min(cu + cells + 1, columns)):
                j = head[row * columns + column]
                while j >= 0:
                    k, j = j, after[j]
                    # A right turn of 15 to 165 degrees: a square seen at 60 degrees of tilt has corners
                    # from 53 to 127, and perspective adds some.
                    if dax * dy[k] - day * dx[k] < np.float32(0.26):
                        continue
                    b = segments[k]
                    limit = min(reach, np.float32(3.0) + np.float32(0.3) * length[k])
                    gap = (b[0] - au) * (b[0] - au) + (b[1] - av) * (b[1] - av)
                    if gap > limit * limit or not _corner(a, b, corner):
                        continue
                    if (corner[0] - a[2]) ** 2 + (corner[1] - a[3]) ** 2 > limit * limit:
                        continue
                    if (corner[0] - b[0]) ** 2 + (corner[1] - b[1]) ** 2 > limit * limit:
                        continue
                    m = counts[i]
                    if m < MOST_SUCCESSORS:
                        counts[i] += 1
                    elif gap < gaps[i, m - 1]:
                        m -= 1
                    else:
                        continue
                    while m > 0 and gaps[i, m - 1] > gap:
                        successors[i, m], gaps[i, m] = successors[i, m - 1], gaps[i, m - 1]
                        m -= 1
                    successors[i, m], gaps[i, m] = k, gap
    return successors, counts


@compiled
def _even_sides(image, p, ax, ay, bx, by, beside, least_step):
    """Whether two sides that leave the corner p (vectors a, b) are all light outside and dark inside.

    Looked at five places along each, `beside` px off the side.
    """
    height, width = image.shape
    dark, light = np.float32(0.0), np.float32(0.0)
    poor = 0
    for side in range(2):
        dx, dy = (ax, ay) if side == 0 else (bx, by)
        length = np.sqrt(dx * dx + dy * dy)
        # Inwards is the part of the other side's direction that is square to this one.
        nx, ny = -dy / length, dx / length
        if (nx * bx + ny * by if side == 0 else nx * ax + ny * ay) < 0.0:
            nx, ny = -nx, -ny
        for k in range(5):
            t = 0.16 + 0.17 * k
            x, y = p[0] + t * dx, p[1] + t * dy
            u, v = int(x + beside * nx + 0.5), int(y + beside * ny + 0.5)
            uo, vo = int(x - beside * nx + 0.5), int(y - beside * ny + 0.5)
            if min(u, v, uo, vo) < 0 or max(u, uo) >= width or max(v, vo) >= height:
                return False
            inside, outside = np.float32(image[v, u]), np.float32(image[vo, uo])
            dark += inside
            light += outside
            if outside - inside < least_step:
                poor += 1
    return poor <= 1 and light - dark > 10.0 * least_step


@compiled
def corner_quads(image, segments, successors, counts, least_side, least_squash, beside, least_step, growth):
    """Outlines (q, 4, 2) of two sides that meet at a corner and go on nobody knows how far.

    Each of the two is taken for whole in turn and the other's length is tried, from what is seen of it to
    what tilt allows.
    """
    n = len(segments)
    quads = np.empty((MOST_CORNER_QUADS, 4, 2), np.float32)
    corner = np.empty(2, np.float64)
    q = 0
    for i in range(n):
        for a in range(counts[i]):
            j = successors[i, a]
            if not _corner(segments[i], segments[j], corner):
                continue
            ax, ay = segments[i, 0] - corner[0], segments[i, 1] - corner[1]
            bx, by = segments[j, 2] - corner[0], segments[j, 3] - corner[1]
            la, lb = np.sqrt(ax * ax + ay * ay), np.sqrt(bx * bx + by * by)
            if min(la, lb) < 0.5 * least_side or max(la, lb) < least_side:
                continue
            if not _even_sides(image, corner, ax, ay, bx, by, beside, least_step):
                continue
            cosine = (ax * bx + ay * by) / (la * lb)
            for whole in range(2):
                fixed, length = (la, lb) if whole == 0 else (lb, la)
                step = 0
                while fixed >= least_side and q < MOST_CORNER_QUADS:
                    # The squash of the parallelogram of two sides at this angle.
                    total, area = fixed * fixed + length * length, fixed * length
                    root = np.sqrt(max(total * total - 4.0 * area * area * (1.0 - cosine * cosine), 0.0))
                    good = total - root > least_squash * least_squash * (total + root)
                    if good and length >= 0.5 * least_side and (whole == 0 or step > 0):
                        sa, sb = (1.0, length / lb) if whole == 0 else (length / la, 1.0)
                        quad = quads[q]
                        quad[0, 0], quad[0, 1] = corner[0] + sa * ax, corner[1] + sa * ay
                        quad[1, 0], quad[1, 1] = corner[0], corner[1]
                        quad[2, 0], quad[2, 1] = corner[0] + sb * bx, corner[1] + sb * by
                        quad[3, 0], quad[3, 1] = quad[0, 0] + sb * bx, quad[0, 1] + sb * by
                        q += 1
                    elif not good and length > fixed:
                        break
                    length *= growth
                    step += 1
    return quads[:q].copy()


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
