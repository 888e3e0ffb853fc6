"""Gauss-Newton fit of position, blur and illumination of a square, and its correlation with the model."""

import numpy as np

from tracker.camera.blur_kernels import clamp_blur
from tracker.compiled import compiled
from tracker.geometry.geometry_kernels import median, solve_positive
from tracker.marker.model import PAPER_RATIO
from tracker.marker.photometric_fit.grid_kernels import (
    GRID_CELLS,
    SAMPLING_VARIANCE,
    SQUARE_CELLS,
    cell_coordinate,
    cells_per_px,
    render_model,
    sample_cells,
)

PLACE, BLUR = 6, 3
SATURATED_GREY = 250.0
OUTLIER_CONTRAST = 0.2
MAX_STEP_PX = 0.7
MIN_BLUR_PX, MAX_BLUR_PX = 0.3, 4.5
CONVERGED_CELLS, CONVERGED_BLUR = 0.01, 0.02
# A correlation of fewer cells is meaningless.
MIN_COUNT = 40
# Background beyond the paper contributes a thirtieth of a cell at this distance, in sd of the blur.
FAR_SDS = 1.85
MIN_WEIGHT = 1e-3


@compiled
def _equations(values, rendered, offset_basis, gain_basis, gain, weight, free, a, g):
    """Fill the normal equations of offsets, contrast, and `free` parameters of position and blur."""
    n, m = offset_basis.shape[1], gain_basis.shape[1]
    size = n + m + free
    # Four cells at a time, so that each matrix entry is loaded and stored a quarter as often.
    rows, weights, many = np.zeros((4, size)), np.zeros(4), 0
    a[:, :] = 0.0
    g[:] = 0.0
    for i in range(GRID_CELLS * GRID_CELLS):
        r, c = i // GRID_CELLS, i % GRID_CELLS
        if weight[r, c] >= MIN_WEIGHT:
            row = rows[many]
            weights[many] = weight[r, c]
            many += 1
            for k in range(n):
                row[k] = offset_basis[i, k]
            for k in range(m):
                row[n + k] = gain_basis[i, k] * rendered[0, r, c]
            if free > 0:
                u, v = cell_coordinate(c), cell_coordinate(r)
                x, y = gain[r, c] * rendered[1, r, c], gain[r, c] * rendered[2, r, c]
                at = n + m
                row[at], row[at + 1], row[at + 2] = x, x * u, x * v
                row[at + 3], row[at + 4], row[at + 5] = y, y * u, y * v
                half = 0.5 * gain[r, c]
                row[at + 6], row[at + 7] = half * rendered[3, r, c], half * rendered[4, r, c]
                row[at + 8] = gain[r, c] * rendered[5, r, c]
            wr = weight[r, c] * values[r, c]
            for p in range(size):
                g[p] += wr * row[p]
        if many == 4 or (i == GRID_CELLS * GRID_CELLS - 1 and many > 0):
            for k in range(many, 4):
                weights[k] = 0.0
            r0, r1, r2, r3 = rows[0], rows[1], rows[2], rows[3]
            for p in range(size):
                w0, w1 = weights[0] * r0[p], weights[1] * r1[p]
                w2, w3 = weights[2] * r2[p], weights[3] * r3[p]
                line = a[p]
                for q in range(p + 1):
                    line[q] += w0 * r0[q] + w1 * r1[q] + w2 * r2[q] + w3 * r3[q]
            many = 0
    for p in range(size):
        for q in range(p + 1, size):
            a[p, q] = a[q, p]


