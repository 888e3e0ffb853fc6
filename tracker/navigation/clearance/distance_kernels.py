"""Compiled kernels of the distance field: construction, and interpolation in each image."""

import numpy as np

from tracker.compiled import compiled


@compiled
def mark_ray_crossings(corners, marks):
    """Mark where grid lines along the first axis cross triangles (m, 3, 3), given in grid steps.

    `marks` (n0 + 1, n1, n2): at i, between the nodes i - 1 and i: +1 for each triangle that the line leaves
    through, -1 for each that it enters through.
    """
    size, rows, columns = marks.shape[0] - 1, marks.shape[1], marks.shape[2]
    for m in range(len(corners)):
        a0, a1, a2 = corners[m, 0, 0], corners[m, 0, 1], corners[m, 0, 2]
        b0, b1, b2 = corners[m, 1, 0], corners[m, 1, 1], corners[m, 1, 2]
        c0, c1, c2 = corners[m, 2, 0], corners[m, 2, 1], corners[m, 2, 2]
        area = (b1 - a1) * (c2 - a2) - (b2 - a2) * (c1 - a1)
        if area == 0.0:
            continue
        first1 = max(int(np.ceil(min(a1, b1, c1))), 0)
        last1 = min(int(np.floor(max(a1, b1, c1))), rows - 1)
        first2 = max(int(np.ceil(min(a2, b2, c2))), 0)
        last2 = min(int(np.floor(max(a2, b2, c2))), columns - 1)
        for j in range(first1, last1 + 1):
            for k in range(first2, last2 + 1):
                v = ((j - a1) * (c2 - a2) - (k - a2) * (c1 - a1)) / area
                w = ((b1 - a1) * (k - a2) - (b2 - a2) * (j - a1)) / area
                if v < 0.0 or w < 0.0 or v + w > 1.0:
                    continue
                at = a0 + v * (b0 - a0) + w * (c0 - a0)
                if 0.0 <= at <= size - 1:
                    marks[int(np.floor(at)) + 1, j, k] += 1 if area > 0.0 else -1


@compiled
def add_votes(marks, votes):
    """Add to `votes` (n0, n1, n2) the nearest crossing on both sides of each node: +1 inside, -1 outside."""
    size = votes.shape[0]
    for j in range(votes.shape[1]):
        for k in range(votes.shape[2]):
            state = 0
            for i in range(size):
                mark = marks[i, j, k]
                if mark != 0:
                    state = 1 if mark < 0 else -1
                votes[i, j, k] += state
            state = 0
            for i in range(size - 1, -1, -1):
                mark = marks[i + 1, j, k]
                if mark != 0:
                    state = 1 if mark > 0 else -1
                votes[i, j, k] += state


@compiled
def _squared_distance(x, y, z, t):
    """Return the squared distance of a point from a triangle (3, 3), possibly degenerate (Ericson 2005)."""
    abx, aby, abz = t[1, 0] - t[0, 0], t[1, 1] - t[0, 1], t[1, 2] - t[0, 2]
    acx, acy, acz = t[2, 0] - t[0, 0], t[2, 1] - t[0, 1], t[2, 2] - t[0, 2]
    px, py, pz = x - t[0, 0], y - t[0, 1], z - t[0, 2]
    d1, d2 = abx * px + aby * py + abz * pz, acx * px + acy * py + acz * pz
    bb, bc = abx * abx + aby * aby + abz * abz, abx * acx + aby * acy + abz * acz
    cc = acx * acx + acy * acy + acz * acz
    # In the coordinates v, w of the two sides, the inside, or the nearest point of the three sides.
    v, w = 0.0, 0.0
    determinant = bb * cc - bc * bc
    inside = False
    if determinant > 1e-12 * bb * cc:
        v, w = (cc * d1 - bc * d2) / determinant, (bb * d2 - bc * d1) / determinant
        inside = v >= 0.0 and w >= 0.0 and v + w <= 1.0
    if not inside:
        v = min(max(d1 / bb, 0.0), 1.0) if bb > 0.0 else 0.0
        w = 0.0
        best = _off(px, py, pz, abx, aby, abz, acx, acy, acz, v, 0.0)
        other = min(max(d2 / cc, 0.0), 1.0) if cc > 0.0 else 0.0
        off = _off(px, py, pz, abx, aby, abz, acx, acy, acz, 0.0, other)
        if off < best:
            best, v, w = off, 0.0, other
        length = bb - 2.0 * bc + cc
        share = min(max((d2 - d1 + bb - bc) / length, 0.0), 1.0) if length > 0.0 else 0.0
        off = _off(px, py, pz, abx, aby, abz, acx, acy, acz, 1.0 - share, share)
        if off < best:
            v, w = 1.0 - share, share
    return _off(px, py, pz, abx, aby, abz, acx, acy, acz, v, w)


