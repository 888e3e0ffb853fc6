"""The compiled loops of the explanation: the fit of place, blur and light."""

import numpy as np

from tracker.camera.blur.kernels import keep_within
from tracker.compiled import compiled
from tracker.geometry.kernels import solve_positive
from tracker.marker.explanation.fields.kernels import (
    FIELDS,
    SPREAD,
    WIDE,
    fields_ahead,
    picture_at,
    sample_fields,
    u_of,
)
from tracker.marker.model import PAPER_RATIO

PLACE, BLUR = 6, 3
SATURATED_GREY = 250.0
OUTLIER_CONTRAST = 0.2
MAX_STEP_PX = 0.7
MIN_BLUR_PX, MAX_BLUR_PX = 0.3, 4.5
SETTLED_FIELDS, SETTLED_BLUR = 0.01, 0.02
# Fewer fields than this are like anything.
MIN_COUNT = 40
# What lies beyond the paper, so many sd of the blur away, is a thirtieth of a field.
FAR_SDS = 1.85
MIN_WEIGHT = 1e-3


@compiled
def _equations(values, shown, light, gains, gain, weight, free, a, g):
    """Normal equations of light, contrast, and `free` numbers of place and blur."""
    n, m = light.shape[1], gains.shape[1]
    size = n + m + free
    # Four fields at a time, so that each number of the matrix is fetched and stored a quarter as often.
    rows, weights, many = np.zeros((4, size)), np.zeros(4), 0
    a[:, :] = 0.0
    g[:] = 0.0
    for i in range(WIDE * WIDE):
        r, c = i // WIDE, i % WIDE
        if weight[r, c] >= MIN_WEIGHT:
            row = rows[many]
            weights[many] = weight[r, c]
            many += 1
            for k in range(n):
                row[k] = light[i, k]
            for k in range(m):
                row[n + k] = gains[i, k] * shown[0, r, c]
            if free > 0:
                u, v = u_of(c), u_of(r)
                x, y = gain[r, c] * shown[1, r, c], gain[r, c] * shown[2, r, c]
                at = n + m
                row[at], row[at + 1], row[at + 2] = x, x * u, x * v
                row[at + 3], row[at + 4], row[at + 5] = y, y * u, y * v
                half = 0.5 * gain[r, c]
                row[at + 6], row[at + 7] = half * shown[3, r, c], half * shown[4, r, c]
                row[at + 8] = gain[r, c] * shown[5, r, c]
            wr = weight[r, c] * values[r, c]
            for p in range(size):
                g[p] += wr * row[p]
        if many == 4 or (i == WIDE * WIDE - 1 and many > 0):
            weights[many:] = 0.0
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
def _step(corners, blur, step, field_px):
    """Move the corners and change the blur by what the fit says; whether that changes anything."""
    far = 0.0
    moved = np.empty((4, 2))
    for k in range(4):
        x, y = 2.0 * corners[k, 0] - 1.0, 2.0 * corners[k, 1] - 1.0
        moved[k, 0] = step[0] + step[1] * x + step[2] * y
        moved[k, 1] = step[3] + step[4] * x + step[5] * y
        far = max(far, abs(moved[k, 0]), abs(moved[k, 1]))
    share = min(1.0, MAX_STEP_PX / field_px / max(far, 1e-9))
    for k in range(4):
        corners[k, 0] -= share * moved[k, 0] / FIELDS
        corners[k, 1] -= share * moved[k, 1] / FIELDS
    before = blur.copy()
    wide = max(blur[0], blur[1])
    for k in range(3):
        blur[k] += min(max(step[6 + k], -0.5 * wide - 0.3), wide + 0.3)
    least = SPREAD + (MIN_BLUR_PX / field_px) ** 2
    most = SPREAD + (MAX_BLUR_PX / field_px) ** 2
    keep_within(blur, least, most)
    changed = np.abs(blur - before).max() / wide
    return far > SETTLED_FIELDS or changed > SETTLED_BLUR


@compiled
def _laid_over(seen, shown, light, gains, solution, gain, visible, free, predicted, rest, lit):
    """Fill what a solution predicts, what it leaves and its contrast, whose median it returns."""
    n, m = light.shape[1], gains.shape[1]
    at, count = n + m, 0
    inside = np.empty(FIELDS * FIELDS)
    for r in range(WIDE):
        for c in range(WIDE):
            i, u, v = r * WIDE + c, u_of(c), u_of(r)
            low, high = 0.0, 0.0
            for k in range(n):
                low += light[i, k] * solution[k]
            for k in range(m):
                high += gains[i, k] * solution[n + k]
            value = low + high * shown[0, r, c]
            if free > 0:
                x = solution[at] + solution[at + 1] * u + solution[at + 2] * v
                y = solution[at + 3] + solution[at + 4] * u + solution[at + 5] * v
                bend = 0.5 * (solution[at + 6] * shown[3, r, c] + solution[at + 7] * shown[4, r, c])
                bend += solution[at + 8] * shown[5, r, c]
                value += gain[r, c] * (x * shown[1, r, c] + y * shown[2, r, c] + bend)
            predicted[r, c], lit[r, c] = value, high
            left = seen[r, c] - value
            rest[r, c] = 0.0 if seen[r, c] >= SATURATED_GREY and left < 0.0 else left
            if abs(u) < 1.0 and abs(v) < 1.0 and visible[r, c]:
                inside[count] = high
                count += 1
    return np.median(inside[:count]) if count > 0 else 0.0


