"""Edgel detection, linking into chains, splitting into straight segments, and edge crossings."""

import numpy as np

from tracker.compiled import compiled
from tracker.geometry.geometry_kernels import median

MAX_STEPS = 64
DIAGONAL = np.float32(1.4142135)
# Weight of a peak at the end of the search range relative to one in its middle, because of two adjacent edges
# the nearer one is the expected one.
END_WEIGHT = 0.6


@compiled
def median_magnitude(gx, gy, stride):
    """Return the median gradient magnitude over every `stride`-th pixel and row; NaN for an empty image."""
    height, width = gx.shape
    found = np.empty(((height // stride) + 1) * ((width // stride) + 1))
    n = 0
    for v in range(stride // 2, height, stride):
        for u in range(stride // 2, width, stride):
            a, b = np.float32(gx[v, u]), np.float32(gy[v, u])
            found[n] = np.sqrt(a * a + b * b)
            n += 1
    return median(found, n) if n > 0 else np.nan


@compiled
def find_edgels(gx, gy, threshold):
    """Find edgels by non-maximum suppression: x, y, nx, ny, strength (n,), and an index image (h, w)."""
    height, width = gx.shape
    at = np.full((height, width), -1, np.int32)
    # In pure noise more than half of all pixels are edgels: the buffer must hold every pixel.
    found = np.empty((5, height * width), np.float32)
    n = 0
    minimum = np.int32(threshold)
    for v in range(1, height - 1):
        for u in range(1, width - 1):
            a, b = gx[v, u], gy[v, u]
            abs_a, abs_b = abs(a), abs(b)
            if abs_a + abs_b < minimum:
                continue
            # Suppression along the dominant axis of the gradient gives one edgel per row of a steep edge and
            # one per column of a flat edge, so that chains have neither gaps nor duplicates.
            if abs_a >= abs_b:
                sign = 1 if a > 0 else -1
                before, here, after = sign * gx[v, u - 1], sign * a, sign * gx[v, u + 1]
            else:
                sign = 1 if b > 0 else -1
                before, here, after = sign * gy[v - 1, u], sign * b, sign * gy[v + 1, u]
            if not (here > before and here >= after):
                continue
            fa, fb = np.float32(a), np.float32(b)
            strength = np.sqrt(fa * fa + fb * fb)
            if strength < threshold:
                continue
            shift = np.float32(0.5) * np.float32(before - after) / np.float32(before - 2 * here + after)
            if abs_a >= abs_b:
                found[0, n], found[1, n] = u + shift, v
            else:
                found[0, n], found[1, n] = u, v + shift
            found[2, n], found[3, n], found[4, n] = fa / strength, fb / strength, strength
            at[v, u] = n
            n += 1
    found_segments = found[:, :n].copy()
    return found_segments[0], found_segments[1], found_segments[2], found_segments[3], found_segments[4], at


@compiled
def link_edgels(nx, ny, strength, at):
    """Link edgels along their edges: successor and predecessor (n,), -1 for none."""
    height, width = at.shape
    count = nx.size
    successor = np.full(count, -1, np.int32)
    predecessor = np.full(count, -1, np.int32)
    claim = np.full(count, -1.0, np.float32)
    for v in range(1, height - 1):
        for u in range(1, width - 1):
            i = at[v, u]
            if i < 0:
                continue
            dx, dy = -ny[i], nx[i]
            best, best_rank_score = -1, np.float32(0.0)
            for dv in range(-1, 2):
                for du in range(-1, 2):
                    j = at[v + dv, u + du]
                    if j < 0 or j == i:
                        continue
                    far = DIAGONAL if du != 0 and dv != 0 else np.float32(1.0)
                    ahead = (np.float32(du) * dx + np.float32(dv) * dy) / far
                    cos_angle = nx[i] * nx[j] + ny[i] * ny[j]
                    # Within 67 degrees ahead, and rotated by at most 53: a chain may follow a blurred corner,
                    # but never jumps to the other side of a line.
                    if ahead < 0.38 or cos_angle < 0.6:
                        continue
                    # Similar strengths are preferred, so that a chain does not leave an edge for a faint
                    # halo.
                    even = min(strength[i], strength[j]) / max(strength[i], strength[j])
                    if even < 0.3:
                        continue
                    rank_score = ahead + cos_angle + even
                    if rank_score > best_rank_score:
                        best, best_rank_score = j, rank_score
            if best >= 0 and best_rank_score > claim[best]:
                if predecessor[best] >= 0:
                    successor[predecessor[best]] = -1
                claim[best] = best_rank_score
                predecessor[best] = i
                successor[i] = best
    return successor, predecessor


@compiled
def trace_chains(successor, predecessor, x, y, minimum):
    """Trace the linked edgels: order, start of each chain, and whether it is closed."""
    count = successor.size
    order = np.empty(count, np.int32)
    starts = np.empty(count // minimum + 2, np.int32)
    closed = np.zeros(count // minimum + 2, np.bool_)
    visited = np.zeros(count, np.bool_)
    n, c = 0, 0
    starts[0] = 0
    for pass_index in range(2):  # first the open chains from their starts, then the closed ones
        for i in range(count):
            if visited[i] or (pass_index == 0 and predecessor[i] >= 0):
                continue
            first = i
            if pass_index == 1:
                # A closed chain starts at the edgel farthest from an arbitrary one, usually a corner, so that
                # no side is split.
                far, j = np.float32(-1.0), i
                while True:
                    d = (x[j] - x[i]) ** 2 + (y[j] - y[i]) ** 2
                    if d > far:
                        far, first = d, j
                    j = successor[j]
                    if j == i or j < 0:
                        break
            begin, j = n, first
            while j >= 0 and not visited[j]:
                visited[j] = True
                order[n] = j
                n += 1
                j = successor[j]
            if n - begin < minimum:
                n = begin
                continue
            closed[c] = pass_index == 1
            c += 1
            starts[c] = n
    return order[:n].copy(), starts[: c + 1].copy(), closed[:c].copy()


@compiled
def _fit_line(x, y, order, a, b, out):
    """Fit a least-squares line to the edgels a..b of a chain; write its ends to `out`, return its length."""
    # Blur displaces the edgels next to a corner, so they are excluded if there are enough.
    trim = min(2, (b - a) // 6)
    lo, hi = a + trim, b - trim
    m = hi - lo + 1
    sx, sy = 0.0, 0.0
    for k in range(lo, hi + 1):
        sx += x[order[k]]
        sy += y[order[k]]
    mx, my = sx / m, sy / m
    sxx, sxy, syy = 0.0, 0.0, 0.0
    for k in range(lo, hi + 1):
        ex, ey = x[order[k]] - mx, y[order[k]] - my
        sxx += ex * ex
        sxy += ex * ey
        syy += ey * ey
    angle = 0.5 * np.arctan2(2.0 * sxy, sxx - syy)
    dx, dy = np.cos(angle), np.sin(angle)
    if (x[order[b]] - x[order[a]]) * dx + (y[order[b]] - y[order[a]]) * dy < 0.0:
        dx, dy = -dx, -dy
    p = (x[order[a]] - mx) * dx + (y[order[a]] - my) * dy
    q = (x[order[b]] - mx) * dx + (y[order[b]] - my) * dy
    out[0], out[1] = mx + p * dx, my + p * dy
    out[2], out[3] = mx + q * dx, my + q * dy
    return q - p


@compiled
def split_straight(x, y, order, starts, tolerance, min_length):
    """Split chains into straight segments (s, 4) at the farthest edgel (Douglas-Peucker)."""
    maximum = order.size // 2 + 1
    found = np.empty((maximum, 4), np.float32)
    n = 0
    stack = np.empty((order.size + 2, 2), np.int32)
    for c in range(starts.size - 1):
        stack[0, 0], stack[0, 1] = starts[c], starts[c + 1] - 1
        depth = 1
        while depth > 0:
            depth -= 1
            a, b = stack[depth, 0], stack[depth, 1]
            ax, ay = x[order[a]], y[order[a]]
            dx, dy = x[order[b]] - ax, y[order[b]] - ay
            length = np.sqrt(dx * dx + dy * dy)
            if b - a < 3:
                continue
            worst, at = np.float32(0.0), -1
            for k in range(a + 1, b):
                ex, ey = x[order[k]] - ax, y[order[k]] - ay
                off = abs(ex * dy - ey * dx) / length if length > 1.0 else np.sqrt(ex * ex + ey * ey)
                if off > worst:
                    worst, at = off, k
            if worst > tolerance:
                stack[depth, 0], stack[depth, 1] = at, b
                stack[depth + 1, 0], stack[depth + 1, 1] = a, at
                depth += 2
                continue
            if length < min_length or n >= maximum:
                continue
            if _fit_line(x, y, order, a, b, found[n]) >= min_length:
                n += 1
    return found[:n].copy()


@compiled
def _slope(gx, gy, x, y, nx, ny):
    """Return the bilinear derivative along (nx, ny) at a point (x, y) of the window."""
    iu, iv = int(x), int(y)
    fu, fv = x - iu, y - iv
    # Unsigned, because Numba checks signed indices for negative values.
    c, r, one = np.uint64(iu), np.uint64(iv), np.uint64(1)
    upper = (1.0 - fu) * (nx * gx[r, c] + ny * gy[r, c]) + fu * (nx * gx[r, c + one] + ny * gy[r, c + one])
    r += one
    lower = (1.0 - fu) * (nx * gx[r, c] + ny * gy[r, c]) + fu * (nx * gx[r, c + one] + ny * gy[r, c + one])
    return (1.0 - fv) * upper + fv * lower


@compiled
def crossing(gx, gy, u, v, nx, ny, reach):
    """Return the offset in px along the unit direction (nx, ny) from (u, v) to the edge, and its strength.

    (u, v) are pixels of the gradient's window. The edge is a peak of the derivative along the direction (dark
    to bright), within +-reach px. Strength 0: no edge.
    """
    height, width = gx.shape
    steps = min(int(np.ceil(reach)) + 1, MAX_STEPS)
    # Margin for rounding, so that the last sample stays inside the image.
    far_u, far_v = steps * abs(nx) + 1e-6, steps * abs(ny) + 1e-6
    inside = far_u <= u < width - 1.0 - far_u and far_v <= v < height - 1.0 - far_v
    best, best_rank_score, best_k = np.float64(0.0), np.float64(0.0), -1000
    best_before, best_after = np.float64(0.0), np.float64(0.0)
    before, here = np.float64(0.0), np.float64(0.0)
    for k in range(-steps, steps + 1):
        x, y = u + k * nx, v + k * ny
        after = np.float64(0.0)
        if inside or (0.0 <= x < width - 1.0 and 0.0 <= y < height - 1.0):
            after = _slope(gx, gy, x, y, nx, ny)
        # `here` is the previous sample, k - 1.
        if k > 1 - steps and here > 0.0 and here >= before and here >= after:
            rank_score = here * (1.0 - (1.0 - END_WEIGHT) * abs(k - 1) / steps)
            if rank_score > best_rank_score:
                best_rank_score, best_k, best, best_before, best_after = (
                    rank_score,
                    k - 1,
                    here,
                    before,
                    after,
                )
        before, here = here, after
    if best_k == -1000:
        return 0.0, 0.0
    bend = best_before - 2.0 * best + best_after
    shift = 0.5 * (best_before - best_after) / bend if bend < 0.0 else 0.0
    offset = best_k + shift
    if abs(offset) > reach:
        return 0.0, 0.0
    return offset, best


@compiled
def _continues(a, b, max_gap, max_off, min_cos):
    """Return whether segment b continues segment a: near its end, same direction, collinear."""
    gu, gv = b[0] - a[2], b[1] - a[3]
    if abs(gu) > max_gap or abs(gv) > max_gap:
        return False
    ax, ay, bx, by = a[2] - a[0], a[3] - a[1], b[2] - b[0], b[3] - b[1]
    la, lb = np.sqrt(ax * ax + ay * ay), np.sqrt(bx * bx + by * by)
    if min(la, lb) + 2.0 < np.sqrt(gu * gu + gv * gv) or ax * bx + ay * by < min_cos * la * lb:
        return False
    tx, ty = b[2] - a[0], b[3] - a[1]
    lt = np.sqrt(tx * tx + ty * ty)
    if lt < max(la, lb):
        return False
    off = max(abs(ax * ty - ay * tx), abs((b[0] - a[0]) * ty - (b[1] - a[1]) * tx))
    return off <= max_off * lt


@compiled
def starts_by_cell(segments, cell_px):
    """Sort segments by the cell of their start, in a square grid with one empty cell before it.

    Returns the first segment of each cell and the next one of each segment, -1 for none, and the number of
    columns.
    """
    n, largest = len(segments), np.float32(0.0)
    for j in range(n):
        for k in range(4):
            largest = max(largest, segments[j, k])
    columns = int(largest / cell_px) + 3
    head, after = np.full(columns * columns, -1, np.int32), np.full(n, -1, np.int32)
    for j in range(n):
        row, column = int(max(segments[j, 1], 0.0) / cell_px), int(max(segments[j, 0], 0.0) / cell_px)
        cell = (row + 1) * columns + column + 1
        after[j] = head[cell]
        head[cell] = j
    return head, after, columns


@compiled
def join_collinear(segments, max_gap, max_off, min_cos):
    """Join collinear segments that continue one another."""
    n = len(segments)
    head, after, columns = starts_by_cell(segments, max_gap)
    next_segment = np.full(n, -1, np.int32)
    has_previous = np.zeros(n, np.bool_)
    for i in range(n):
        row, column = (
            int(max(segments[i, 3], 0.0) / max_gap) + 1,
            int(max(segments[i, 2], 0.0) / max_gap) + 1,
        )
        nearest = np.float32(1e9)
        for r in range(max(row - 1, 0), min(row + 2, columns)):
            for c in range(max(column - 1, 0), min(column + 2, columns)):
                j = head[r * columns + c]
                while j >= 0:
                    if (
                        j != i
                        and not has_previous[j]
                        and _continues(segments[i], segments[j], max_gap, max_off, min_cos)
                    ):
                        gap = abs(segments[j, 0] - segments[i, 2]) + abs(segments[j, 1] - segments[i, 3])
                        if gap < nearest:
                            nearest, next_segment[i] = gap, j
                    j = after[j]
        if next_segment[i] >= 0:
            has_previous[next_segment[i]] = True
    found_segments = np.empty((n, 4), np.float32)
    m = 0
    for i in range(n):
        if has_previous[i] or next_segment[i] < 0:
            continue
        joined = segments[i].copy()
        j = next_segment[i]
        for _ in range(n):
            if j < 0 or not _continues(joined, segments[j], max_gap, max_off, min_cos):
                break
            joined[2], joined[3] = segments[j, 2], segments[j, 3]
            j = next_segment[j]
        for k in range(4):
            found_segments[m, k] = joined[k]
        m += 1
    return found_segments[:m].copy()
