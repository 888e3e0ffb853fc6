"""The compiled loops of the picture: which pixels see it, and what each of them sees."""

import math

import numpy as np

from tracker.appearance.taps.kernels import MAX_TAPS, taps_of
from tracker.appearance.texels.kernels import add_picture
from tracker.camera.blur.kernels import mapped
from tracker.camera.kernels import project_with_derivative
from tracker.compiled import compiled
from tracker.marker.model import PAPER_RATIO

# What lies beyond the paper, so many sd of the blur away, is not mixed in.
FAR_SDS = 4.0
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
    m00, m11, _ = mapped(ahead, blur)
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
def onto_plane(rays, begin, count, rotation, translation, side_mm, at):
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
def _changes(rays, begin, count, rotation, translation, side_mm, seen, spread, rows):
    """Into `rows` (10, n), from `begin` on: the picture, and how it changes by pose."""
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


@compiled
def _changes_by_blur(begin, count, seen, drawn, ahead, smear, rows):
    """Into `rows` (10, n), from `begin` on: how the picture changes by the blur's variances.

    `drawn` (2, many): the slopes of the taps by their moves along the smear. Where the picture is drawn along
    a line, a longer or turned line moves the taps; a wider bell bends the picture.
    """
    variance, sx, sy = smear
    end = begin + count
    b0, b1, b2 = rows[7, begin:end], rows[8, begin:end], rows[9, begin:end]
    a, c, b, d = ahead[0, 0], ahead[1, 0], ahead[0, 1], ahead[1, 1]
    xxs, yys, xys = seen[3], seen[4], seen[5]
    for k in range(count):
        xx, yy, xy = xxs[k], yys[k], xys[k]
        b0[k] = 0.5 * (a * a * xx + 2.0 * a * c * xy + c * c * yy)
        b1[k] = 0.5 * (b * b * xx + 2.0 * b * d * xy + d * d * yy)
        b2[k] = a * b * xx + (a * d + c * b) * xy + c * d * yy
    if variance == 0.0:
        return
    # A pixel's step along the smear, and beside it, on the plane.
    px, py, qx, qy = a * sx + b * sy, c * sx + d * sy, b * sx - a * sy, d * sx - c * sy
    rights, ups = drawn[0], drawn[1]
    for k in range(count):
        along = (rights[k] * px + ups[k] * py) / variance
        between = (rights[k] * qx + ups[k] * qy) / variance
        across = 2.0 * (b0[k] + b1[k]) - along
        b0[k] = 0.5 * (sx * sx * along - 2.0 * sx * sy * between + sy * sy * across)
        b1[k] = 0.5 * (sy * sy * along + 2.0 * sx * sy * between + sx * sx * across)
        b2[k] = sx * sy * (along - across) + (sx * sx - sy * sy) * between


@compiled
def _add_taps(tex, level, at, begin, count, taps, many, room, smeared, one, seen, drawn):
    """Into `seen` (6, many): what taps see together; into `drawn` (2, many): their slopes by their moves."""
    texels, starts, sizes, _, widths, _ = tex
    start, size, texel = starts[level], sizes[level], widths[level]
    seen[:, :] = 0.0
    if not smeared:
        for k in range(many):
            right, up, weight = taps[0, k], taps[1, k], taps[2, k]
            add_picture(texels, start, size, texel, at, begin, count, right, up, weight, room, seen)
        return
    drawn[:, :] = 0.0
    for k in range(many):
        right, up, weight = taps[0, k], taps[1, k], taps[2, k]
        one[:, :] = 0.0
        add_picture(texels, start, size, texel, at, begin, count, right, up, weight, room, one)
        seen += one
        for m in range(2):
            out, slope, moved = drawn[m], one[1 + m], taps[3, k]
            for i in range(count):
                out[i] += moved * slope[i]


@compiled
def predict(rays, lens, rotation, translation, side_mm, blur, tex, rows, at, free):
    """What each pixel sees of the picture, and how that changes: `rows` (10, n), `at` (n, 2) in half sides.

    Of rows: the picture 0..1, its derivatives by translation (3) and turn (3), by blur (3).
    False where the marker cannot be seen like that.
    """
    ahead, taps = np.empty((2, 2)), np.empty((4, MAX_TAPS))
    if translation[2] < 1.0 or not footprint(rotation, translation, lens, side_mm, ahead):
        return False
    level, many, spread, smear = taps_of(ahead, blur, tex[3], taps)
    room = (np.empty((12, MANY), np.float32), np.empty(MANY, np.int64), np.empty((2, MANY)))
    seen, one, drawn = np.empty((6, MANY)), np.empty((6, MANY)), np.empty((2, MANY))
    for begin in range(0, len(rays), MANY):
        count = min(MANY, len(rays) - begin)
        onto_plane(rays, begin, count, rotation, translation, side_mm, at)
        _add_taps(tex, level, at, begin, count, taps, many, room, smear[0] > 0.0, one, seen, drawn)
        _changes(rays, begin, count, rotation, translation, side_mm, seen, spread, rows)
        if free:
            _changes_by_blur(begin, count, seen, drawn, ahead, smear, rows)
    return True