@compiled
def _step(corners, blur, step, cell_px):
    """Move the corners and change the blur by a step; return whether it changed anything."""
    far = 0.0
    moved = np.empty((4, 2))
    for k in range(4):
        x, y = 2.0 * corners[k, 0] - 1.0, 2.0 * corners[k, 1] - 1.0
        moved[k, 0] = step[0] + step[1] * x + step[2] * y
        moved[k, 1] = step[3] + step[4] * x + step[5] * y
        far = max(far, abs(moved[k, 0]), abs(moved[k, 1]))
    share = min(1.0, MAX_STEP_PX / cell_px / max(far, 1e-9))
    for k in range(4):
        corners[k, 0] -= share * moved[k, 0] / SQUARE_CELLS
        corners[k, 1] -= share * moved[k, 1] / SQUARE_CELLS
    before = blur.copy()
    wide = max(blur[0], blur[1])
    for k in range(3):
        blur[k] += min(max(step[6 + k], -0.5 * wide - 0.3), wide + 0.3)
    minimum = SAMPLING_VARIANCE + (MIN_BLUR_PX / cell_px) ** 2
    maximum = SAMPLING_VARIANCE + (MAX_BLUR_PX / cell_px) ** 2
    clamp_blur(blur, minimum, maximum)
    changed = 0.0
    for k in range(3):
        changed = max(changed, abs(blur[k] - before[k]))
    return far > CONVERGED_CELLS or changed > CONVERGED_BLUR * wide


@compiled
def _predict(
    observed, rendered, offset_basis, gain_basis, solution, gain, visible, free, predicted, residual, lit
):
    """Fill prediction, residual and contrast of a solution; return the median contrast."""
    n, m = offset_basis.shape[1], gain_basis.shape[1]
    at, count = n + m, 0
    inside = np.empty(SQUARE_CELLS * SQUARE_CELLS)
    for r in range(GRID_CELLS):
        for c in range(GRID_CELLS):
            i, u, v = r * GRID_CELLS + c, cell_coordinate(c), cell_coordinate(r)
            low, high = 0.0, 0.0
            for k in range(n):
                low += offset_basis[i, k] * solution[k]
            for k in range(m):
                high += gain_basis[i, k] * solution[n + k]
            value = low + high * rendered[0, r, c]
            if free > 0:
                x = solution[at] + solution[at + 1] * u + solution[at + 2] * v
                y = solution[at + 3] + solution[at + 4] * u + solution[at + 5] * v
                bend = 0.5 * (solution[at + 6] * rendered[3, r, c] + solution[at + 7] * rendered[4, r, c])
                bend += solution[at + 8] * rendered[5, r, c]
                value += gain[r, c] * (x * rendered[1, r, c] + y * rendered[2, r, c] + bend)
            predicted[r, c], lit[r, c] = value, high
            left = observed[r, c] - value
            residual[r, c] = 0.0 if observed[r, c] >= SATURATED_GREY and left < 0.0 else left
            if abs(u) < 1.0 and abs(v) < 1.0 and visible[r, c]:
                inside[count] = high
                count += 1
    return median(inside, count) if count > 0 else 0.0


