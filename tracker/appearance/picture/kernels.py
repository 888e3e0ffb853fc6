"""The compiled loops of the picture: which pixels see it, and what each of them sees."""

import math

import numpy as np

from tracker.appearance.texels.kernels import add_picture
from tracker.camera.blur.kernels import axes_of, level_of
from tracker.camera.kernels import project_with_derivative
from tracker.compiled import compiled
from tracker.marker.model import PAPER_RATIO

MOST_TAPS = 13
# What lies beyond the paper, so many sd of the blur away, is not mixed in.
FAR_SDS = 4.0
# Up to so much more of a blur's variance along one direction, by that of the picture, three taps are enough.
LITTLE_MORE = 0.5
# So many pixels side by side, so that the machine works on several at once and all stay at hand.
MANY = 256


@compiled
def footprint(rotation, translation, lens, side_mm, ahead):
    """Into `ahead` (2, 2): by how many sides the marker's plane moves under a pixel's step right and down."""
    derivative = np.empty((2, 3))
    p = translation.copy()
    project_with_derivative(p, lens, derivative)
    a, b, c, d = 0.0, 0.0, 0.0, 0.0
    for k in range(3):
        a += derivative[0, k] * rotation[k, 0]
        b += derivative[0, k] * rotation[k, 1]
        c += derivative[1, k] * rotation[k, 0]
        d += derivative[1, k] * rotation[k, 1]
    det = a * d - b * c
    if abs(det) < 1e-12:
        return False
    ahead[0, 0], ahead[0, 1] = d / det / side_mm, -b / det / side_mm
    ahead[1, 0], ahead[1, 1] = -c / det / side_mm, a / det / side_mm
    return True


@compiled
def paper_seen(at, lens, rotation, translation, side_mm, blur, share):
    """Into `share` (n,): how much of what each pixel sees lies on the marker's paper, 0..1."""
    ahead = np.empty((2, 2))
    share[:] = 1.0
    if not footprint(rotation, translation, lens, side_mm, ahead):
        return
    m00, _, m11 = in_sides(ahead, blur)
    # In half sides, as `at` is.
    sx, sy = 2.0 * np.sqrt(max(m00, 1e-12)), 2.0 * np.sqrt(max(m11, 1e-12))
    edge = 1.0 + 2.0 * PAPER_RATIO
    for i in range(len(share)):
        x, y = (edge - abs(at[i, 0])) / sx, (edge - abs(at[i, 1])) / sy
        if x < FAR_SDS:
            share[i] *= 1.0 - 0.5 * math.erfc(x * np.sqrt(0.5))
        if y < FAR_SDS:
            share[i] *= 1.0 - 0.5 * math.erfc(y * np.sqrt(0.5))


@compiled
def in_sides(ahead, blur):
    """A blur (3,) in px^2 as variances in the marker's plane, in sides^2: along x, between, along y."""
    m00 = ahead[0, 0] ** 2 * blur[0] + 2 * ahead[0, 0] * ahead[0, 1] * blur[2] + ahead[0, 1] ** 2 * blur[1]
    m11 = ahead[1, 0] ** 2 * blur[0] + 2 * ahead[1, 0] * ahead[1, 1] * blur[2] + ahead[1, 1] ** 2 * blur[1]
    m01 = (
        ahead[0, 0] * ahead[1, 0] * blur[0]
        + (ahead[0, 0] * ahead[1, 1] + ahead[0, 1] * ahead[1, 0]) * blur[2]
        + ahead[0, 1] * ahead[1, 1] * blur[1]
    )
    return m00, m01, m11


