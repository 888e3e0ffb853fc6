"""Edge crossings, coverage and fit error of projected model edges; corner correction."""

import numpy as np

from tracker.compiled import compiled
from tracker.edges.edge_kernels import crossing
from tracker.geometry.geometry_kernels import median

# Fewer edgels beside a corner do not determine its side.
MIN_EDGELS = 4


@compiled
def crossings(gx, gy, points, normals, reach):
    """Return offsets and strengths (n,) of the image edges along the normals at these points."""
    n = len(points)
    offset, response = np.zeros(n), np.zeros(n)
    for i in range(n):
        offset[i], response[i] = crossing(
            gx, gy, points[i, 0], points[i, 1], normals[i, 0], normals[i, 1], reach
        )
    return offset, response


@compiled
def edge_agreement(gx, gy, left, top, points, normals, strength, length, inner, reach, shift, floor, ratio):
    """Return model coverage, inner coverage, mean squared offset and contrast of an isolated edge.

    An edge is found where its response exceeds `floor` and `ratio` of what its strength (n,) and the contrast
    predict. `shift` is subtracted from the offsets. Without any edge the mean squared offset is the squared
    reach.
    """
    n = len(points)
    offset, response, ratios = np.empty(n), np.empty(n), np.empty(n)
    answers = 0
    for i in range(n):
        offset[i], response[i] = crossing(
            gx, gy, points[i, 0] - left, points[i, 1] - top, normals[i, 0], normals[i, 1], reach
        )
        if response[i] > 0.0:
            ratios[answers] = response[i] / strength[i]
            answers += 1
    contrast = median(ratios, answers) if answers > 0 else 0.0
    common, total_length, inner_common, inner_total, squares, count = 0.0, 0.0, 0.0, 0.0, 0.0, 0
    for i in range(n):
        found = response[i] >= max(floor, ratio * contrast * strength[i])
        total_length += length[i]
        if inner[i]:
            inner_total += length[i]
        if found:
            common += length[i]
            squares += (offset[i] - shift) ** 2
            count += 1
            if inner[i]:
                inner_common += length[i]
    fit = squares / count if count > 0 else reach * reach
    return common / total_length, inner_common / inner_total if inner_total > 0.0 else 1.0, fit, contrast


@compiled
def _side_at_corner(offset, along, chosen, n):
    """Return the offset of a side where `along` is 0, by a robust line through n offsets; NaN for too few."""
    if n < MIN_EDGELS:
        return np.nan
    sorted_values = np.empty(n)
    for i in range(n):
        sorted_values[i] = offset[chosen[i]]
    middle = median(sorted_values, n)
    for i in range(n):
        sorted_values[i] = abs(sorted_values[i] - middle)
    maximum = 3.0 * max(median(sorted_values, n), 0.05)
    inliers, st, stt, so, sto = 0, 0.0, 0.0, 0.0, 0.0
    for i in range(n):
        o, t = offset[chosen[i]], along[chosen[i]]
        if abs(o - middle) <= maximum:
            inliers += 1
            st += t
            stt += t * t
            so += o
            sto += t * o
    spread = inliers * stt - st * st
    if inliers < MIN_EDGELS or not spread > 0.0:
        return np.nan
    return (stt * so - st * sto) / spread


