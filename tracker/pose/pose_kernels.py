"""Compiled kernels of the edge-based pose refinement; argument types follow from the calls."""

import numpy as np

from tracker.camera.projection_kernels import project_with_derivative
from tracker.compiled import compiled
from tracker.edges.edge_kernels import crossing
from tracker.geometry.geometry_kernels import (
    copy_pose,
    copy_vector,
    median,
    mirror,
    rotate_by,
    solve_positive,
)

PARAMETERS = 7  # translation, rotation, and one shift common to all edges
MIN_EDGES = 12
# Convergence limit of the edge motion; below the second value the smallest search range is used.
MIN_MOVE_PX, NEAR_MOVE_PX = 0.004, 0.3
# Parabola interpolation of samples one pixel apart underestimates the offset of a near peak by a fifth.
OVER_RELAXATION = 1.25
# A fit that moves less than this at a much higher cost cannot become the better one.
EARLY_STOP_MOVE_PX = 0.1


@compiled
def pose_from_foreshortening(homography, rotation, translation):
    """Write the pose whose projection equals a homography (3, 3) from the plane in mm to first order.

    Returns False where there is none. In a frame whose z is the line of sight, the Jacobian of the projection
    is the upper left block of the rotation divided by the distance; the unit norm of each column gives its
    component along the line of sight.
    """
    unit = 1.0 / homography[2, 2]
    x, y = unit * homography[0, 2], unit * homography[1, 2]
    away = np.sqrt(1.0 + x * x + y * y)
    # Columns: right, down, along the line of sight.
    frame = np.empty((3, 3))
    frame[0, 2], frame[1, 2], frame[2, 2] = x / away, y / away, 1.0 / away
    across = np.sqrt(frame[2, 2] ** 2 + frame[0, 2] ** 2)
    frame[0, 0], frame[1, 0], frame[2, 0] = frame[2, 2] / across, 0.0, -frame[0, 2] / across
    frame[0, 1] = frame[1, 2] * frame[2, 0]
    frame[1, 1] = frame[2, 2] * frame[0, 0] - frame[0, 2] * frame[2, 0]
    frame[2, 1] = -frame[1, 2] * frame[0, 0]
    a, b = away * (frame[0, 0] - x * frame[2, 0]), away * (frame[0, 1] - x * frame[2, 1])
    c, d = away * (frame[1, 0] - y * frame[2, 0]), away * (frame[1, 1] - y * frame[2, 1])
    det = a * d - b * c
    seen, columns = np.empty((2, 2)), np.empty((3, 3))
    for k in range(2):
        p = unit * (homography[0, k] - x * homography[2, k])
        q = unit * (homography[1, k] - y * homography[2, k])
        seen[0, k], seen[1, k] = (d * p - b * q) / det, (a * q - c * p) / det
    # The tilt shortens one singular value; the larger one is the scale.
    squares = seen[0, 0] ** 2 + seen[0, 1] ** 2 + seen[1, 0] ** 2 + seen[1, 1] ** 2
    area = seen[0, 0] * seen[1, 1] - seen[0, 1] * seen[1, 0]
    scale = np.sqrt(0.5 * (squares + np.sqrt(max(squares * squares - 4.0 * area * area, 0.0))))
    if not scale > 1e-12:
        return False
    for k in range(2):
        columns[0, k], columns[1, k] = seen[0, k] / scale, seen[1, k] / scale
        columns[2, k] = np.sqrt(max(1.0 - columns[0, k] ** 2 - columns[1, k] ** 2, 0.0))
    if columns[0, 0] * columns[0, 1] + columns[1, 0] * columns[1, 1] > 0.0:
        columns[2, 1] = -columns[2, 1]
    for k in range(3):
        i, j = (k + 1) % 3, (k + 2) % 3
        columns[k, 2] = columns[i, 0] * columns[j, 1] - columns[j, 0] * columns[i, 1]
    for r in range(3):
        translation[r] = frame[r, 2] / scale
        for k in range(3):
            rotation[r, k] = 0.0
            for m in range(3):
                rotation[r, k] += frame[r, m] * columns[m, k]
    return True


