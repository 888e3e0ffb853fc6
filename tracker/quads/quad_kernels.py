"""Quad hypotheses from line segments."""

import numpy as np

from tracker.compiled import compiled
from tracker.edges.edge_kernels import starts_by_cell
from tracker.geometry.geometry_kernels import is_plausible_foreshortening

MAX_SUCCESSORS = 8
MAX_CORNER_QUADS = 12000
CELL_PX = np.float32(16.0)
MAX_GAP_PX = 30.0
MAX_PAIR_QUADS = 40000
# Opposite sides have opposite directions, up to a sixth of a radian by perspective.
DIRECTIONS, MAX_PAIR_COSINE = 36, 0.985
MAX_APART_LENGTHS = 3.0


@compiled
def _length(s):
    return np.sqrt((s[2] - s[0]) ** 2 + (s[3] - s[1]) ** 2)


@compiled
def _intersection(a, b, out):
    """Intersect the lines of two segments; False where they are nearly parallel."""
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
    """Return for each segment those that may follow it round a corner, nearest first."""
    n = len(segments)
    head, after, columns = starts_by_cell(segments, CELL_PX)
    successors = np.full((n, MAX_SUCCESSORS), -1, np.int32)
    gaps = np.empty((n, MAX_SUCCESSORS), np.float32)
    counts = np.zeros(n, np.int32)
    corner = np.empty(2)
    length, dx, dy = np.empty(n, np.float32), np.empty(n, np.float32), np.empty(n, np.float32)
    for i in range(n):
        length[i] = _length(segments[i])
        dx[i] = (segments[i, 2] - segments[i, 0]) / length[i]
        dy[i] = (segments[i, 3] - segments[i, 1]) / length[i]
    for i in range(n):
        a = segments[i]
        la, dax, day, au, av = length[i], dx[i], dy[i], a[2], a[3]
        reach = min(np.float32(3.0) + np.float32(0.3) * la, np.float32(MAX_GAP_PX))
        cu, cv = int(max(a[2], 0.0) / CELL_PX) + 1, int(max(a[3], 0.0) / CELL_PX) + 1
        cells = int(reach / CELL_PX) + 1
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
                    if gap > limit * limit or not _intersection(a, b, corner):
                        continue
                    if (corner[0] - a[2]) ** 2 + (corner[1] - a[3]) ** 2 > limit * limit:
                        continue
                    if (corner[0] - b[0]) ** 2 + (corner[1] - b[1]) ** 2 > limit * limit:
                        continue
                    m = counts[i]
                    if m < MAX_SUCCESSORS:
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
def _is_dark_corner(image, p, ax, ay, bx, by, beside, min_step):
    """Return whether both sides at corner p (vectors a, b) are bright outside and dark inside.

    Checked at five points along each, `beside` px off the side.
    """
    height, width = image.shape
    dark, light = np.float32(0.0), np.float32(0.0)
    poor = 0
    for side in range(2):
        dx, dy = (ax, ay) if side == 0 else (bx, by)
        length = np.sqrt(dx * dx + dy * dy)
        # The inward normal: the component of the other side's direction perpendicular to this side.
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
            if outside - inside < min_step:
                poor += 1
    return poor <= 1 and light - dark > 10.0 * min_step


@compiled
def corner_quads(image, segments, successors, counts, min_side, min_squash, beside, min_step, growth):
    """Return quads (q, 4, 2) of two sides that meet at a corner, of unknown length.

    Each side in turn is assumed complete, and the length of the other varies from its visible part to the
    limit of plausible foreshortening.
    """
    n = len(segments)
    quads = np.empty((MAX_CORNER_QUADS, 4, 2), np.float32)
    corner = np.empty(2, np.float64)
    q = 0
    for i in range(n):
        for a in range(counts[i]):
            j = successors[i, a]
            if not _intersection(segments[i], segments[j], corner):
                continue
            ax, ay = segments[i, 0] - corner[0], segments[i, 1] - corner[1]
            bx, by = segments[j, 2] - corner[0], segments[j, 3] - corner[1]
            la, lb = np.sqrt(ax * ax + ay * ay), np.sqrt(bx * bx + by * by)
            if min(la, lb) < 0.5 * min_side or max(la, lb) < min_side:
                continue
            if not _is_dark_corner(image, corner, ax, ay, bx, by, beside, min_step):
                continue
            cosine = (ax * bx + ay * by) / (la * lb)
            for whole in range(2):
                fixed, length = (la, lb) if whole == 0 else (lb, la)
                step = 0
                while fixed >= min_side and q < MAX_CORNER_QUADS:
                    squared_area = (fixed * length) ** 2 * (1.0 - cosine * cosine)
                    good = is_plausible_foreshortening(
                        fixed * fixed + length * length, squared_area, min_squash
                    )
                    if good and length >= 0.5 * min_side and (whole == 0 or step > 0):
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
def _add_across(quad, p, along, across, length, beyond):
    """Write a quad: a side of this length about p, and one `across` from it, shifted by `beyond`."""
    x, y = 0.5 * length * along[0], 0.5 * length * along[1]
    u, v = p[0] + across[0] + beyond * along[0], p[1] + across[1] + beyond * along[1]
    quad[0, 0], quad[0, 1], quad[1, 0], quad[1, 1] = p[0] - x, p[1] - y, p[0] + x, p[1] + y
    quad[2, 0], quad[2, 1], quad[3, 0], quad[3, 1] = u + x, v + y, u - x, v - y


