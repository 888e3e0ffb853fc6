"""The compiled loops of the whole-shape fit; their types are those of their calls."""

import numpy as np

from tracker.appearance.light.kernels import (
    AROUND,
    BLUR,
    LIGHT,
    PLANE,
    RESPONSE,
    cell_of,
    even_light,
    hold_light,
    light_up,
    shaped_by,
)
from tracker.appearance.picture.kernels import predict
from tracker.compiled import compiled
from tracker.geometry.kernels import solve_positive, turn_by

EVEN = LIGHT + PLANE
# A camera's response is bent by so much; gamma 2.2 is half.
RESPONSE_SD = 0.3
# A step that changes what it changes by less than a seventh of its standard deviation ends the fit.
SETTLED_SD2 = 0.02


@compiled
def _even_equations(rows, at, values, lit, numbers, scale, cut, a, g, sizes):
    """Gauss-Newton's matrix (16, 16) and right side (16,) in even light; returns robust cost and weight."""
    a[:, :] = 0.0
    g[:] = 0.0
    row = np.empty(EVEN)
    cost, total = 0.0, 0.0
    unit = 1.0 / (cut * scale) ** 2
    response = numbers[RESPONSE]
    for i in range(len(values)):
        s, u, v, contrast = rows[i, 0], at[i, 0], at[i, 1], lit[i, 1]
        shaped = shaped_by(s, response)
        r = values[i] - lit[i, 0] - contrast * shaped
        sizes[i] = abs(r)
        z = r * r * unit
        # Geman and McClure: what is far off belongs to something else and has no say.
        w = 1.0 / (1.0 + z)
        cost += z * w
        w *= w
        total += w
        slope = contrast * (1.0 + response * (1.0 - 2.0 * s))
        for k in range(9):
            row[k] = slope * rows[i, 1 + k]
        row[RESPONSE] = contrast * s * (1.0 - s)
        row[LIGHT], row[LIGHT + 1], row[LIGHT + 2] = 1.0, u, v
        row[LIGHT + 3], row[LIGHT + 4], row[LIGHT + 5] = shaped, shaped * u, shaped * v
        wr = w * r
        for m in range(EVEN):
            wm = w * row[m]
            g[m] += wr * row[m]
            # The whole square, although it is symmetric: rows of fixed length are added four at a time.
            for k in range(EVEN):
                a[m, k] += wm * row[k]
    return cost / unit, total


@compiled
def _uneven_equations(rows, at, values, lit, numbers, nodes, scale, cut, a, g, sizes):
    """The same in uneven light, of which each pixel sees nine nodes."""
    a[:, :] = 0.0
    g[:] = 0.0
    row, index, weight = np.empty(LIGHT), np.empty(AROUND, np.int64), np.empty(AROUND)
    where, share = np.empty(2 * AROUND, np.int64), np.empty(2 * AROUND)
    cost, total, both = 0.0, 0.0, nodes * nodes
    unit = 1.0 / (cut * scale) ** 2
    response = numbers[RESPONSE]
    for i in range(len(values)):
        s, contrast = rows[i, 0], lit[i, 1]
        shaped = shaped_by(s, response)
        r = values[i] - lit[i, 0] - contrast * shaped
        sizes[i] = abs(r)
        z = r * r * unit
        w = 1.0 / (1.0 + z)
        cost += z * w
        w *= w
        total += w
        slope = contrast * (1.0 + response * (1.0 - 2.0 * s))
        for k in range(9):
            row[k] = slope * rows[i, 1 + k]
        row[RESPONSE] = contrast * s * (1.0 - s)
        cell_of(at[i, 0], at[i, 1], nodes, index, weight)
        for k in range(AROUND):
            where[k], share[k] = LIGHT + index[k], weight[k]
            where[AROUND + k], share[AROUND + k] = LIGHT + both + index[k], weight[k] * shaped
        wr = w * r
        for m in range(LIGHT):
            wm = w * row[m]
            g[m] += wr * row[m]
            for k in range(LIGHT):
                a[m, k] += wm * row[k]
            for k in range(2 * AROUND):
                a[m, where[k]] += wm * share[k]
        for m in range(2 * AROUND):
            g[where[m]] += wr * share[m]
            for k in range(2 * AROUND):
                a[where[m], where[k]] += w * share[m] * share[k]
    for m in range(LIGHT):
        for k in range(LIGHT, len(g)):
            a[k, m] = a[m, k]
    return cost / unit, total