@compiled
def _project(rotation, translation, lens, points, normals, pixels, directions, toward):
    """Project active edges (n, 2) in mm into `pixels` (n, 2) and unit normals (n, 2), dark to bright.

    Writes to `toward` (n, 3) the derivative of the offset along the normal by the point in camera mm.
    Returns the largest move of any of `pixels`; -1 where the marker reaches behind the camera.
    """
    derivative = np.empty((2, 3))
    p = np.empty(3)
    moved = 0.0
    for i in range(len(points)):
        x, y = points[i, 0], points[i, 1]
        for k in range(3):
            p[k] = rotation[k, 0] * x + rotation[k, 1] * y + translation[k]
        if p[2] < 1.0:
            return -1.0
        u, v = project_with_derivative(p, lens, derivative)
        moved = max(moved, abs(u - pixels[i, 0]), abs(v - pixels[i, 1]))
        pixels[i, 0], pixels[i, 1] = u, v
        # The image normal is perpendicular to the projected tangent, on the side of the plane's normal.
        a, b = normals[i, 0], normals[i, 1]
        tu, tv, nu, nv = 0.0, 0.0, 0.0, 0.0
        for k in range(3):
            along = -rotation[k, 0] * b + rotation[k, 1] * a
            across = rotation[k, 0] * a + rotation[k, 1] * b
            tu += derivative[0, k] * along
            tv += derivative[1, k] * along
            nu += derivative[0, k] * across
            nv += derivative[1, k] * across
        length = np.sqrt(tu * tu + tv * tv)
        du, dv = -tv / length, tu / length
        if du * nu + dv * nv < 0.0:
            du, dv = -du, -dv
        directions[i, 0], directions[i, 1] = du, dv
        for k in range(3):
            toward[i, k] = du * derivative[0, k] + dv * derivative[1, k]
    return moved


@compiled
def project_edges(rotation, translation, lens, points, normals):
    """Return active edges (n, 2) in mm as pixels (n, 2) and unit image normals (n, 2), dark to bright.

    The third value is False where the marker reaches behind the camera.
    """
    n = len(points)
    pixels, directions = np.zeros((n, 2)), np.empty((n, 2))
    moved = _project(rotation, translation, lens, points, normals, pixels, directions, np.empty((n, 3)))
    return pixels, directions, moved >= 0.0


@compiled
def _residuals(gx, gy, left, top, pixels, directions, strength, minimum, reach, found, offset):
    """Write the offsets of the image edges from the projected edges; return the number of edges found."""
    n = 0
    for i in range(len(pixels)):
        o, response = crossing(
            gx, gy, pixels[i, 0] - left, pixels[i, 1] - top, directions[i, 0], directions[i, 1], reach
        )
        found[i] = response >= minimum * strength[i] and response > 0.0
        offset[i] = o
        n += found[i]
    return n


@compiled
def _normal_equations(rotation, points, toward, found, offset, weight, shift, shift_sd, scale, a, g):
    """Write the Gauss-Newton matrix (7, 7) and right-hand side (7,) of the weighted offsets to `a`, `g`."""
    a[:, :] = 0.0
    g[:] = 0.0
    row = np.empty(PARAMETERS)
    row[6] = 1.0
    weights = 0.0
    for i in range(len(points)):
        if not found[i]:
            continue
        r = offset[i] - shift
        # Tukey's biweight: large offsets belong to other edges and have zero weight.
        z = r / (4.685 * scale)
        if abs(z) >= 1.0:
            continue
        w = weight[i] * (1.0 - z * z) ** 2
        weights += w
        x, y = points[i, 0], points[i, 1]
        arm0 = rotation[0, 0] * x + rotation[0, 1] * y
        arm1 = rotation[1, 0] * x + rotation[1, 1] * y
        arm2 = rotation[2, 0] * x + rotation[2, 1] * y
        t0, t1, t2 = toward[i, 0], toward[i, 1], toward[i, 2]
        row[0], row[1], row[2] = t0, t1, t2
        row[3], row[4], row[5] = arm1 * t2 - arm2 * t1, arm2 * t0 - arm0 * t2, arm0 * t1 - arm1 * t0
        for m in range(PARAMETERS):
            part = w * row[m]
            for k in range(m + 1):
                a[m, k] += part * row[k]
            g[m] += part * r
    for m in range(PARAMETERS):
        for k in range(m):
            a[k, m] = a[m, k]
    # Prior on the shift: the camera response or the printer's ink moves all edges by tenths of a pixel.
    prior = (scale / shift_sd) ** 2
    a[6, 6] += prior
    g[6] -= prior * shift
    return weights


