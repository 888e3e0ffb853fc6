"""Compiled kernels of the breach probability; their types are those of their calls."""

from math import erfc

import numpy as np

from tracker.compiled import compiled
from tracker.geometry.geometry_kernels import copy_vector
from tracker.navigation.clearance.distance_kernels import cell_of

SQRT_HALF = 0.7071067811865476


@compiled
def rank_contacts(points, clearance, gradient, tip, direction, root, wall_sd, mahalanobis, chosen, slopes):
    """Rank the surface points by the Mahalanobis distance of their clearance, per direction around the drill.

    `mahalanobis` (p, r): clearance divided by its standard deviation, ascending along p, infinite where there
    is none; `chosen` (p, r): index of the ring; `slopes` (7,): derivative of the smallest one with respect to
    seven unit normals. Returns its standard deviation. `root` (6, 6): a square root of the covariance of the
    pose.
    """
    count, directions = mahalanobis.shape
    row, worst, worst_sd = np.empty(7), np.inf, 0.0
    mahalanobis[:] = np.inf
    chosen[:] = 0
    for s in range(points.shape[0]):
        for r in range(directions):
            if not np.isfinite(clearance[s, r]):
                continue
            x, y, z = points[s, r, 0] - tip[0], points[s, r, 1] - tip[1], points[s, r, 2] - tip[2]
            a, b, c = gradient[s, r, 0], gradient[s, r, 1], gradient[s, r, 2]
            u, v, w = y * c - z * b, z * a - x * c, x * b - y * a
            # Rotation about the drill's own axis does not move its surface.
            spin = u * direction[0] + v * direction[1] + w * direction[2]
            u, v, w = u - spin * direction[0], v - spin * direction[1], w - spin * direction[2]
            row[6] = wall_sd
            total = wall_sd * wall_sd
            for m in range(6):
                row[m] = (
                    a * root[0, m]
                    + b * root[1, m]
                    + c * root[2, m]
                    + u * root[3, m]
                    + v * root[4, m]
                    + w * root[5, m]
                )
                total += row[m] * row[m]
            sd = np.sqrt(total)
            here = clearance[s, r] / max(sd, 1e-6)
            if here < worst:
                worst, worst_sd = here, sd
                copy_vector(row, slopes)
            for p in range(count):
                if here < mahalanobis[p, r]:
                    for q in range(count - 1, p, -1):
                        mahalanobis[q, r], chosen[q, r] = mahalanobis[q - 1, r], chosen[q - 1, r]
                    mahalanobis[p, r], chosen[p, r] = here, s
                    break
    return worst_sd


@compiled
def min_clearance_along_lines(
    values, unit, step, origin, arms, tip, direction, root, line, wall_sd, samples, offsets, out
):
    """Compute the minimum clearance (s, t) of points on the displaced drill (n, 3 from its tip).

    The displacement is given by seven unit normals, `samples` (s, 7) without their component along `line`
    (7,), plus each of `offsets` (t,) along it. The first six displace the pose, the last one the wall.
    """
    normal, move = np.empty(7), np.empty(6)
    for s in range(len(samples)):
        along = 0.0
        for m in range(7):
            along += samples[s, m] * line[m]
        for k in range(len(offsets)):
            for m in range(7):
                normal[m] = samples[s, m] + (offsets[k] - along) * line[m]
            for c in range(6):
                move[c] = 0.0
                for m in range(6):
                    move[c] += root[c, m] * normal[m]
            spin = move[3] * direction[0] + move[4] * direction[1] + move[5] * direction[2]
            u = move[3] - spin * direction[0]
            v = move[4] - spin * direction[1]
            w = move[5] - spin * direction[2]
            min_clearance = np.inf
            for n in range(len(arms)):
                x, y, z = arms[n, 0], arms[n, 1], arms[n, 2]
                px = (tip[0] + x + move[0] + v * z - w * y - origin[0]) / step
                py = (tip[1] + y + move[1] + w * x - u * z - origin[1]) / step
                pz = (tip[2] + z + move[2] + u * y - v * x - origin[2]) / step
                min_clearance = min(min_clearance, -_value(values, px, py, pz) * unit)
            out[s, k] = min_clearance + wall_sd * normal[6]


@compiled
def _value(values, x, y, z):
    """Trilinear interpolation at a point in grid steps."""
    i, j, k, a, b, c = cell_of(values, x, y, z)
    v00 = (1.0 - c) * values[i, j, k] + c * values[i, j, k + 1]
    v01 = (1.0 - c) * values[i, j + 1, k] + c * values[i, j + 1, k + 1]
    v10 = (1.0 - c) * values[i + 1, j, k] + c * values[i + 1, j, k + 1]
    v11 = (1.0 - c) * values[i + 1, j + 1, k] + c * values[i + 1, j + 1, k + 1]
    return (1.0 - a) * ((1.0 - b) * v00 + b * v01) + a * ((1.0 - b) * v10 + b * v11)


@compiled
def _normal_cdf(t):
    return 0.5 * erfc(-t * SQRT_HALF)


@compiled
def breach_probability(min_clearance, offsets, limits, out):
    """Compute the probability `out` (k,) that a clearance is below limits, from samples along lines (s, t).

    Piecewise linear between the offsets, extrapolated beyond them; the position along each line is a unit
    normal.
    """
    count = len(offsets)
    out[:] = 0.0
    for s in range(len(min_clearance)):
        for m in range(len(limits)):
            total = 0.0
            for k in range(count - 1):
                t0, t1 = offsets[k], offsets[k + 1]
                low, high = min_clearance[s, k] - limits[m], min_clearance[s, k + 1] - limits[m]
                slope = (high - low) / (t1 - t0)
                if k == 0:
                    low, t0 = low - 9.0 * slope, t0 - 9.0
                if k == count - 2:
                    high, t1 = high + 9.0 * slope, t1 + 9.0
                if low < 0.0 and high < 0.0:
                    total += _normal_cdf(t1) - _normal_cdf(t0)
                elif low < 0.0:
                    total += _normal_cdf(t0 - low / slope) - _normal_cdf(t0)
                elif high < 0.0:
                    # Use the upper tail, because the difference of values near 1 loses digits.
                    total += _normal_cdf(-(t0 - low / slope)) - _normal_cdf(-t1)
            out[m] += min(total, 1.0)
    for m in range(len(limits)):
        out[m] /= len(min_clearance)