@compiled
def _off(px, py, pz, abx, aby, abz, acx, acy, acz, v, w):
    x, y, z = px - v * abx - w * acx, py - v * aby - w * acy, pz - v * abz - w * acz
    return x * x + y * y + z * z


@compiled
def rasterise_distance(triangles, first, band, squared, nearest):
    """Lower the squared distance of the nodes within `band` steps of triangles (m, 3, 3), in grid steps.

    `squared` (n0, n1, n2) and `nearest`, the index of the closest triangle, counted from `first`.
    """
    size0, size1, size2 = squared.shape
    for m in range(len(triangles)):
        t = triangles[m]
        low0 = max(int(np.ceil(min(t[0, 0], t[1, 0], t[2, 0]) - band)), 0)
        low1 = max(int(np.ceil(min(t[0, 1], t[1, 1], t[2, 1]) - band)), 0)
        low2 = max(int(np.ceil(min(t[0, 2], t[1, 2], t[2, 2]) - band)), 0)
        high0 = min(int(np.floor(max(t[0, 0], t[1, 0], t[2, 0]) + band)), size0 - 1)
        high1 = min(int(np.floor(max(t[0, 1], t[1, 1], t[2, 1]) + band)), size1 - 1)
        high2 = min(int(np.floor(max(t[0, 2], t[1, 2], t[2, 2]) + band)), size2 - 1)
        for i in range(low0, high0 + 1):
            for j in range(low1, high1 + 1):
                for k in range(low2, high2 + 1):
                    off = _squared_distance(float(i), float(j), float(k), t)
                    if off < squared[i, j, k]:
                        squared[i, j, k] = off
                        nearest[i, j, k] = first + m


@compiled
def propagate_nearest(triangles, seeds, nearest, squared):
    """Fill the nodes outside the narrow band with the triangle of the nearest node inside it.

    `seeds` (3, n0, n1, n2): that node.
    """
    size0, size1, size2 = squared.shape
    for i in range(size0):
        for j in range(size1):
            for k in range(size2):
                if nearest[i, j, k] < 0:
                    m = nearest[seeds[0, i, j, k], seeds[1, i, j, k], seeds[2, i, j, k]]
                    squared[i, j, k] = _squared_distance(float(i), float(j), float(k), triangles[m])
                    nearest[i, j, k] = m


@compiled
def sweep_neighbours(triangles, nearest, squared, direction):
    """Test for each node the triangles of its predecessors (`direction` 1) or successors (-1) on each axis.

    Corrects nodes equidistant to several band nodes.
    """
    size0, size1, size2 = squared.shape
    for a in range(size0):
        i = a if direction > 0 else size0 - 1 - a
        for b in range(size1):
            j = b if direction > 0 else size1 - 1 - b
            for c in range(size2):
                k = c if direction > 0 else size2 - 1 - c
                for axis in range(3):
                    u = i - direction if axis == 0 else i
                    v = j - direction if axis == 1 else j
                    w = k - direction if axis == 2 else k
                    if not (0 <= u < size0 and 0 <= v < size1 and 0 <= w < size2):
                        continue
                    m = nearest[u, v, w]
                    if m == nearest[i, j, k]:
                        continue
                    off = _squared_distance(float(i), float(j), float(k), triangles[m])
                    if off < squared[i, j, k]:
                        squared[i, j, k] = off
                        nearest[i, j, k] = m


@compiled
def cell_of(values, x, y, z):
    """Return the lower node (i, j, k) of the cell of a point in grid steps, and its place in it, 0 to 1.

    A point outside of the grid is moved to its boundary.
    """
    i = min(max(int(np.floor(x)), 0), values.shape[0] - 2)
    j = min(max(int(np.floor(y)), 0), values.shape[1] - 2)
    k = min(max(int(np.floor(z)), 0), values.shape[2] - 2)
    a = min(max(x - i, 0.0), 1.0)
    b = min(max(y - j, 0.0), 1.0)
    c = min(max(z - k, 0.0), 1.0)
    return i, j, k, a, b, c