@compiled
def shift_corners(points, across, normals, usable, offset, half, near, reach, corners):
    """Move corners (4, 2) in px to the intersection of the observed adjacent sides, in place.

    Args:
        points: (n, 2), active edges in mm.
        across: (n, 2), their unit normals in the plane.
        normals: (n, 2), their unit normals in the image.
        usable: (n,), whether an edge is observed and part of the outline.
        offset: (n,), observed offset along the normal, in px.
        half: of the marker's side in mm.
        near: largest distance of an edge from its corner, in mm.
        reach: largest shift of a corner, in px.
        corners: (4, 2), top-left, top-right, bottom-right, bottom-left.
    """
    n = len(points)
    chosen, along = np.empty(n, np.int64), np.empty(n)
    off, normal = np.empty(2), np.empty((2, 2))
    for corner in range(4):
        at = (-half if corner in (0, 3) else half, half if corner < 2 else -half)
        for axis in range(2):
            # Axis 0: the upright side, which lies at the corner's x and runs along y.
            # No literal, see `compiled`.
            count = np.int64(0)
            nu, nv = 0.0, 0.0
            for i in range(n):
                along[i] = points[i, 1 - axis] - at[1 - axis]
                if (
                    usable[i]
                    and abs(across[i, axis]) > 0.9
                    and abs(points[i, axis] - at[axis]) < 0.2 * half
                    and abs(along[i]) < near
                ):
                    chosen[count] = i
                    count += 1
                    nu += normals[i, 0]
                    nv += normals[i, 1]
            off[axis] = _side_at_corner(offset, along, chosen, count)
            length = np.sqrt(nu * nu + nv * nv)
            normal[axis, 0], normal[axis, 1] = nu / length, nv / length
        det = normal[0, 0] * normal[1, 1] - normal[0, 1] * normal[1, 0]
        if not abs(det) >= 0.2:
            continue
        du = (off[0] * normal[1, 1] - off[1] * normal[0, 1]) / det
        dv = (off[1] * normal[0, 0] - off[0] * normal[1, 0]) / det
        if du * du + dv * dv <= reach * reach:
            corners[corner, 0] += du
            corners[corner, 1] += dv


@compiled
def _inside(corners, x, y, margin):
    """Return whether a point lies inside four corners, or less than the margin outside."""
    for k in range(4):
        ax, ay = corners[k, 0], corners[k, 1]
        ex, ey = corners[(k + 1) % 4, 0] - ax, corners[(k + 1) % 4, 1] - ay
        if ex * (y - ay) - ey * (x - ax) < -margin * np.sqrt(ex * ex + ey * ey):
            return False
    return True


@compiled
def count_matched_edgels(at, ex, ey, enx, eny, strength, points, normals, corners, radius, margin, minimum):
    """Count the edgels inside the corners that lie near a model edge of their direction, and all of them."""
    height, width = at.shape
    left, right, top, bottom = corners[0, 0], corners[0, 0], corners[0, 1], corners[0, 1]
    for k in range(1, 4):
        left, right = min(left, corners[k, 0]), max(right, corners[k, 0])
        top, bottom = min(top, corners[k, 1]), max(bottom, corners[k, 1])
    u0, u1 = max(int(left - margin), 0), min(int(right + margin) + 1, width - 1)
    v0, v1 = max(int(top - margin), 0), min(int(bottom + margin) + 1, height - 1)
    if u1 < u0 or v1 < v0:
        return 0, 0
    # Model edges by cells as wide as the radius: those near an edgel are in its cell or one beside it.
    columns, rows = int((u1 - u0 + 1) / radius) + 4, int((v1 - v0 + 1) / radius) + 4
    head = np.full(rows * columns, -1, np.int32)
    after = np.full(len(points), -1, np.int32)
    for j in range(len(points)):
        c = int(np.floor((points[j, 0] - u0) / radius)) + 2
        r = int(np.floor((points[j, 1] - v0) / radius)) + 2
        if 0 <= c < columns and 0 <= r < rows:
            after[j] = head[r * columns + c]
            head[r * columns + c] = j
    common, present = 0, 0
    for v in range(v0, v1 + 1):
        for u in range(u0, u1 + 1):
            i = at[v, u]
            if i < 0 or strength[i] < minimum:
                continue
            x, y = ex[i], ey[i]
            if not _inside(corners, x, y, margin):
                continue
            present += 1
            near = False
            c0, r0 = int(np.floor((x - u0) / radius)) + 2, int(np.floor((y - v0) / radius)) + 2
            for r in range(max(r0 - 1, 0), min(r0 + 2, rows)):
                for c in range(max(c0 - 1, 0), min(c0 + 2, columns)):
                    j = head[r * columns + c]
                    while j >= 0 and not near:
                        dx, dy = points[j, 0] - x, points[j, 1] - y
                        # The same polarity, within 60 degrees: at a corner the image's edge is rounder.
                        near = (
                            dx * dx + dy * dy <= radius * radius
                            and enx[i] * normals[j, 0] + eny[i] * normals[j, 1] > 0.5
                        )
                        j = after[j]
            common += near
    return common, present