@compiled
def walk(
    image, h, layers, blurs, corners, blur, gain, visible, weight, light, gains, field_px, rounds, free,
    seen, shown, rest, lit,
):  # fmt: skip
    """Gauss-Newton of place, blur and light, in place; of light alone, to what is `seen`, if none is `free`.

    Fills `seen`, what is left as `rest` and the contrast as `lit` (WIDE, WIDE), `shown` (6, WIDE, WIDE).
    `gain` is the contrast, held up where there is none, from walk to walk. Returns its median; 0: there is
    none.
    """
    n, m = light.shape[1], gains.shape[1]
    size = n + m + free
    a, g, solution = np.empty((size, size)), np.empty(size), np.empty(size)
    predicted, values = np.zeros((WIDE, WIDE)), np.empty((WIDE, WIDE))
    clear, ahead = np.empty((WIDE, WIDE), np.bool_), np.empty((2, 2))
    clear_of_beyond(blur, clear)
    for r in range(WIDE):
        for c in range(WIDE):
            if not (visible[r, c] and clear[r, c]):
                weight[r, c] = 0.0
    contrast = 0.0
    ended = False
    for turn in range(rounds):
        if free > 0:
            seen[:, :] = sample_fields(image, h, corners)
            fields_ahead(h, corners, ahead)
            picture_at(layers, blurs, blur, ahead, shown)
        for r in range(WIDE):
            for c in range(WIDE):
                one = seen[r, c]
                # Where the sensor is full, brighter is as good.
                values[r, c] = max(one, predicted[r, c]) if one >= SATURATED_GREY else one
        _equations(values, shown, light, gains, gain, weight, free, a, g)
        for p in range(size):
            a[p, p] = a[p, p] * (1.0 + 1e-6) + 1e-9
        if not solve_positive(a, g, solution):
            return 0.0
        contrast = _laid_over(seen, shown, light, gains, solution, gain, visible, free, predicted, rest, lit)
        if not contrast > 1.0:
            return 0.0
        clear_of_beyond(blur, clear)
        for r in range(WIDE):
            for c in range(WIDE):
                off = rest[r, c] / (OUTLIER_CONTRAST * max(lit[r, c], 0.25 * contrast))
                weight[r, c] = 1.0 / (1.0 + off * off) ** 2 if visible[r, c] and clear[r, c] else 0.0
                gain[r, c] = max(lit[r, c], 0.05 * contrast)
        if ended or turn == rounds - 1:
            break
        if free > 0:
            # What changes nothing ends the walk after the light has been fitted once more.
            ended = not _step(corners, blur, solution[n + m :], field_px)
    return contrast


@compiled
def clear_of_beyond(blur, clear):
    """Into `clear` (WIDE, WIDE): where a blur (3,), in fields, brings in little from beyond the paper."""
    edge = 1.0 + 2.0 * PAPER_RATIO
    max_u = edge - FAR_SDS * np.sqrt(max(blur[0], 0.0)) * 2.0 / FIELDS
    max_v = edge - FAR_SDS * np.sqrt(max(blur[1], 0.0)) * 2.0 / FIELDS
    for r in range(WIDE):
        for c in range(WIDE):
            clear[r, c] = abs(u_of(c)) < max_u and abs(u_of(r)) < max_v


@compiled
def correlation(seen, rest, chosen, light, noise):
    """Root of the part that the model explains of what light alone leaves over, where `chosen`.

    What noise of this sd, in grey levels, adds to both is taken out.
    """
    n = light.shape[1]
    a, g, solution = np.zeros((n, n)), np.zeros(n), np.empty(n)
    count, left = 0, 0.0
    for r in range(WIDE):
        for c in range(WIDE):
            if not chosen[r, c]:
                continue
            count += 1
            left += rest[r, c] ** 2
            i = r * WIDE + c
            for p in range(n):
                g[p] += light[i, p] * seen[r, c]
                for q in range(n):
                    a[p, q] += light[i, p] * light[i, q]
    if count < MIN_COUNT:
        return 0.0
    for p in range(n):
        a[p, p] = a[p, p] * (1.0 + 1e-9) + 1e-9
    if not solve_positive(a, g, solution):
        return 0.0
    whole = 0.0
    for r in range(WIDE):
        for c in range(WIDE):
            if chosen[r, c]:
                value = seen[r, c]
                for p in range(n):
                    value -= light[r * WIDE + c, p] * solution[p]
                whole += value * value
    left, whole = max(left - count * noise * noise, 0.0), whole - count * noise * noise
    return np.sqrt(max(1.0 - left / whole, 0.0)) if whole > 0.0 else 0.0