@compiled
def _look_up(values, unit, step, x, y, z, gradient):
    """Trilinear interpolation at a point in grid steps; also sets its gradient in 1/mm (3,)."""
    i, j, k, a, b, c = cell_of(values, x, y, z)
    v000, v001 = float(values[i, j, k]), float(values[i, j, k + 1])
    v010, v011 = float(values[i, j + 1, k]), float(values[i, j + 1, k + 1])
    v100, v101 = float(values[i + 1, j, k]), float(values[i + 1, j, k + 1])
    v110, v111 = float(values[i + 1, j + 1, k]), float(values[i + 1, j + 1, k + 1])
    v00, v01 = v000 + c * (v001 - v000), v010 + c * (v011 - v010)
    v10, v11 = v100 + c * (v101 - v100), v110 + c * (v111 - v110)
    v0, v1 = v00 + b * (v01 - v00), v10 + b * (v11 - v10)
    scale = unit / step
    gradient[0] = scale * (v1 - v0)
    gradient[1] = scale * ((1.0 - a) * (v01 - v00) + a * (v11 - v10))
    gradient[2] = scale * (
        (1.0 - a) * ((1.0 - b) * (v001 - v000) + b * (v011 - v010))
        + a * ((1.0 - b) * (v101 - v100) + b * (v111 - v110))
    )
    return unit * (v0 + a * (v1 - v0))


@compiled
def interpolate(values, unit, step, origin, points, distance, gradient):
    """Interpolate distances (n,) and gradients (n, 3) at points (n, 3) in mm."""
    for n in range(len(points)):
        x = (points[n, 0] - origin[0]) / step
        y = (points[n, 1] - origin[1]) / step
        z = (points[n, 2] - origin[2]) / step
        distance[n] = _look_up(values, unit, step, x, y, z, gradient[n])


@compiled
def wall_clearances(values, unit, step, origin, floor, floor_step, margin, entry, basis, points, out, slopes):
    """Compute the clearance to the bone of points (s, r, 3) into `out` (s, r), its gradient into `slopes`.

    Infinite for points that do not count: not deeper by `margin` than the posterior surface, whose depth map
    is `floor` (n, n) along the rows of `basis` (axis, medial, cranial), or beyond that map.
    """
    half = 0.5 * (len(floor) - 1)
    for s in range(points.shape[0]):
        for r in range(points.shape[1]):
            x, y, z = points[s, r, 0] - entry[0], points[s, r, 1] - entry[1], points[s, r, 2] - entry[2]
            depth = basis[0, 0] * x + basis[0, 1] * y + basis[0, 2] * z
            u = (basis[1, 0] * x + basis[1, 1] * y + basis[1, 2] * z) / floor_step + half
            v = (basis[2, 0] * x + basis[2, 1] * y + basis[2, 2] * z) / floor_step + half
            i, j = int(np.rint(u)), int(np.rint(v))
            out[s, r] = np.inf
            slopes[s, r, 0] = slopes[s, r, 1] = slopes[s, r, 2] = 0.0
            if i < 0 or j < 0 or i >= len(floor) or j >= len(floor) or depth <= floor[i, j] + margin:
                continue
            out[s, r] = -_look_up(
                values,
                unit,
                step,
                (points[s, r, 0] - origin[0]) / step,
                (points[s, r, 1] - origin[1]) / step,
                (points[s, r, 2] - origin[2]) / step,
                slopes[s, r],
            )
            for c in range(3):
                slopes[s, r, c] = -slopes[s, r, c]


@compiled
def channel_clearances(radius, length, entry, axis, points, out, slopes):
    """Compute the clearance to the channel of points (s, r, 3) into `out` (s, r), its gradient into `slopes`.

    Infinite before the entry and past the end, where there is no wall.
    """
    for s in range(points.shape[0]):
        for r in range(points.shape[1]):
            x, y, z = points[s, r, 0] - entry[0], points[s, r, 1] - entry[1], points[s, r, 2] - entry[2]
            depth = axis[0] * x + axis[1] * y + axis[2] * z
            out[s, r] = np.inf
            slopes[s, r, 0] = slopes[s, r, 1] = slopes[s, r, 2] = 0.0
            if depth <= 0.0 or depth > length:
                continue
            x, y, z = x - depth * axis[0], y - depth * axis[1], z - depth * axis[2]
            off = np.sqrt(x * x + y * y + z * z)
            out[s, r] = radius - off
            if off > 1e-9:
                slopes[s, r, 0], slopes[s, r, 1], slopes[s, r, 2] = -x / off, -y / off, -z / off
