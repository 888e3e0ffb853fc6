"""The compiled loops of covers: the pieces of a square that light and model do not explain."""

import numpy as np

from tracker.compiled import compiled
from tracker.geometry.kernels import solve_positive
from tracker.marker.explanation.fields.kernels import (
    FIELDS,
    RING,
    WIDE,
    fields_ahead,
    lens_blur,
    picture_at,
    sample_fields,
    u_of,
)
from tracker.marker.explanation.kernels import SATURATED_GREY, correlation, walk
from tracker.marker.sampling.kernels import square_to_quad


@compiled
def _smoothed(rest, contrast):
    """What is left, in units of the contrast, each field with its eight neighbours."""
    n = len(rest)
    off, out = rest / contrast, np.empty((n, n))
    for r in range(n):
        for c in range(n):
            total = 0.0
            for i in range(r - 1, r + 2):
                for j in range(c - 1, c + 2):
                    total += off[min(max(i, 0), n - 1), min(max(j, 0), n - 1)]
            out[r, c] = total / 9.0
    return out


@compiled
def wrong_pieces(rest, contrast, ring, limit, least, labels):
    """Connected pieces of fields (n, n) whose neighbourhood is off by more than `limit` of the contrast.

    Fills `labels`: 0 for none, -1 for a piece that reaches into the `ring` fields along the border, k for the
    k-th piece inside. Pieces of fewer than `least` fields count for nothing. Returns the areas (k,) of the
    pieces inside, in fields.
    """
    n = len(rest)
    off = _smoothed(rest, contrast)
    areas = np.zeros(n * n, np.int64)
    stack = np.empty(n * n, np.int64)
    labels[:, :] = 0
    done = np.zeros((n, n), np.bool_)
    pieces = 0
    for start in range(n * n):
        if done[start // n, start % n] or not abs(off[start // n, start % n]) > limit:
            continue
        # The stack keeps the whole piece: `taken` walks through it while it grows.
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
        if count < least:
            continue
        if not outside:
            areas[pieces] = count
            pieces += 1
        for k in range(count):
            labels[stack[k] // n, stack[k] % n] = -1 if outside else pieces
    return areas[:pieces]


@compiled
def grown(mask):
    """A mask (n, n) and all neighbours of it."""
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
def _even_fit(at, seen, picture, chosen, solution):
    """A plane of light and one contrast (4,) for the chosen fields; False where there is no contrast."""
    a, g, row = np.zeros((4, 4)), np.zeros(4), np.ones(4)
    for i in range(len(seen)):
        if not chosen[i]:
            continue
        row[1], row[2], row[3] = at[i, 0], at[i, 1], picture[i]
        for p in range(4):
            g[p] += row[p] * seen[i]
            for q in range(4):
                a[p, q] += row[p] * row[q]
    return solve_positive(a, g, solution) and solution[3] > 1.0


@compiled
def _cost(at, seen, picture, solution, limit, near):
    """How far fields are off an even light, none by more than `limit` contrasts; fills which are `near`."""
    total = 0.0
    for i in range(len(seen)):
        value = solution[0] + solution[1] * at[i, 0] + solution[2] * at[i, 1] + solution[3] * picture[i]
        off = (seen[i] - value) / (limit * solution[3])
        # Where the sensor is full, brighter is as good.
        if seen[i] >= SATURATED_GREY and off < 0.0:
            off = 0.0
        near[i] = off * off < 1.0
        total += min(off * off, 1.0)
    return total


@compiled
def weights_of_a_part(seen, picture, angles, places, limit, weight):
    """Weights (WIDE, WIDE) of fields by the light of that part of the square whose light explains most of it.

    Where a third is covered, light that is fitted to all of it is wrong everywhere. Tried are the parts on
    one side of a line, and the whole, which stays if no part is better.
    """
    every = (WIDE + 1) // 2
    count = every * every
    at, values, ink = np.empty((count, 2)), np.empty(count), np.empty(count)
    for i in range(count):
        y, x = 2 * (i // every), 2 * (i % every)
        at[i, 0], at[i, 1] = u_of(x), u_of(y)
        values[i], ink[i] = seen[y, x], picture[y, x]
    weight[:, :] = 1.0
    chosen, near = np.ones(count, np.bool_), np.empty(count, np.bool_)
    solution, best = np.empty(4), np.empty(4)
    if not _even_fit(at, values, ink, chosen, solution):
        solution[:] = 0.0
        solution[3] = 1.0
    # A part must be better by more than a few fields that noise may bring.
    least = _cost(at, values, ink, solution, limit, near) - 0.03 * count
    found = False
    for k in range(angles * len(places)):
        angle, place = 2.0 * np.pi * (k % angles) / angles, places[k // angles]
        x, y = np.cos(angle), np.sin(angle)
        for i in range(count):
            chosen[i] = at[i, 0] * x + at[i, 1] * y < place
        if not _even_fit(at, values, ink, chosen, solution):
            continue
        if _cost(at, values, ink, solution, limit, near) >= least:
            continue
        # Once more by all that is near, wherever it lies.
        if _even_fit(at, values, ink, near, solution):
            cost = _cost(at, values, ink, solution, limit, near)
            if cost < least:
                least, found = cost, True
                best[:] = solution
    if not found:
        return False
    for r in range(WIDE):
        for c in range(WIDE):
            off = seen[r, c] - best[0] - best[1] * u_of(c) - best[2] * u_of(r) - best[3] * picture[r, c]
            if seen[r, c] >= SATURATED_GREY and off < 0.0:
                off = 0.0
            off /= limit * best[3]
            weight[r, c] = 1.0 / (1.0 + off * off) ** 2
    return True


@compiled
def contradicting(image, corners_px, layers, blurs, blur_px, field_px, light, inside, rounds, limit):
    """Fields of the largest piece in a square that contradicts a model; the part that is covered; likeness.

    The model's `layers`, as `Pictures` has them, are out of focus by `blur_px`, an sd. Fitted is the
    `light` (WIDE^2, n) alone, in so many rounds. `inside` (WIDE, WIDE): which fields are the square's.
    Covered is the part of it that pieces over its border hide, off by more than `limit` of the contrast. The
    likeness, -1..1, is that of the rest; -1 where there is nothing of the model.
    """
    to_px, corners, blur_here = np.empty(8), np.zeros((4, 2)), np.empty(3)
    square_to_quad(corners_px, to_px)
    corners[1, 0] = corners[2, 0] = corners[2, 1] = corners[3, 1] = 1.0
    seen, shown = sample_fields(image, to_px, corners), np.empty((6, WIDE, WIDE), np.float32)
    ahead = np.empty((2, 2))
    fields_ahead(to_px, corners, ahead)
    lens_blur(ahead, blur_px, blur_here)
    picture_at(layers, blurs, blur_here, ahead, shown)
    visible, even = inside.copy(), np.ones((WIDE * WIDE, 1))
    held, weight = np.ones((WIDE, WIDE)), np.ones((WIDE, WIDE))
    rest, lit = np.empty((WIDE, WIDE)), np.empty((WIDE, WIDE))
    contrast = walk(
        image, to_px, layers, blurs, corners, blur_here, held, visible, weight, light, even, field_px, rounds,
        0, seen, shown, rest, lit,
    )  # fmt: skip
    if not contrast > 0.0:
        return 0, 1.0, -1.0
    labels, end = np.zeros((FIELDS, FIELDS), np.int64), RING + FIELDS
    own_rest, own_lit = rest[RING:end, RING:end].copy(), lit[RING:end, RING:end].copy()
    areas = wrong_pieces(own_rest, own_lit, 0, limit, 1, labels)
    largest, hidden = 0, 0
    for area in areas:
        largest = max(largest, area)
    for r in range(FIELDS):
        for c in range(FIELDS):
            if labels[r, c] == -1:
                visible[RING + r, RING + c] = False
            hidden += not visible[RING + r, RING + c]
    weight[:, :] = 1.0
    contrast = walk(
        image, to_px, layers, blurs, corners, blur_here, held, visible, weight, light, even, field_px, 1, 0,
        seen, shown, rest, lit,
    )  # fmt: skip
    if not contrast > 0.0:
        return largest, hidden / FIELDS**2, -1.0
    # What is covered has no say, everything else the same: so it is a correlation.
    return largest, hidden / FIELDS**2, correlation(seen, rest, visible, light, 0.0)