@compiled
def _normalised_mad(values, shift, found, sizes):
    """Return the normalised median absolute deviation of the found values from `shift`."""
    n = 0
    for i in range(len(values)):
        if found[i]:
            sizes[n] = abs(values[i] - shift)
            n += 1
    return 1.4826 * median(sizes, n)


@compiled
def _apply_step(rotation, translation, step):
    """Apply a step to the pose in place; return False where the face then points away or is not in front."""
    angle = np.sqrt(step[3] ** 2 + step[4] ** 2 + step[5] ** 2)
    if not np.isfinite(angle):
        return False
    # A step over half a radian is outside the linear range: scale the whole step.
    short = 0.5 / angle if angle > 0.5 else 1.0
    for k in range(3):
        translation[k] += short * step[k]
    rotate_by(rotation, step[3:6], short)
    facing = (
        rotation[0, 2] * translation[0] + rotation[1, 2] * translation[1] + rotation[2, 2] * translation[2]
    )
    return translation[2] > 1.0 and facing < 0.0


@compiled
def _cost(offset, found, weight, shift, reach):
    """Return the truncated weighted sum of squares [px^2]; a missing edge counts as `reach`."""
    cost = 0.0
    for i in range(len(offset)):
        r = offset[i] - shift if found[i] else reach
        cost += weight[i] * min(r * r, reach * reach)
    return cost


@compiled
def _weighted_squares(offset, found, weight, shift, scale):
    """Return the robustly weighted sum of squares [px^2]."""
    squares = 0.0
    for i in range(len(offset)):
        z = (offset[i] - shift) / (4.685 * scale)
        if found[i] and abs(z) < 1.0:
            squares += weight[i] * (1.0 - z * z) ** 2 * (offset[i] - shift) ** 2
    return squares


@compiled
def _refine(
    gx,
    gy,
    left,
    top,
    lens,
    points,
    normals,
    strength,
    minimum,
    reaches,
    shift_sd,
    max_cost_px2,
    pose,
    a,
    statistics,
):
    """Refine the pose by Gauss-Newton on the edge offsets, searched again within each of `reaches` px.

    Changes the pose, rotation (3, 3) and translation (3,), in place; `a` (7, 7) and `statistics` are those of
    `fit_both_solutions`. Stops early where the cost remains above `max_cost_px2` px^2. Returns False when the
    fit failed.
    """
    rotation, translation = pose
    n = len(points)
    pixels, directions, toward = np.zeros((n, 2)), np.empty((n, 2)), np.empty((n, 3))
    found, offset, sizes = np.zeros(n, np.bool_), np.zeros(n), np.empty(n)
    g, step = np.zeros(PARAMETERS), np.zeros(PARAMETERS)
    shift, last = 0.0, len(reaches) - 1
    at = 0
    for iteration in range(last + 2):
        moved = _project(rotation, translation, lens, points, normals, pixels, directions, toward)
        if moved < 0.0:
            return False
        # One more edge search than steps, so that the statistics belong to the returned pose.
        ends = iteration > last or (iteration > 0 and moved < MIN_MOVE_PX and reaches[at] == reaches[last])
        if iteration > 0:
            at = last if moved < NEAR_MOVE_PX else min(at + 1, last)
        reach = reaches[at]
        count = _residuals(gx, gy, left, top, pixels, directions, strength, minimum, reach, found, offset)
        if count < MIN_EDGES:
            return False
        if at == last and iteration > 0 and moved < EARLY_STOP_MOVE_PX:
            ends = ends or _cost(offset, found, strength, shift, reach) > max_cost_px2
        scale = max(_normalised_mad(offset, shift, found, sizes), 0.02 if ends else 0.05)
        weights = _normal_equations(
            rotation, points, toward, found, offset, strength, shift, shift_sd, scale, a, g
        )
        if ends:
            statistics[0], statistics[1] = _cost(offset, found, strength, shift, reach), shift
            statistics[2], statistics[3] = _weighted_squares(offset, found, strength, shift, scale), weights
            statistics[4] = count
            return weights > PARAMETERS
        if not solve_positive(a, g, step):
            return False
        if iteration > 0 and moved < NEAR_MOVE_PX:
            for k in range(PARAMETERS):
                step[k] *= OVER_RELAXATION
        if not _apply_step(rotation, translation, step):
            return False
        shift += step[6]
    return False