@compiled
def solve(
    image, h, layers, blurs, corners, blur, gain, visible, weight, offset_basis, gain_basis, cell_px, rounds,
    free, observed, rendered, residual, lit,
):  # fmt: skip
    """Fit position, blur and illumination in place; only illumination if nothing is `free`.

    Fills `observed`, `residual` and the contrast `lit` (GRID_CELLS, GRID_CELLS), and `rendered`
    (6, GRID_CELLS, GRID_CELLS). `gain` is the contrast of the previous iteration, bounded from below. Returns
    the median contrast; 0: there is none.
    """
    n, m = offset_basis.shape[1], gain_basis.shape[1]
    size = n + m + free
    a, g, solution = np.empty((size, size)), np.empty(size), np.empty(size)
    predicted, values = np.zeros((GRID_CELLS, GRID_CELLS)), np.empty((GRID_CELLS, GRID_CELLS))
    clear, ahead = np.empty((GRID_CELLS, GRID_CELLS), np.bool_), np.empty((2, 2))
    clear_of_beyond(blur, clear)
    for r in range(GRID_CELLS):
        for c in range(GRID_CELLS):
            if not (visible[r, c] and clear[r, c]):
                weight[r, c] = 0.0
    contrast = 0.0
    ended = False
    for iteration in range(rounds):
        if free > 0:
            sample_cells(image, h, corners, observed)
            cells_per_px(h, corners, ahead)
            render_model(layers, blurs, blur, ahead, rendered)
        for r in range(GRID_CELLS):
            for c in range(GRID_CELLS):
                one = observed[r, c]
                # A saturated pixel is compatible with any brighter prediction.
                values[r, c] = max(one, predicted[r, c]) if one >= SATURATED_GREY else one
        _equations(values, rendered, offset_basis, gain_basis, gain, weight, free, a, g)
        for p in range(size):
            a[p, p] = a[p, p] * (1.0 + 1e-6) + 1e-9
        if not solve_positive(a, g, solution):
            return 0.0
        contrast = _predict(
            observed,
            rendered,
            offset_basis,
            gain_basis,
            solution,
            gain,
            visible,
            free,
            predicted,
            residual,
            lit,
        )
        if not contrast > 1.0:
            return 0.0
        clear_of_beyond(blur, clear)
        for r in range(GRID_CELLS):
            for c in range(GRID_CELLS):
                off = residual[r, c] / (OUTLIER_CONTRAST * max(lit[r, c], 0.25 * contrast))
                weight[r, c] = 1.0 / (1.0 + off * off) ** 2 if visible[r, c] and clear[r, c] else 0.0
                gain[r, c] = max(lit[r, c], 0.05 * contrast)
        if ended or iteration == rounds - 1:
            break
        if free > 0:
            # After convergence, illumination is fitted once more.
            ended = not _step(corners, blur, solution[n + m :], cell_px)
    return contrast


@compiled
def clear_of_beyond(blur, clear):
    """Write into `clear` which cells a blur (3,), in cells^2, does not mix with the background."""
    edge = 1.0 + 2.0 * PAPER_RATIO
    max_u = edge - FAR_SDS * np.sqrt(max(blur[0], 0.0)) * 2.0 / SQUARE_CELLS
    max_v = edge - FAR_SDS * np.sqrt(max(blur[1], 0.0)) * 2.0 / SQUARE_CELLS
    for r in range(GRID_CELLS):
        for c in range(GRID_CELLS):
            clear[r, c] = abs(cell_coordinate(c)) < max_u and abs(cell_coordinate(r)) < max_v


@compiled
def correlation(observed, residual, chosen, offset_basis, noise):
    """Return the normalised cross-correlation of model and image over the `chosen` cells.

    The illumination is removed, and noise of this sd, in grey levels, is subtracted from both variances.
    """
    n = offset_basis.shape[1]
    a, g, solution = np.zeros((n, n)), np.zeros(n), np.empty(n)
    count, left = 0, 0.0
    for r in range(GRID_CELLS):
        for c in range(GRID_CELLS):
            if not chosen[r, c]:
                continue
            count += 1
            left += residual[r, c] ** 2
            i = r * GRID_CELLS + c
            for p in range(n):
                g[p] += offset_basis[i, p] * observed[r, c]
                for q in range(n):
                    a[p, q] += offset_basis[i, p] * offset_basis[i, q]
    if count < MIN_COUNT:
        return 0.0
    for p in range(n):
        a[p, p] = a[p, p] * (1.0 + 1e-9) + 1e-9
    if not solve_positive(a, g, solution):
        return 0.0
    total_energy = 0.0
    for r in range(GRID_CELLS):
        for c in range(GRID_CELLS):
            if chosen[r, c]:
                value = observed[r, c]
                for p in range(n):
                    value -= offset_basis[r * GRID_CELLS + c, p] * solution[p]
                total_energy += value * value
    left, total_energy = max(left - count * noise * noise, 0.0), total_energy - count * noise * noise
    return np.sqrt(max(1.0 - left / total_energy, 0.0)) if total_energy > 0.0 else 0.0
