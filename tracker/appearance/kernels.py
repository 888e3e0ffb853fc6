"""The compiled loops of the whole-shape fit; their types are those of their calls."""

import numpy as np

from tracker.appearance.equations.kernels import EVEN, equations, hold, trust, typical_sd, weighed_pixel
from tracker.appearance.light.fields.kernels import (
    AROUND,
    MAX_SHARES,
    NODES_REACH,
    PLAIN,
    band_of,
    fields_first,
    light_up,
    shared_numbers,
    shares_of,
)
from tracker.appearance.light.kernels import BLUR, LIGHT, RESPONSE, even_light, shaped_by
from tracker.appearance.picture.kernels import predict
from tracker.camera.blur.kernels import keep_within
from tracker.compiled import compiled
from tracker.geometry.kernels import solve_banded, turn_by

# A step that lowered the cost by less was within a standard deviation, and the next is within a tenth.
SETTLED_COST_SD2 = 0.3
MIN_ANSWER_RATIO = 0.3
# In one step the blur's variance grows to no more than so many times what it was.
MAX_WIDENED = 4.0


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
def _advance(rotation, translation, numbers, step, share, min_blur):
    """Move by a share of a step, in place; False where that turns the face away."""
    blur = numbers[BLUR : BLUR + 3]
    max_blur = MAX_WIDENED * max(blur[0], blur[1])
    for k in range(3):
        translation[k] += share * step[k]
    turn_by(rotation, share * step[3:6])
    for k in range(6, len(numbers)):
        numbers[k] += share * step[k]
    keep_within(blur, min_blur, max_blur)
    numbers[RESPONSE] = min(max(numbers[RESPONSE], -0.9), 0.9)
    facing = (
        rotation[0, 2] * translation[0] + rotation[1, 2] * translation[1] + rotation[2, 2] * translation[2]
    )
    return facing < 0.0


@compiled
def _solved(a, g, damping, order, band, step, rotation, translation, lens, side_mm, max_px):
    """The damped step, what it promises in squared grey levels, and the share of it that may be gone.

    It is solved for in this order of the numbers, with their band in it. A share of 0: there is no step.
    """
    n = len(g)
    damped, sides, solved = np.empty((n, n)), np.empty(n), np.empty(n)
    for m in range(n):
        sides[m] = g[order[m]]
        for k in range(m, n):
            damped[m, k] = a[order[m], order[k]]
        damped[m, m] *= 1.0 + damping
    if not solve_banded(damped, band, sides, solved):
        return 0.0, 0.0
    gain = 0.0
    for m in range(n):
        step[order[m]] = solved[m]
        gain += sides[m] * solved[m]
    moved = corner_motion_px(rotation, translation, lens, side_mm, step)
    turned = np.sqrt(step[3] ** 2 + step[4] ** 2 + step[5] ** 2)
    if not np.isfinite(moved):
        return 0.0, 0.0
    return gain, min(max_px / max(moved, 1e-12), 0.4 / max(turned, 1e-12), 1.0)


@compiled
def _cost(rows, values, lit, numbers, light, own, scale, cut, room):
    """The robust sum of squared residuals, in squared grey levels, with that of what is known beforehand.

    `room`: a matrix (n, n) and a vector (n,) that are written over.
    """
    cost, unit = 0.0, 1.0 / (cut * scale) ** 2
    for i in range(len(values)):
        r = values[i] - lit[i, 0] - lit[i, 1] * shaped_by(rows[0, i], numbers[RESPONSE])
        z = r * r * own[i] * unit
        cost += z / (1.0 + z)
    return cost / unit + hold(room[0], room[1], numbers, scale, light)