@compiled
def _spread(ahead, blur, blurs, offsets, weights):
    """How a blur (3,) in px^2 is made of one picture and taps along a line.

    Returns the picture's number, how many taps, the line's direction, and the variance along and across it
    that is left to first order, in sides^2.
    """
    m00, m01, m11 = in_sides(ahead, blur)
    larger, smaller, ex, ey = axes_of(m00, m11, m01)
    smaller = max(smaller, 1e-8)
    level = level_of(smaller, blurs)
    has = blurs[level] ** 2
    across = smaller - has
    more = larger - smaller
    count = 1
    offsets[0], weights[0] = 0.0, 1.0
    along = larger - has
    if 0.1 * has < more <= LITTLE_MORE * has:
        # Gauss and Hermite's three places: their first five moments are the Gaussian's.
        count, along = 3, across
        for k in range(3):
            offsets[k], weights[k] = (k - 1) * np.sqrt(3.0 * more), 2.0 / 3.0 if k == 1 else 1.0 / 6.0
    elif more > LITTLE_MORE * has:
        sd = np.sqrt(more)
        reach = int(np.ceil(2.3 * sd / (1.25 * blurs[level])))
        reach = min(max(reach, 1), MOST_TAPS // 2)
        gap = 2.3 * sd / reach
        count = 2 * reach + 1
        total, variance = 0.0, 0.0
        for k in range(count):
            offsets[k] = (k - reach) * gap
            weights[k] = np.exp(-0.5 * (offsets[k] / sd) ** 2)
            total += weights[k]
            variance += weights[k] * offsets[k] ** 2
        scale = np.sqrt(more / (variance / total))
        for k in range(count):
            offsets[k] *= scale
            weights[k] /= total
        along = across
    return level, count, ex, ey, along, across


@compiled
def _onto_plane(rays, begin, count, rotation, translation, side_mm, at):
    """Into `at` (n, 2): where the rays from `begin` on meet the marker's plane, in half sides."""
    r00, r10, r20 = rotation[0, 0], rotation[1, 0], rotation[2, 0]
    r01, r11, r21 = rotation[0, 1], rotation[1, 1], rotation[2, 1]
    nx, ny, nz = rotation[0, 2], rotation[1, 2], rotation[2, 2]
    t0, t1, t2 = translation[0], translation[1], translation[2]
    distance, unit = nx * t0 + ny * t1 + nz * t2, 2.0 / side_mm
    for i in range(begin, begin + count):
        x, y = rays[i, 0], rays[i, 1]
        depth = distance / (nx * x + ny * y + nz)
        ax, ay, az = depth * x - t0, depth * y - t1, depth - t2
        at[i, 0] = unit * (r00 * ax + r10 * ay + r20 * az)
        at[i, 1] = unit * (r01 * ax + r11 * ay + r21 * az)


@compiled
def _changes(rays, begin, count, rotation, translation, side_mm, seen, ahead, spread, rows, free):
    """Into `rows` (10, n), from `begin` on: the picture, and how it changes by pose and blur."""
    ex, ey, along, across = spread
    r00, r10, r20 = rotation[0, 0], rotation[1, 0], rotation[2, 0]
    r01, r11, r21 = rotation[0, 1], rotation[1, 1], rotation[2, 1]
    nx, ny, nz = rotation[0, 2], rotation[1, 2], rotation[2, 2]
    t0, t1, t2 = translation[0], translation[1], translation[2]
    distance, unit = nx * t0 + ny * t1 + nz * t2, 1.0 / side_mm
    value, right, up, xxs, yys, xys = seen[0], seen[1], seen[2], seen[3], seen[4], seen[5]
    end = begin + count
    picture, m0, m1, m2 = rows[0, begin:end], rows[1, begin:end], rows[2, begin:end], rows[3, begin:end]
    w0, w1, w2 = rows[4, begin:end], rows[5, begin:end], rows[6, begin:end]
    for k in range(count):
        xx, yy, xy = xxs[k], yys[k], xys[k]
        bend_along = ex * ex * xx + 2.0 * ex * ey * xy + ey * ey * yy
        picture[k] = value[k] + 0.5 * (along * bend_along + across * (xx + yy - bend_along))
        x, y = rays[begin + k, 0], rays[begin + k, 1]
        by_facing = 1.0 / (nx * x + ny * y + nz)
        depth = distance * by_facing
        ax, ay, az = depth * x - t0, depth * y - t1, depth - t2
        gx = unit * (right[k] * r00 + up[k] * r01)
        gy = unit * (right[k] * r10 + up[k] * r11)
        gz = unit * (right[k] * r20 + up[k] * r21)
        # A point of the plane under this ray moves by d (n.v) / (n.d) - v when the marker moves by v.
        slide = (gx * x + gy * y + gz) * by_facing
        qx, qy, qz = nx * slide - gx, ny * slide - gy, nz * slide - gz
        m0[k], m1[k], m2[k] = qx, qy, qz
        w0[k], w1[k], w2[k] = ay * qz - az * qy, az * qx - ax * qz, ax * qy - ay * qx
    if not free:
        return
    b0, b1, b2 = rows[7, begin:end], rows[8, begin:end], rows[9, begin:end]
    a, c, b, d = ahead[0, 0], ahead[1, 0], ahead[0, 1], ahead[1, 1]
    for k in range(count):
        xx, yy, xy = xxs[k], yys[k], xys[k]
        b0[k] = 0.5 * (a * a * xx + 2.0 * a * c * xy + c * c * yy)
        b1[k] = 0.5 * (b * b * xx + 2.0 * b * d * xy + d * d * yy)
        b2[k] = a * b * xx + (a * d + c * b) * xy + c * d * yy


@compiled
def predict(rays, lens, rotation, translation, side_mm, blur, tex, rows, at, free):
    """What each pixel sees of the picture, and how that changes: `rows` (10, n), `at` (n, 2) in half sides.

    Of rows: the picture 0..1, its derivatives by translation (3) and turn (3), by blur (3).
    False where the marker cannot be seen like that.
    """
    texels, starts, sizes, blurs, widths, _ = tex
    ahead, offsets, weights = np.empty((2, 2)), np.empty(MOST_TAPS), np.empty(MOST_TAPS)
    if translation[2] < 1.0 or not footprint(rotation, translation, lens, side_mm, ahead):
        return False
    level, taps, ex, ey, along, across = _spread(ahead, blur, blurs, offsets, weights)
    start, size, texel = starts[level], sizes[level], widths[level]
    room = (np.empty((12, MANY), np.float32), np.empty(MANY, np.int64), np.empty((2, MANY)))
    seen = np.empty((6, MANY))
    for begin in range(0, len(rays), MANY):
        count = min(MANY, len(rays) - begin)
        _onto_plane(rays, begin, count, rotation, translation, side_mm, at)
        seen[:, :] = 0.0
        for k in range(taps):
            right, up = offsets[k] * ex, offsets[k] * ey
            add_picture(texels, start, size, texel, at, begin, count, right, up, weights[k], room, seen)
        _changes(
            rays,
            begin,
            count,
            rotation,
            translation,
            side_mm,
            seen,
            ahead,
            (ex, ey, along, across),
            rows,
            free,
        )
    return True