@compiled
def _equations(rows, at, values, lit, numbers, nodes, scale, cut, a, g, sizes):
    light_up(at, numbers, nodes, lit)
    if nodes == 0:
        return _even_equations(rows, at, values, lit, numbers, scale, cut, a, g, sizes)
    return _uneven_equations(rows, at, values, lit, numbers, nodes, scale, cut, a, g, sizes)


@compiled
def _typical(sizes):
    """The sd of normally distributed residuals of these sizes, from at most 600 of them."""
    every = len(sizes) // 600 + 1
    return 1.4826 * np.median(sizes[::every])


@compiled
def corner_motion_px(rotation, translation, lens, side_mm, step):
    """The farthest that a corner moves in the image, in px, when the pose is moved by a step (6,)."""
    farthest = 0.0
    for k in range(4):
        x = 0.5 * side_mm if k in (1, 2) else -0.5 * side_mm
        y = 0.5 * side_mm if k in (0, 1) else -0.5 * side_mm
        ax = rotation[0, 0] * x + rotation[0, 1] * y
        ay = rotation[1, 0] * x + rotation[1, 1] * y
        az = rotation[2, 0] * x + rotation[2, 1] * y
        vx = step[0] + step[4] * az - step[5] * ay
        vy = step[1] + step[5] * ax - step[3] * az
        vz = step[2] + step[3] * ay - step[4] * ax
        z = translation[2] + az
        du = lens[0] * (vx - (translation[0] + ax) / z * vz) / z
        dv = lens[1] * (vy - (translation[1] + ay) / z * vz) / z
        farthest = max(farthest, np.sqrt(du * du + dv * dv))
    return farthest


@compiled
def _hold(a, g, numbers, scale, nodes):
    """Add to the normal equations what is known beforehand; returns what it costs."""
    for m in range(3):
        a[BLUR + m, BLUR + m] += (scale / (1.0 + numbers[BLUR] + numbers[BLUR + 1])) ** 2
    straight = (scale / RESPONSE_SD) ** 2
    a[RESPONSE, RESPONSE] += straight
    g[RESPONSE] -= straight * numbers[RESPONSE]
    return straight * numbers[RESPONSE] ** 2 + hold_light(a, g, numbers, scale, nodes)


@compiled
def _advance(rotation, translation, numbers, step, share, least_blur):
    """Move by a share of a step, in place; False where that turns the face away."""
    before = numbers[BLUR : BLUR + 3].copy()
    for k in range(3):
        translation[k] += share * step[k]
    turn_by(rotation, share * step[3:6])
    for k in range(6, len(numbers)):
        numbers[k] += share * step[k]
    _keep_blur(numbers[BLUR : BLUR + 3], before, least_blur)
    numbers[RESPONSE] = min(max(numbers[RESPONSE], -0.9), 0.9)
    facing = (
        rotation[0, 2] * translation[0] + rotation[1, 2] * translation[1] + rotation[2, 2] * translation[2]
    )
    return facing < 0.0


@compiled
def _weighed(rows, at, values, lit, numbers, nodes, scale, cut, a, g, sizes):
    """The normal equations with what is known beforehand in them; returns their cost and weight."""
    cost, total = _equations(rows, at, values, lit, numbers, nodes, scale, cut, a, g, sizes)
    return cost + _hold(a, g, numbers, scale, nodes), total


@compiled
def _solved(a, g, damping, step, rotation, translation, lens, side_mm, most_px):
    """The damped step, what it promises in squared grey levels, and the share of it that may be gone.

    A share of 0 means that there is no step.
    """
    damped = a.copy()
    for m in range(len(g)):
        damped[m, m] *= 1.0 + damping
    if not solve_positive(damped, g, step):
        return 0.0, 0.0
    gain = 0.0
    for m in range(len(g)):
        gain += g[m] * step[m]
    moved = corner_motion_px(rotation, translation, lens, side_mm, step)
    turned = np.sqrt(step[3] ** 2 + step[4] ** 2 + step[5] ** 2)
    if not np.isfinite(moved):
        return 0.0, 0.0
    return gain, min(most_px / max(moved, 1e-12), 0.4 / max(turned, 1e-12), 1.0)


