"""Search for the straight soft shadow edge with the largest decrease of the squared residuals."""

import numpy as np

from tracker.compiled import compiled
from tracker.marker.photometric_fit.grid_kernels import GRID_CELLS, cell_coordinate

STRIDE = 3  # one cell in nine is enough to find an edge
BASE = 9


@compiled
def _orthonormal(base, left):
    """Orthonormalise columns (n, k) in place by Gram-Schmidt, and project them out of `left` (n,)."""
    n, k = base.shape
    for p in range(k):
        for q in range(p):
            along = 0.0
            for i in range(n):
                along += base[i, q] * base[i, p]
            for i in range(n):
                base[i, p] -= along * base[i, q]
        length = 0.0
        for i in range(n):
            length += base[i, p] ** 2
        length = 1.0 / np.sqrt(max(length, 1e-12))
        along = 0.0
        for i in range(n):
            base[i, p] *= length
            along += base[i, p] * left[i]
        for i in range(n):
            left[i] -= along * base[i, p]


@compiled
def _across(angle, place, soft):
    """Return the factors of u and v and the offset that map a soft edge to -1..1."""
    return np.cos(angle) / (2.0 * soft), np.sin(angle) / (2.0 * soft), place / (2.0 * soft)


@compiled
def _smooth_step(t):
    """Return the smooth step across an edge: 0 below -1, 1 above 1."""
    t = min(max(t, -1.0), 1.0)
    return 0.5 + t * (0.75 - 0.25 * t * t)


@compiled
def shadow_of(edge):
    """Return the illumination (cells,) of an edge (3,), 0 on one side and 1 on the other."""
    out = np.empty(GRID_CELLS * GRID_CELLS)
    x, y, less = _across(edge[0], edge[1], edge[2])
    for r in range(GRID_CELLS):
        for c in range(GRID_CELLS):
            out[r * GRID_CELLS + c] = _smooth_step(cell_coordinate(c) * x + cell_coordinate(r) * y - less)
    return out


@compiled
def _gain_of(at, picture, weight, base, left, angle, place, soft):
    """Return the decrease of the squared residuals by a step of the illumination, on ink and paper."""
    first, second = np.zeros(BASE), np.zeros(BASE)
    x, y, less = _across(angle, place, soft)
    aa, ab, bb, fa, fb = 0.0, 0.0, 0.0, 0.0, 0.0
    for i in range(len(left)):
        s = weight[i] * _smooth_step(at[i, 0] * x + at[i, 1] * y - less)
        p = s * picture[i]
        aa += s * s
        ab += s * p
        bb += p * p
        fa += left[i] * s
        fb += left[i] * p
        for k in range(BASE):
            first[k] += base[i, k] * s
            second[k] += base[i, k] * p
    for k in range(BASE):
        aa -= first[k] * first[k]
        ab -= first[k] * second[k]
        bb -= second[k] * second[k]
    det = max(aa * bb - ab * ab, 1e-9 * aa * bb + 1e-12)
    return (bb * fa * fa - 2.0 * ab * fa * fb + aa * fb * fb) / det


@compiled
def shadow_edge(observed, picture, visible, angles, places, soft, edge):
    """Find the edge with the largest decrease of the squared residuals of quadratic illumination.

    Fills `edge` (3,): angle, offset and softness, in half sides. Returns the explained fraction, 0..1. Cells
    that are not `visible` are excluded.
    """
    every = (GRID_CELLS + STRIDE - 1) // STRIDE
    count = every * every
    at, base = np.empty((count, 2)), np.empty((count, BASE))
    left, ink, weight = np.empty(count), np.empty(count), np.empty(count)
    for r in range(every):
        for c in range(every):
            i, y, x = r * every + c, r * STRIDE, c * STRIDE
            u, v = cell_coordinate(x), cell_coordinate(y)
            w = 1.0 if visible[y, x] else 0.0
            p = picture[y, x]
            at[i, 0], at[i, 1], ink[i], weight[i], left[i] = u, v, p, w, w * observed[y, x]
            base[i, 0], base[i, 1], base[i, 2] = w, w * u, w * v
            base[i, 3], base[i, 4], base[i, 5] = w * u * u, w * u * v, w * v * v
            base[i, 6], base[i, 7], base[i, 8] = w * p, w * p * u, w * p * v
    _orthonormal(base, left)
    total_energy = 0.0
    for i in range(count):
        total_energy += left[i] * left[i]
    best = -1.0
    edge[0], edge[1], edge[2] = 0.0, 0.0, soft
    for a in range(angles):
        for b in range(places):
            angle, place = a * np.pi / angles, 2.2 * b / (places - 1) - 1.1
            gain = _gain_of(at, ink, weight, base, left, angle, place, soft)
            if gain > best:
                best, edge[0], edge[1] = gain, angle, place
    angle_step, shift = np.pi / angles, 2.2 / (places - 1)
    for _ in range(3):
        angle, place, wide = edge[0], edge[1], edge[2]
        angle_step, shift = 0.5 * angle_step, 0.5 * shift
        for k in range(13):
            if k < 9:
                one, two, three = angle + (k // 3 - 1) * angle_step, place + (k % 3 - 1) * shift, wide
            else:
                one, two, three = edge[0], edge[1], wide * 2.0 ** (0.75 * (k - 11 + (k > 10)))
            gain = _gain_of(at, ink, weight, base, left, one, two, three)
            if gain > best:
                best, edge[0], edge[1], edge[2] = gain, one, two, three
    return best / total_energy if total_energy > 0.0 else 0.0
