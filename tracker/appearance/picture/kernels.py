"""The compiled loops of the picture: which pixels see it, and what each of them sees."""

import math

import numpy as np

from tracker.camera.blur.kernels import axes_of, level_of
from tracker.camera.kernels import project_with_derivative
from tracker.compiled import compiled
from tracker.marker.model import PAPER_RATIO

MOST_TAPS = 13
BRIGHTEST = 254
# What lies beyond the paper, so many sd of the blur away, is not mixed in.
FAR_SDS = 4.0
STRAIGHT_PX = 4


@compiled
def _extent(rotation, translation, lens, reach_mm, step, width, height):
    """First and last column and row, in steps, of what lies within reach; empty where it cannot be."""
    derivative = np.empty((2, 3))
    p = np.empty(3)
    left, top, right, bottom = 1e9, 1e9, -1e9, -1e9
    for k in range(4):
        x = reach_mm if k in (1, 2) else -reach_mm
        y = reach_mm if k in (0, 1) else -reach_mm
        for m in range(3):
            p[m] = rotation[m, 0] * x + rotation[m, 1] * y + translation[m]
        if p[2] < 1.0:
            return 0, -1, 0, -1
        u, v = project_with_derivative(p, lens, derivative)
        left, right, top, bottom = min(left, u), max(right, u), min(top, v), max(bottom, v)
    if not (right - left < 1e5 and bottom - top < 1e5):
        return 0, -1, 0, -1
    c0, c1 = max(int(left) // step, 0), min(int(right) // step + 1, width // step - 1)
    r0, r1 = max(int(top) // step, 0), min(int(bottom) // step + 1, height // step - 1)
    return c0, c1, r0, r1


@compiled
def _footprint(rotation, translation, lens, side_mm, ahead):
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
    if not _footprint(rotation, translation, lens, side_mm, ahead):
        return
    m00, _, m11 = _in_sides(ahead, blur)
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
def _in_sides(ahead, blur):
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
def _steep(texels, first, size, texel, least2, x, y):
    """Whether the picture is steep at the texel next to (x, y) in sides."""
    c = min(max(int(x / texel + 0.5 * size), 0), size - 1)
    r = min(max(int(0.5 * size - y / texel), 0), size - 1)
    i = first + 3 * (r * size + c)
    return texels[i + 1] ** 2 + texels[i + 2] ** 2 > least2


@compiled
def _value(image, step, r, c):
    """The mean of a block of step x step pixels, -1 where it is brighter than the camera can tell."""
    total = 0
    for i in range(step):
        for j in range(step):
            one = image[r * step + i, c * step + j]
            if one >= BRIGHTEST:
                return -1.0
            total += one
    return total / (step * step)


@compiled
def _look_along(u, v, lens, ray, rounds):
    """The ray (2,) through a pixel, from one near it, by so many rounds of Newton's method."""
    derivative, p = np.empty((2, 3)), np.empty(3)
    for _ in range(rounds):
        p[0], p[1], p[2] = ray[0], ray[1], 1.0
        pu, pv = project_with_derivative(p, lens, derivative)
        a, b, d, e = derivative[0, 0], derivative[0, 1], derivative[1, 0], derivative[1, 1]
        det = a * e - b * d
        du, dv = u - pu, v - pv
        ray[0] += (e * du - b * dv) / det
        ray[1] += (a * dv - d * du) / det


@compiled
def collect(
    image, step, lens, rotation, translation, side_mm, reach_ratio, tex, blur, slope_ratio, stride, rays,
    values
):  # fmt: skip
    """Pixels (or means of step x step of them) within `reach_ratio` sides of the marker's centre lines.

    Those where its picture at this blur (3,) is at least `slope_ratio` as steep as anywhere, and every so
    many of the others. Fills `rays` (n, 2), their directions with the lens taken out, and `values` (n,);
    returns how many.
    """
    texels, starts, sizes, blurs, widths, steepest = tex
    height, width = image.shape
    reach_mm = reach_ratio * side_mm
    c0, c1, r0, r1 = _extent(rotation, translation, lens, reach_mm, step, width, height)
    ahead = np.empty((2, 2))
    if c1 - c0 < 2 or r1 - r0 < 2 or not _footprint(rotation, translation, lens, side_mm, ahead):
        return 0
    m00, _, m11 = _in_sides(ahead, blur)
    level = level_of(max(m00, m11), blurs)
    first, size, texel = starts[level], sizes[level], widths[level]
    least2 = (slope_ratio * steepest[level]) ** 2
    # The plane that the marker lies in: normal . point = distance.
    nx, ny, nz = rotation[0, 2], rotation[1, 2], rotation[2, 2]
    distance = nx * translation[0] + ny * translation[1] + nz * translation[2]
    n, flat = 0, 0
    here, ahead_of_here = np.empty(2), np.empty(2)
    here[0], here[1] = translation[0] / translation[2], translation[1] / translation[2]
    half = 0.5 * (step - 1)
    for r in range(r0, r1 + 1):
        _look_along(step * c0 + half, step * r + half, lens, here, 4)
        ahead_of_here[:] = here
        for c in range(c0, c1 + 1):
            if n >= len(values):
                return n
            # A lens bends so little over some pixels that rays between two are straight.
            part = (c - c0) % STRAIGHT_PX
            if part == 0:
                here[:] = ahead_of_here
                _look_along(step * (c + STRAIGHT_PX) + half, step * r + half, lens, ahead_of_here, 1)
            x = here[0] + part / STRAIGHT_PX * (ahead_of_here[0] - here[0])
            y = here[1] + part / STRAIGHT_PX * (ahead_of_here[1] - here[1])
            along = distance / (nx * x + ny * y + nz)
            qx, qy, qz = along * x - translation[0], along * y - translation[1], along - translation[2]
            px = (rotation[0, 0] * qx + rotation[1, 0] * qy + rotation[2, 0] * qz) / side_mm
            py = (rotation[0, 1] * qx + rotation[1, 1] * qy + rotation[2, 1] * qz) / side_mm
            if abs(px) > reach_ratio or abs(py) > reach_ratio:
                continue
            if not _steep(texels, first, size, texel, least2, px, py):
                flat += 1
                if flat % stride != 0:
                    continue
            value = _value(image, step, r, c)
            if value < 0.0:
                # It says nothing of where an edge is.
                continue
            rays[n, 0], rays[n, 1], values[n] = x, y, value
            n += 1
    return n


@compiled
def _spread(ahead, blur, blurs, offsets, weights):
    """How a blur (3,) in px^2 is made of one picture and taps along a line.

    Returns the picture's number, how many taps, the line's direction, and the variance along and across it
    that is left to first order, in sides^2.
    """
    m00, m01, m11 = _in_sides(ahead, blur)
    larger, smaller, ex, ey = axes_of(m00, m11, m01)
    smaller = max(smaller, 1e-8)
    level = level_of(smaller, blurs)
    has = blurs[level] ** 2
    across = smaller - has
    more = larger - smaller
    count = 1
    offsets[0], weights[0] = 0.0, 1.0
    along = larger - has
    if more > 0.1 * has:
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
def _picture(texels, start, size, texel, x, y, out):
    """Picture, slopes and curvatures (6,) at (x, y) in sides, added to `out` with the weight out[6]."""
    w = out[6]
    fx = x / texel + 0.5 * (size - 1)
    fy = 0.5 * (size - 1) - y / texel
    fx = min(max(fx, 0.0), size - 1.001)
    fy = min(max(fy, 0.0), size - 1.001)
    c, r = int(fx), int(fy)
    fx -= c
    fy -= r
    i = start + 3 * (r * size + c)
    j = i + 3 * size
    a, b, d, e = (1 - fx) * (1 - fy), fx * (1 - fy), (1 - fx) * fy, fx * fy
    out[1] += w * (a * texels[i + 1] + b * texels[i + 4] + d * texels[j + 1] + e * texels[j + 4])
    out[2] += w * (a * texels[i + 2] + b * texels[i + 5] + d * texels[j + 2] + e * texels[j + 5])
    # Slopes are by one side to the right and upwards; rows go down.
    xx = (1 - fy) * (texels[i + 4] - texels[i + 1]) + fy * (texels[j + 4] - texels[j + 1])
    yy = (1 - fx) * (texels[i + 2] - texels[j + 2]) + fx * (texels[i + 5] - texels[j + 5])
    xy = (1 - fx) * (texels[i + 1] - texels[j + 1]) + fx * (texels[i + 4] - texels[j + 4])
    out[3] += w * xx / texel
    out[4] += w * yy / texel
    out[5] += w * xy / texel
    # Straight lines between texels cut the bends off; the curvature puts them back.
    bends = 0.5 * texel * (fx * (1 - fx) * xx + fy * (1 - fy) * yy)
    out[0] += w * (a * texels[i] + b * texels[i + 3] + d * texels[j] + e * texels[j + 3] - bends)


@compiled
def predict(rays, lens, rotation, translation, side_mm, blur, tex, rows, at, free):
    """What each pixel sees of the picture, and how that changes: `rows` (n, 10), `at` (n, 2) in half sides.

    Columns of rows: the picture 0..1, its derivatives by translation (3) and turn (3), by blur (3).
    False where the marker cannot be seen like that.
    """
    texels, starts, sizes, blurs, widths, _ = tex
    ahead, offsets, weights = np.empty((2, 2)), np.empty(MOST_TAPS), np.empty(MOST_TAPS)
    if translation[2] < 1.0 or not _footprint(rotation, translation, lens, side_mm, ahead):
        return False
    level, count, ex, ey, along, across = _spread(ahead, blur, blurs, offsets, weights)
    start, size, texel = starts[level], sizes[level], widths[level]
    r00, r10, r20 = rotation[0, 0], rotation[1, 0], rotation[2, 0]
    r01, r11, r21 = rotation[0, 1], rotation[1, 1], rotation[2, 1]
    nx, ny, nz = rotation[0, 2], rotation[1, 2], rotation[2, 2]
    t0, t1, t2 = translation[0], translation[1], translation[2]
    distance = nx * t0 + ny * t1 + nz * t2
    out = np.empty(7)
    for i in range(len(rays)):
        x, y = rays[i, 0], rays[i, 1]
        facing = nx * x + ny * y + nz
        depth = distance / facing
        ax, ay, az = depth * x - t0, depth * y - t1, depth - t2
        sx = (r00 * ax + r10 * ay + r20 * az) / side_mm
        sy = (r01 * ax + r11 * ay + r21 * az) / side_mm
        at[i, 0], at[i, 1] = 2.0 * sx, 2.0 * sy
        out[:6] = 0.0
        for k in range(count):
            out[6] = weights[k]
            _picture(texels, start, size, texel, sx + offsets[k] * ex, sy + offsets[k] * ey, out)
        xx, yy, xy = out[3], out[4], out[5]
        bend_along = ex * ex * xx + 2.0 * ex * ey * xy + ey * ey * yy
        bend_across = xx + yy - bend_along
        rows[i, 0] = out[0] + 0.5 * (along * bend_along + across * bend_across)
        gx = (out[1] * r00 + out[2] * r01) / side_mm
        gy = (out[1] * r10 + out[2] * r11) / side_mm
        gz = (out[1] * r20 + out[2] * r21) / side_mm
        # A point of the plane under this ray moves by d (n.v) / (n.d) - v when the marker moves by v.
        slide = (gx * x + gy * y + gz) / facing
        qx, qy, qz = nx * slide - gx, ny * slide - gy, nz * slide - gz
        rows[i, 1], rows[i, 2], rows[i, 3] = qx, qy, qz
        rows[i, 4] = ay * qz - az * qy
        rows[i, 5] = az * qx - ax * qz
        rows[i, 6] = ax * qy - ay * qx
        if not free:
            continue
        a0, a1 = ahead[0, 0], ahead[1, 0]
        b0, b1 = ahead[0, 1], ahead[1, 1]
        rows[i, 7] = 0.5 * (a0 * a0 * xx + 2.0 * a0 * a1 * xy + a1 * a1 * yy)
        rows[i, 8] = 0.5 * (b0 * b0 * xx + 2.0 * b0 * b1 * xy + b1 * b1 * yy)
        rows[i, 9] = a0 * b0 * xx + (a0 * b1 + a1 * b0) * xy + a1 * b1 * yy
    return True