@compiled
def _by_direction(along):
    """Bin segments by direction (n, 2): own bin, first segment of each bin, next segment of each."""
    head, after = np.full(DIRECTIONS, -1, np.int32), np.empty(len(along), np.int32)
    own = np.empty(len(along), np.int32)
    for i in range(len(along)):
        turn = np.arctan2(along[i, 1], along[i, 0]) / (2.0 * np.pi)
        own[i] = int(np.floor(turn * DIRECTIONS)) % DIRECTIONS
        after[i] = head[own[i]]
        head[own[i]] = i
    return own, head, after


@compiled
def _opposite_sides(length, along, middle, i, j, min_side, max_ratio, d):
    """Return the distance of two opposite sides and the shift of the second along `d`, which is filled.

    They run in opposite directions, dark side inwards; 0 where they are not opposite.
    """
    longer, weight = max(length[i], length[j]), length[i] + length[j]
    if longer < min_side or longer > max_ratio * min(length[i], length[j]):
        return 0.0, 0.0
    if along[i, 0] * along[j, 0] + along[i, 1] * along[j, 1] > -MAX_PAIR_COSINE:
        return 0.0, 0.0
    for k in range(2):
        d[k] = (length[i] * along[i, k] - length[j] * along[j, k]) / weight
    x, y = middle[j, 0] - middle[i, 0], middle[j, 1] - middle[i, 1]
    separation, beyond = d[0] * y - d[1] * x, d[0] * x + d[1] * y
    if separation < min_side or abs(beyond) > separation or separation > MAX_APART_LENGTHS * longer:
        return 0.0, 0.0
    return separation, beyond


@compiled
def pair_quads(segments, min_side, min_squash, max_ratio, lengths, shifts):
    """Return quads (q, 4, 2) of pairs of opposite sides whose length ratio is at most `max_ratio`.

    The side length is varied by the factors `lengths` on the longer side, and the position along it by
    `shifts` as ratios of that length. The first side of a quad lies along the first of the pair.
    """
    n, q = len(segments), 0
    quads = np.empty((MAX_PAIR_QUADS, 4, 2), np.float32)
    length, along, middle = np.empty(n), np.empty((n, 2)), np.empty((n, 2))
    for i in range(n):
        length[i] = _length(segments[i])
        for k in range(2):
            along[i, k] = (segments[i, 2 + k] - segments[i, k]) / length[i]
            middle[i, k] = 0.5 * (segments[i, 2 + k] + segments[i, k])
    own, head, after = _by_direction(along)
    d, across, p = np.empty(2), np.empty(2), np.empty(2)
    for i in range(n):
        for near in range(-1, 2):
            j = head[(own[i] + DIRECTIONS // 2 + near) % DIRECTIONS]
            while j >= 0:
                other, j = j, after[j]
                # Visit each pair once.
                if other < i:
                    continue
                separation, beyond = _opposite_sides(length, along, middle, i, other, min_side, max_ratio, d)
                if separation == 0.0:
                    continue
                across[0], across[1] = -d[1] * separation, d[0] * separation
                for m in range(2 * len(lengths)):
                    # Hypotheses: a rectangle, or a parallelogram whose sides are offset as the visible parts
                    # are.
                    side, slant = lengths[m // 2] * max(length[i], length[other]), (m % 2) * beyond
                    squares = side * side + separation * separation + slant * slant
                    if not is_plausible_foreshortening(squares, (side * separation) ** 2, min_squash):
                        continue
                    for k in range(len(shifts)):
                        if q == MAX_PAIR_QUADS:
                            return quads
                        off = shifts[k] * side + 0.5 * (beyond - slant)
                        p[0], p[1] = middle[i, 0] + off * d[0], middle[i, 1] + off * d[1]
                        _add_across(quads[q], p, d, across, side, slant)
                        q += 1
    return quads[:q].copy()