@compiled
def whole_fit(
    rays, values, lens, rotation, translation, side_mm, tex, numbers, nodes, least_blur, rounds, cut, most_px
):  # fmt: skip
    """Fit pose, blur, response and light to the pixels, in place, by damped Gauss-Newton.

    `numbers`: of blur, response and light, in and out; (16,) with 0 nodes, whose light is found first, else
    (10 + 2 nodes^2,), whose light is given. Returns the matrix at the end with what is known beforehand in
    it, the scale of the residuals in grey levels, the mean weight, how many pixels (0: it failed) and rounds.
    """
    n, count = len(values), len(numbers)
    rows, at, lit, sizes = np.zeros((n, 10)), np.empty((n, 2)), np.empty((n, 2)), np.empty(n)
    a, g, step = np.zeros((count, count)), np.zeros(count), np.zeros(count)
    old_rotation, old_translation, old = rotation.copy(), translation.copy(), numbers.copy()
    failed = (a, 0.0, 0.0, 0, 0)
    blur = numbers[BLUR : BLUR + 3]
    if n < 2 * EVEN:
        return failed
    if not predict(rays, lens, rotation, translation, side_mm, blur, tex, rows, at, True):
        return failed
    if nodes == 0 and not even_light(rows, at, values, numbers, 2.0, cut):
        return failed
    # Once with any scale, for the sizes of the residuals; then with theirs.
    _equations(rows, at, values, lit, numbers, nodes, 1.0, cut, a, g, sizes)
    scale = max(_typical(sizes), 0.5)
    cost, total = _weighed(rows, at, values, lit, numbers, nodes, scale, cut, a, g, sizes)
    old_a, old_g = a.copy(), g.copy()
    damping, done = 1e-6, 0
    for _ in range(rounds):
        done += 1
        old_a[:, :], old_g[:] = a, g
        gain, share = _solved(a, g, damping, step, rotation, translation, lens, side_mm, most_px)
        if share == 0.0:
            return failed
        old_rotation[:, :], old_translation[:], old[:] = rotation, translation, numbers
        new_cost = np.inf
        if _advance(rotation, translation, numbers, step, share, least_blur) and predict(
            rays, lens, rotation, translation, side_mm, blur, tex, rows, at, True
        ):
            new_cost, total = _weighed(rows, at, values, lit, numbers, nodes, scale, cut, a, g, sizes)
        if not new_cost <= cost * (1.0 + 1e-9):
            rotation[:, :], translation[:], numbers[:] = old_rotation, old_translation, old
            a[:, :], g[:] = old_a, old_g
            if damping > 1.0:
                break
            damping = max(100.0 * damping, 1e-2)
            continue
        damping, cost = 0.1 * damping, new_cost
        if gain < SETTLED_SD2 * scale * scale and share == 1.0:
            break
        typical = max(_typical(sizes), 0.3)
        if abs(typical - scale) > 0.1 * scale:
            scale = typical
            cost, total = _weighed(rows, at, values, lit, numbers, nodes, scale, cut, a, g, sizes)
    return a, scale, total / n, n, done


@compiled
def robust_cost(rays, values, lens, rotation, translation, side_mm, tex, numbers, nodes, scale, cut):
    """The robust sum of squared residuals of a fit, in units of `scale`; infinite where it cannot be seen."""
    n = len(values)
    rows, at, lit = np.zeros((n, 10)), np.empty((n, 2)), np.empty((n, 2))
    blur = numbers[BLUR : BLUR + 3]
    if not predict(rays, lens, rotation, translation, side_mm, blur, tex, rows, at, False):
        return np.inf
    light_up(at, numbers, nodes, lit)
    cost, unit = 0.0, 1.0 / (cut * scale) ** 2
    for i in range(n):
        r = values[i] - lit[i, 0] - lit[i, 1] * shaped_by(rows[i, 0], numbers[RESPONSE])
        cost += r * r * unit / (1.0 + r * r * unit)
    return cost * cut * cut


@compiled
def _keep_blur(blur, before, least):
    """Keep a blur (3,) between `least` px^2 and four times what it was, in every direction."""
    most = 4.0 * max(before[0], before[1])
    mean, half = 0.5 * (blur[0] + blur[1]), np.sqrt((0.5 * (blur[0] - blur[1])) ** 2 + blur[2] ** 2)
    larger = min(max(mean + half, least), most)
    smaller = min(max(mean - half, least), most)
    angle = 0.5 * np.arctan2(2.0 * blur[2], blur[0] - blur[1])
    c, s = np.cos(angle), np.sin(angle)
    blur[0] = larger * c * c + smaller * s * s
    blur[1] = larger * s * s + smaller * c * c
    blur[2] = (larger - smaller) * c * s
