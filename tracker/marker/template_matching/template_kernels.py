"""Coarse correlation and least-squares alignment of quads with templates."""

import numpy as np

from tracker.compiled import compiled
from tracker.marker.sampling_kernels import normalise_locally, sample_quads, square_to_quad, through

BLOCK = 64
# The unknowns of a Gauss-Newton step: gain, offset, and two coordinates of each corner.
UNKNOWNS = 10
# Maximum motion of a corner in one step.
MAX_STEP_SIDES = 0.12
# Minimum gain of the template for a step.
MIN_GAIN = 0.1
# A step is accepted only if it reduces the residual to this ratio.
MAX_RESIDUAL_RATIO = 0.95
# Template and mask are selected again after this many steps.
SELECT_EVERY = 3


@compiled
def coarse_correlations(image, quads, cells, templates, dark, light):
    """Return the correlation (t, q) of templates (t, n * n), n = cells + 2, with parallelograms.

    One pixel is sampled per cell. Grey values are clipped to `dark`..`light` and scaled to 0..1.
    """
    height, width = image.shape
    count, n = len(quads), cells + 2
    size, scale = n * n, np.float32(1.0) / (light - dark)
    out = np.empty((len(templates), count), np.float32)
    # Quads are interleaved in blocks, so that the loops vectorise.
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
    """Return the matrix product of rows (n, k) and columns (k, m).

    A BLAS product would start threads for such small matrices and wait for them.
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
def _compare(seen, columns, left, shared, sums, squares):
    """Compute the products of observed cells (n,) with the columns, and sums and squares under each mask."""
    # Contiguous inner loops, so that they vectorise.
    shared[:], sums[:], squares[:] = 0.0, 0.0, 0.0
    for i in range(len(seen)):
        value = seen[i]
        square = value * value
        for k in range(len(shared)):
            shared[k] += value * columns[i, k]
        for c in range(len(sums)):
            sums[c] += value * left[i, c]
            squares[c] += square * left[i, c]


@compiled
def _best_match(seen, columns, mean, spread, left, sizes, shared, sums, squares):
    """Return the best correlation with the templates, and the index of the template and of the mask."""
    count = len(sizes)
    _compare(seen, columns, left, shared, sums, squares)
    best, picture, mask = 0.0, 0, 0
    for c in range(count):
        own = max(squares[c] - sums[c] * sums[c] / sizes[c], 1e-9)
        ncc, like = 0.0, 0
        for p in range(len(mean)):
            over = shared[p * count + c] - mean[p, c] * sums[c]
            if over > 0.0 and over * over > ncc * spread[p, c]:
                ncc, like = over * over / spread[p, c], p
        # The log-likelihood of n cells with correlation r is -n/2 log(1 - r^2): the fewer cells are visible,
        # the higher their correlation must be.
        fit = -np.log(1.0 - min(ncc / own, 0.9999)) * sizes[c] / len(seen)
        if fit > best:
            best, picture, mask = fit, like, c
    return np.sqrt(1.0 - np.exp(-best)), picture, mask


@compiled
def _add_parallelogram_prior(quad, weight, right):
    """Add the gradient of the prior for a parallelogram to the right-hand side."""
    ax = 0.5 * (quad[1, 0] - quad[0, 0] + quad[2, 0] - quad[3, 0])
    ay = 0.5 * (quad[1, 1] - quad[0, 1] + quad[2, 1] - quad[3, 1])
    bx = 0.5 * (quad[3, 0] - quad[0, 0] + quad[2, 0] - quad[1, 0])
    by = 0.5 * (quad[3, 1] - quad[0, 1] + quad[2, 1] - quad[1, 1])
    x = quad[0, 0] - quad[1, 0] + quad[2, 0] - quad[3, 0]
    y = quad[0, 1] - quad[1, 1] + quad[2, 1] - quad[3, 1]
    det = ax * by - ay * bx
    along, down = weight * (x * by - y * bx) / det, weight * (ax * y - ay * x) / det
    for k in range(4):
        sign = 1 - 2 * (k % 2)
        right[2 + 2 * k] += sign * along
        right[3 + 2 * k] += sign * down


@compiled
def _solve(factor, right):
    for j in range(UNKNOWNS):
        total = right[j]
        for i in range(j):
            total -= factor[j, i] * right[i]
        right[j] = total / factor[j, j]
    for j in range(UNKNOWNS - 1, -1, -1):
        total = right[j]
        for i in range(j + 1, UNKNOWNS):
            total -= factor[i, j] * right[i]
        right[j] = total / factor[j, j]


@compiled
def _copy_quad(quad, out):
    """Copy corners (4, 2)."""
    for k in range(4):
        out[k, 0], out[k, 1] = quad[k, 0], quad[k, 1]


@compiled
def _move_corners(quad, solved):
    """Move each corner, in place, by its offset in sides of the square's plane.

    `solved` (10,): gain, constant, and the offsets times the gain.
    """
    h, moved = np.empty(8), np.empty((4, 2))
    square_to_quad(quad, h)
    for k in range(4):
        right, down = solved[2 + 2 * k] / solved[0], solved[3 + 2 * k] / solved[0]
        a = (1.0 if k in (1, 2) else 0.0) - min(max(right, -MAX_STEP_SIDES), MAX_STEP_SIDES)
        b = (1.0 if k > 1 else 0.0) - min(max(down, -MAX_STEP_SIDES), MAX_STEP_SIDES)
        moved[k, 0], moved[k, 1] = through(h, a, b)
    for k in range(4):
        quad[k, 0], quad[k, 1] = moved[k, 0], moved[k, 1]


@compiled
def align_to_templates(
    image,
    quads,
    basis,
    factors,
    columns,
    mean,
    spread,
    occlusion_masks,
    visible,
    visible_count,
    steps,
    stiffness,
    cells,
    ring,
    around,
    floor_grey,
    floor_ratio,
):
    """Align quads (q, 4, 2) with one of the templates; return them and their correlation (q,).

    Gauss-Newton steps (Lucas-Kanade alignment): the observed cells are modelled as gain times template plus
    its derivatives by the corners. `visible` (n, c): the transposed occlusion masks, and `visible_count` (c,)
    their sums.
    """
    shared = np.empty(columns.shape[1], np.float32)
    sums, squares = np.empty(len(occlusion_masks), np.float32), np.empty(len(occlusion_masks), np.float32)
    found, correlation = quads.copy(), np.zeros(len(quads), np.float32)
    right = np.empty(UNKNOWNS, np.float32)
    quad = np.empty((1, 4, 2), np.float32)
    for q in range(len(quads)):
        _copy_quad(quads[q], quad[0])
        picture, mask, worst, ncc = -1, -1, 0.0, 0.0
        for step in range(steps + 1):
            seen = sample_quads(image, quad, cells, ring)
            normalise_locally(seen, cells + 2 * ring, around, floor_grey, floor_ratio)
            if step % SELECT_EVERY == 0 or step == steps:
                ncc, p, c = _best_match(
                    seen[0], columns, mean, spread, visible, visible_count, shared, sums, squares
                )
                # A quad that already fits is not moved, because the templates are coarser than the image.
                if step == 0:
                    worst = MAX_RESIDUAL_RATIO * (1.0 - ncc * ncc)
                if ncc > correlation[q]:
                    correlation[q] = ncc
                    if 1.0 - ncc * ncc < worst:
                        _copy_quad(quad[0], found[q])
                picture, mask = p, c
            if step == steps:
                break
            right[:] = 0.0
            for i in range(len(columns)):
                value = seen[0, i] * occlusion_masks[mask, i]
                for j in range(UNKNOWNS):
                    right[j] += value * basis[picture, i, j]
            _add_parallelogram_prior(quad[0], stiffness * ncc, right)
            _solve(factors[picture, mask], right)
            if right[0] < MIN_GAIN:
                break
            _move_corners(quad[0], right)
    return found, correlation


@compiled
def _max_distance(one, other):
    """Return the largest distance of a corner of two quads (4, 2) along u or v."""
    farthest = np.float32(0.0)
    for k in range(4):
        farthest = max(farthest, abs(one[k, 0] - other[k, 0]), abs(one[k, 1] - other[k, 1]))
    return farthest


@compiled
def distinct(quads, correlation, order, known, maximum, minimum, same_ratio):
    """Return the indexes (k,) of the first quads, by correlation, that differ from each other and `known`."""
    selected = np.empty(maximum, np.int64)
    n = 0
    for i in order:
        if n == maximum or correlation[i] < minimum:
            break
        side = 0.0
        for k in range(3):
            u, v = quads[i, k + 1, 0] - quads[i, k, 0], quads[i, k + 1, 1] - quads[i, k, 1]
            side += np.sqrt(u * u + v * v) / 3.0
        # Rotated quads differ.
        same = max(same_ratio * side, 1.0)
        fresh = True
        for j in range(len(known)):
            fresh = fresh and _max_distance(quads[i], known[j]) > same
        for j in range(n):
            fresh = fresh and _max_distance(quads[i], quads[selected[j]]) > same
        if fresh:
            selected[n] = i
            n += 1
    return selected[:n].copy()