@compiled
def whole_fit(
    rays, values, lens, rotation, translation, side_mm, tex, numbers, light, scale, min_blur, rounds, cut,
    max_px, settled
):  # fmt: skip
    """Fit pose, blur, response and light to the pixels, in place, by damped Gauss-Newton.

    `numbers`: of blur, response and light, in and out; as many as the light has. `scale` of
    the residuals in grey levels, as far as it is known; where it is 0, even light is found first too. A step
    that promises to lower the cost by less than `settled`, in units of the residuals' variance, is the last.
    Returns the matrix at the end with what is known beforehand in it, the scale, the mean weight, whether it
    is a fit, and what the pixels saw when last looked at: `rows`, `at`, `lit` and `own`.
    """
    n, count = len(values), len(numbers)
    rows, at, lit, own = np.empty((10, n)), np.empty((n, 2)), np.empty((n, 2)), np.ones(n)
    seen = (rows, at, lit, own)
    a, g, step = np.zeros((count, count)), np.zeros(count), np.zeros(count)
    failed = (a, 0.0, 0.0, False, seen)
    blur = numbers[BLUR : BLUR + 3]
    if n < 2 * EVEN or not predict(rays, lens, rotation, translation, side_mm, blur, tex, rows, at, True):
        return failed
    if scale == 0.0:
        if light[0] == PLAIN and not even_light(rows[0], at, values, numbers, 2.0, cut):
            return failed
        light_up(at, numbers, light, lit)
        scale = typical_sd(rows, values, lit, numbers[RESPONSE], own)
    trust(at, lens, rotation, translation, side_mm, numbers, light, scale, own)
    light_up(at, numbers, light, lit)
    cost, total = equations(rows, at, values, lit, numbers, light, own, scale, cut, a, g)
    old_rotation, old_translation, old = rotation.copy(), translation.copy(), numbers.copy()
    damping, order, band, room = 1e-6, fields_first(light), band_of(light), (a.copy(), g.copy())
    for _ in range(rounds):
        gain, share = _solved(a, g, damping, order, band, step, rotation, translation, lens, side_mm, max_px)
        if share == 0.0:
            return failed
        old_rotation[:, :], old_translation[:], old[:] = rotation, translation, numbers
        facing = _advance(rotation, translation, numbers, step, share, min_blur)
        if facing and gain < settled * scale * scale and share == 1.0:
            break
        new_cost = np.inf
        if facing and predict(rays, lens, rotation, translation, side_mm, blur, tex, rows, at, True):
            light_up(at, numbers, light, lit)
            new_cost = _cost(rows, values, lit, numbers, light, own, scale, cut, room)
        fallen = (cost - new_cost) / (scale * scale)
        if not fallen >= 0.0:
            rotation[:, :], translation[:], numbers[:] = old_rotation, old_translation, old
            # As low as the picture's first order allows, or else a step too far.
            if fallen > -SETTLED_COST_SD2 or damping > 1.0:
                break
            damping = max(100.0 * damping, 1e-2)
            continue
        damping *= 0.1
        ends = share == 1.0 and fallen < SETTLED_COST_SD2
        typical = typical_sd(rows, values, lit, numbers[RESPONSE], own)
        if not ends and abs(typical - scale) > 0.1 * scale:
            scale = typical
            trust(at, lens, rotation, translation, side_mm, numbers, light, scale, own)
        cost, total = equations(rows, at, values, lit, numbers, light, own, scale, cut, a, g)
        if ends:
            break
    return a, scale, total / own.sum(), True, seen


@compiled
def robust_cost(rays, values, lens, rotation, translation, side_mm, tex, numbers, light, scale, cut):
    """The robust sum of squared residuals of a fit, in units of `scale`; infinite where it cannot be seen.

    With what is known beforehand: of two poses that leave as much, the one in stranger light is worse.
    """
    n = len(values)
    rows, at, lit, own = np.empty((10, n)), np.empty((n, 2)), np.empty((n, 2)), np.ones(n)
    blur = numbers[BLUR : BLUR + 3]
    if not predict(rays, lens, rotation, translation, side_mm, blur, tex, rows, at, False):
        return np.inf
    light_up(at, numbers, light, lit)
    trust(at, lens, rotation, translation, side_mm, numbers, light, scale, own)
    room = (np.zeros((len(numbers), len(numbers))), np.zeros(len(numbers)))
    return _cost(rows, values, lit, numbers, light, own, scale, cut, room) / (scale * scale)


@compiled
def scores_spread(values, seen, numbers, light, scale, cut, inverse, blocks):
    """The covariance (6, 6) of the pose that the residuals themselves show, neighbours taken together.

    `seen`: of `whole_fit`. `inverse`: (6, numbers), the pose's rows of the inverse of the fit's matrix.
    Residuals of one of blocks x blocks parts of the marker may err alike; those of two parts do not.
    """
    rows, at, lit, own = seen
    n = len(values)
    scores, there = np.zeros((blocks * blocks, len(numbers))), np.zeros(blocks * blocks)
    spread = np.zeros((6, 6))
    row, weight = np.empty(LIGHT), np.empty(AROUND)
    where, share = np.empty(MAX_SHARES, np.int64), np.empty(MAX_SHARES)
    unit = 1.0 / (cut * scale) ** 2
    weights, stiffness = 0.0, 0.0
    for i in range(n):
        x, y = at[i, 0], at[i, 1]
        shaped, r, w, _ = weighed_pixel(rows, i, values[i], lit, numbers[RESPONSE], own, unit, row)
        z = r * r * own[i] * unit
        weights += w
        stiffness += own[i] * (1.0 - 3.0 * z) / (1.0 + z) ** 3
        c = min(max(int((x + NODES_REACH) * 0.5 / NODES_REACH * blocks), 0), blocks - 1)
        b = min(max(int((y + NODES_REACH) * 0.5 / NODES_REACH * blocks), 0), blocks - 1)
        there[b * blocks + c] = 1.0
        score = scores[b * blocks + c]
        shares = shared_numbers(x, y, light, where)
        shares_of(x, y, shaped, lit[i, 1], numbers, light, weight, share)
        r *= w
        for k in range(LIGHT):
            score[k] += r * row[k]
        for k in range(shares):
            score[where[k]] += r * share[k]
    moved = np.zeros((blocks * blocks, 6))
    for block in range(blocks * blocks):
        for m in range(6):
            for k in range(len(numbers)):
                moved[block, m] += inverse[m, k] * scores[block, k]
    count = there.sum()
    for block in range(blocks * blocks):
        for m in range(6):
            for k in range(6):
                spread[m, k] += moved[block, m] * moved[block, k]
    # The fit's matrix counts weights; how the scores answer to a change of the pose is less.
    answer = weights / max(stiffness, MIN_ANSWER_RATIO * weights)
    return spread * (answer**2 * count / max(count - 6.0, 1.0))
