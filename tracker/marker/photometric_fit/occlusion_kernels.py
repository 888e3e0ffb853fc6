"""Connected components of large residuals after the fit of model and illumination."""

import numpy as np

from tracker.compiled import compiled
from tracker.geometry.geometry_kernels import copy_vector, solve_positive
from tracker.marker.photometric_fit.fit_kernels import SATURATED_GREY
from tracker.marker.photometric_fit.grid_kernels import GRID_CELLS, cell_coordinate


@compiled
def _smoothed(residual, contrast):
    """Return the residuals in units of the contrast, averaged over 3 x 3 cells."""
    n = len(residual)
    off, out = np.empty((n, n)), np.empty((n, n))
    for r in range(n):
        for c in range(n):
            off[r, c] = residual[r, c] / contrast[r, c]
    for r in range(n):
        for c in range(n):
            total = 0.0
            for i in range(r - 1, r + 2):
                for j in range(c - 1, c + 2):
                    total += off[min(max(i, 0), n - 1), min(max(j, 0), n - 1)]
            out[r, c] = total / 9.0
    return out


@compiled
def residual_components(residual, contrast, ring, limit, minimum, labels):
    """Label connected components of cells (n, n) whose smoothed residual exceeds `limit` of the contrast.

    Fills `labels`: 0 for none, -1 for a component that reaches the `ring` cells along the border, k for the
    k-th component inside. Components of fewer than `minimum` cells are dropped. Returns the areas (k,)
    inside, in cells.
    """
    n = len(residual)
    off = _smoothed(residual, contrast)
    areas = np.zeros(n * n, np.int64)
    stack = np.empty(n * n, np.int64)
    labels[:, :] = 0
    done = np.zeros((n, n), np.bool_)
    pieces = 0
    for start in range(n * n):
        if done[start // n, start % n] or not abs(off[start // n, start % n]) > limit:
            continue
        # The stack holds the whole component; `taken` iterates over it while it grows.
        stack[0], count, taken = start, 1, 0
        done[start // n, start % n] = True
        outside = False
        while taken < count:
            r, c = stack[taken] // n, stack[taken] % n
            taken += 1
            outside = outside or min(r, c) <= ring or max(r, c) >= n - 1 - ring
            for i in range(max(r - 1, 0), min(r + 2, n)):
                for j in range(max(c - 1, 0), min(c + 2, n)):
                    if not done[i, j] and abs(off[i, j]) > limit:
                        done[i, j] = True
                        stack[count] = i * n + j
                        count += 1
        if count < minimum:
            continue
        if not outside:
            areas[pieces] = count
            pieces += 1
        for k in range(count):
            labels[stack[k] // n, stack[k] % n] = -1 if outside else pieces
    return areas[:pieces]


@compiled
def dilated(mask):
    """Return a mask (n, n) dilated by one cell, 8-connected."""
    n = len(mask)
    out = np.zeros((n, n), np.bool_)
    for r in range(n):
        for c in range(n):
            if mask[r, c]:
                for i in range(max(r - 1, 0), min(r + 2, n)):
                    for j in range(max(c - 1, 0), min(c + 2, n)):
                        out[i, j] = True
    return out


@compiled
def _planar_fit(at, observed, picture, chosen, solution):
    """Fit planar illumination and one contrast (4,) to the chosen cells; False where there is no contrast."""
    a, g, row = np.zeros((4, 4)), np.zeros(4), np.ones(4)
    for i in range(len(observed)):
        if not chosen[i]:
            continue
        row[1], row[2], row[3] = at[i, 0], at[i, 1], picture[i]
        for p in range(4):
            g[p] += row[p] * observed[i]
            for q in range(4):
                a[p, q] += row[p] * row[q]
    return solve_positive(a, g, solution) and solution[3] > 1.0


@compiled
def _cost(at, observed, picture, solution, limit, near):
    """Return the truncated squared residuals in units of `limit` contrasts; marks inliers in `near`."""
    total = 0.0
    for i in range(len(observed)):
        value = solution[0] + solution[1] * at[i, 0] + solution[2] * at[i, 1] + solution[3] * picture[i]
        off = (observed[i] - value) / (limit * solution[3])
        # A saturated pixel is compatible with any brighter prediction.
        if observed[i] >= SATURATED_GREY and off < 0.0:
            off = 0.0
        near[i] = off * off < 1.0
        total += min(off * off, 1.0)
    return total


@compiled
def half_plane_weights(observed, picture, angles, places, limit, weight):
    """Compute robust weights from the half plane whose illumination has most inlier cells.

    `weight` is (GRID_CELLS, GRID_CELLS). Where a third is occluded, illumination fitted to all cells is wrong
    everywhere. Half planes are tried, and the whole square, which is used unless a half plane is better.
    """
    every = (GRID_CELLS + 1) // 2
    count = every * every
    at, values, ink = np.empty((count, 2)), np.empty(count), np.empty(count)
    for i in range(count):
        y, x = 2 * (i // every), 2 * (i % every)
        at[i, 0], at[i, 1] = cell_coordinate(x), cell_coordinate(y)
        values[i], ink[i] = observed[y, x], picture[y, x]
    weight[:, :] = 1.0
    chosen, near = np.ones(count, np.bool_), np.empty(count, np.bool_)
    solution, best = np.empty(4), np.empty(4)
    if not _planar_fit(at, values, ink, chosen, solution):
        solution[:] = 0.0
        solution[3] = 1.0
    # A half plane must be better by more than a few cells that noise may change.
    minimum = _cost(at, values, ink, solution, limit, near) - 0.03 * count
    found = False
    for k in range(angles * len(places)):
        angle, place = 2.0 * np.pi * (k % angles) / angles, places[k // angles]
        x, y = np.cos(angle), np.sin(angle)
        for i in range(count):
            chosen[i] = at[i, 0] * x + at[i, 1] * y < place
        if not _planar_fit(at, values, ink, chosen, solution):
            continue
        if _cost(at, values, ink, solution, limit, near) >= minimum:
            continue
        # Refit to all inliers, wherever they lie.
        if _planar_fit(at, values, ink, near, solution):
            cost = _cost(at, values, ink, solution, limit, near)
            if cost < minimum:
                minimum, found = cost, True
                copy_vector(solution, best)
    if not found:
        return False
    for r in range(GRID_CELLS):
        for c in range(GRID_CELLS):
            off = (
                observed[r, c]
                - best[0]
                - best[1] * cell_coordinate(c)
                - best[2] * cell_coordinate(r)
                - best[3] * picture[r, c]
            )
            if observed[r, c] >= SATURATED_GREY and off < 0.0:
                off = 0.0
            off /= limit * best[3]
            weight[r, c] = 1.0 / (1.0 + off * off) ** 2
    return True