@compiled
def fit_square(corners, half, rotation, translation, rounds):
    """Fit a pose, in place, to a square's corners (4, 2) on the plane z = 1 by Levenberg-Marquardt.

    Corners in the order (-half, half), (half, half), (half, -half), (-half, -half). Returns the residual sum
    of squares; infinite where a corner lies behind the camera.
    """
    a, g, step, row = np.empty((6, 6)), np.empty(6), np.empty(6), np.empty(6)
    damping, before = 1e-3, np.inf
    old_rotation, old_translation = rotation.copy(), translation.copy()
    for iteration in range(rounds + 1):
        a[:, :], g[:], left = 0.0, 0.0, 0.0
        for k in range(4):
            x = half if k in (1, 2) else -half
            y = half if k < 2 else -half
            ax = rotation[0, 0] * x + rotation[0, 1] * y
            ay = rotation[1, 0] * x + rotation[1, 1] * y
            az = rotation[2, 0] * x + rotation[2, 1] * y
            z = az + translation[2]
            if not z > 0.0:
                left = np.inf
                break
            for axis in range(2):
                at = ((ax if axis == 0 else ay) + translation[axis]) / z
                r = corners[k, axis] - at
                row[0], row[1], row[2] = (1 - axis) / z, axis / z, -at / z
                row[3] = row[1] * -az + row[2] * ay
                row[4] = row[0] * az - row[2] * ax
                row[5] = row[1] * ax - row[0] * ay
                left += r * r
                for m in range(6):
                    g[m] += r * row[m]
                    for n in range(6):
                        a[m, n] += row[m] * row[n]
        if not left < before:
            copy_pose(old_rotation, old_translation, rotation, translation)
            return before
        if iteration == rounds or left > 0.999 * before:
            return left
        before, damping = left, 0.1 * damping
        copy_pose(rotation, translation, old_rotation, old_translation)
        for m in range(6):
            a[m, m] *= 1.0 + damping
        if not solve_positive(a, g, step):
            return left
        for m in range(3):
            translation[m] += step[m]
        rotate_by(rotation, step[3:6], 1.0)
    return before


@compiled
def fit_both_solutions(
    gx, gy, left, top, lens, points, normals, strength, minimum, reaches, shift_sd,
    rotation, translation, max_fits, min_px2, decided,
):  # fmt: skip
    """Refine both planar solutions around a pose.

    A fit that has not converged can cost more than a converged fit of the wrong solution, and its flipped
    pose is no solution. A fit is therefore accepted only after the fit from its own flipped pose has a higher
    cost, or after `max_fits` fits. If the costs differ by `decided` variances of an edge (at least
    `min_px2`), the worse fit need not converge.

    Returns:
        rotations (3, 3, 3), translations (3, 3), matrices (3, 7, 7) and statistics (3, 5) of three fits:
        robust cost in px^2, shift common to all edges in px, weighted sum of squared residuals in px^2, sum
        of weights, number of edges; then the index of the better and of the other, -1 where there is none.
    """
    total_strength = 0.0
    for one in strength:
        total_strength += one
    rotations, translations = np.empty((3, 3, 3)), np.empty((3, 3))
    matrices, statistics = np.zeros((3, PARAMETERS, PARAMETERS)), np.zeros((3, 5))
    seed_rotation, seed_translation = rotation.copy(), translation.copy()
    copy_pose(seed_rotation, seed_translation, rotations[0], translations[0])
    better, other, free, abandon_above_px2 = -1, -1, 0, np.inf
    for fit in range(max_fits + 1):
        if fit > 0:
            mirror(seed_rotation, seed_translation, rotations[free])
            copy_vector(seed_translation, translations[free])
        fits = _refine(
            gx,
            gy,
            left,
            top,
            lens,
            points,
            normals,
            strength,
            minimum,
            reaches,
            shift_sd,
            abandon_above_px2,
            (rotations[free], translations[free]),
            matrices[free],
            statistics[free],
        )
        if not fits and fit > 0:
            break
        if fits and better >= 0 and statistics[free, 0] >= statistics[better, 0]:
            other = free
            break
        if fits:
            better, other = free, better
            copy_pose(rotations[free], translations[free], seed_rotation, seed_translation)
            cost, squares, weights = statistics[free, 0], statistics[free, 2], statistics[free, 3]
            abandon_above_px2 = cost + decided * max(
                squares / weights, cost / max(total_strength, 1.0), min_px2
            )
        for slot in range(3):
            if slot not in (better, other):
                free = slot
    return rotations, translations, matrices, statistics, better, other
