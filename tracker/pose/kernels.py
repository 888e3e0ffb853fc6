"""The compiled loops of the pose; their types are those of their calls."""

import numpy as np

from tracker.camera.kernels import project_with_derivative
from tracker.compiled import compiled
from tracker.edges.kernels import crossing
from tracker.geometry.kernels import mirror, solve_positive, turn_by

PARAMETERS = 7  # translation, rotation, and one shift common to all edges
MIN_EDGES = 12
# A step that moves no edge by more than this is the last; after one under the other the look is close by.
MIN_MOVE_PX, NEAR_MOVE_PX = 0.004, 0.3
# A parabola through samples a pixel apart places a peak that is near short by a fifth.
NEAR_STEP = 1.25
# A fit that moves less than this and is worse by far will not come to be the better one.
HOPELESS_MOVE_PX = 0.1


@compiled
def _project(rotation, translation, lens, points, normals, pixels, directions, toward):
    """Active edges (n, 2) in mm as pixels (n, 2) and unit image normals (n, 2), dark to bright.

    `toward` (n, 3) gets how the offset along its normal changes by the point in camera mm. Returns by how
    much the farthest of `pixels` moved; -1 where the marker reaches behind the camera.
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
        # The image's normal is across the image of the tangent, on the side to which the plane's points.
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
    """Active edges (n, 2) in mm as pixels (n, 2) and unit image normals (n, 2), dark to bright.

    And False where the marker reaches behind the camera.
    """
    n = len(points)
    pixels, directions = np.zeros((n, 2)), np.empty((n, 2))
    moved = _project(rotation, translation, lens, points, normals, pixels, directions, np.empty((n, 3)))
    return pixels, directions, moved >= 0.0


@compiled
def _residuals(gx, gy, left, top, pixels, directions, strength, least, reach, found, offset):
    """Offsets of the image's edges from the predicted ones into `offset`; how many there are."""
    n = 0
    for i in range(len(pixels)):
        o, response = crossing(
            gx, gy, pixels[i, 0] - left, pixels[i, 1] - top, directions[i, 0], directions[i, 1], reach
        )
        found[i] = response >= least * strength[i] and response > 0.0
        offset[i] = o
        n += found[i]
    return n


@compiled
def _normal_equations(rotation, points, toward, found, offset, weight, shift, shift_sd, scale, a, g):
    """Gauss-Newton's matrix (7, 7) and right side (7,) of the robustly weighted offsets."""
    a[:, :] = 0.0
    g[:] = 0.0
    row = np.empty(PARAMETERS)
    row[6] = 1.0
    weights = 0.0
    for i in range(len(points)):
        if not found[i]:
            continue
        r = offset[i] - shift
        # Tukey's biweight: what is far off is another edge and has no say at all.
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
    # The shift is not free: a camera's response or the printer's ink moves all edges by tenths of a pixel.
    prior = (scale / shift_sd) ** 2
    a[6, 6] += prior
    g[6] -= prior * shift
    return weights


@compiled
def _median_size(values, shift, found, kept):
    """Median of the absolute values, less the shift, that are found, as the sd of a normal distribution."""
    n = 0
    for i in range(len(values)):
        if found[i]:
            kept[n] = abs(values[i] - shift)
            n += 1
    return 1.4826 * np.median(kept[:n])


@compiled
def _moved(rotation, translation, step):
    """Move the pose by a step, in place; False where that turns the face away or puts it behind."""
    turn = np.sqrt(step[3] ** 2 + step[4] ** 2 + step[5] ** 2)
    if not np.isfinite(turn):
        return False
    # A step over half a radian leaves the image far behind: shorten it as a whole.
    short = 0.5 / turn if turn > 0.5 else 1.0
    for k in range(3):
        translation[k] += short * step[k]
    turn_by(rotation, short * step[3:6])
    facing = (
        rotation[0, 2] * translation[0] + rotation[1, 2] * translation[1] + rotation[2, 2] * translation[2]
    )
    return translation[2] > 1.0 and facing < 0.0


@compiled
def _cost(offset, found, weight, shift, reach):
    """Weighted sum of squares in which a missing edge counts as far off: px^2."""
    cost = 0.0
    for i in range(len(offset)):
        r = offset[i] - shift if found[i] else reach
        cost += weight[i] * min(r * r, reach * reach)
    return cost


@compiled
def _squares(offset, found, weight, shift, scale):
    """Robustly weighted sum of squares: px^2."""
    squares = 0.0
    for i in range(len(offset)):
        z = (offset[i] - shift) / (4.685 * scale)
        if found[i] and abs(z) < 1.0:
            squares += weight[i] * (1.0 - z * z) ** 2 * (offset[i] - shift) ** 2
    return squares


@compiled
def _refine(
    gx, gy, left, top, lens, points, normals, strength, least, reaches, shift_sd, most, pose, a, numbers
):
    """Gauss-Newton of the pose on the offsets along the normals, searched anew at each of `reaches` px.

    Changes the pose, rotation (3, 3) and translation (3,), in place; `a` (7, 7) and `numbers` are those of
    `refine_both`. It ends early where the cost stays over `most` px^2. False when it failed.
    """
    rotation, translation = pose
    n = len(points)
    pixels, directions, toward = np.zeros((n, 2)), np.empty((n, 2)), np.empty((n, 3))
    found, offset, kept = np.zeros(n, np.bool_), np.zeros(n), np.empty(n)
    g, step = np.zeros(PARAMETERS), np.zeros(PARAMETERS)
    shift, last = 0.0, len(reaches) - 1
    at = 0
    for turn in range(last + 2):
        moved = _project(rotation, translation, lens, points, normals, pixels, directions, toward)
        if moved < 0.0:
            return False
        # One look more than steps: what is returned belongs to the pose that is returned.
        ends = turn > last or (turn > 0 and moved < MIN_MOVE_PX and reaches[at] == reaches[last])
        if turn > 0:
            at = last if moved < NEAR_MOVE_PX else min(at + 1, last)
        reach = reaches[at]
        count = _residuals(gx, gy, left, top, pixels, directions, strength, least, reach, found, offset)
        if count < MIN_EDGES:
            return False
        if at == last and turn > 0 and moved < HOPELESS_MOVE_PX:
            ends = ends or _cost(offset, found, strength, shift, reach) > most
        scale = max(_median_size(offset, shift, found, kept), 0.02 if ends else 0.05)
        weights = _normal_equations(
            rotation, points, toward, found, offset, strength, shift, shift_sd, scale, a, g
        )
        if ends:
            numbers[0], numbers[1] = _cost(offset, found, strength, shift, reach), shift
            numbers[2], numbers[3] = _squares(offset, found, strength, shift, scale), weights
            numbers[4] = count
            return weights > PARAMETERS
        if not solve_positive(a, g, step):
            return False
        if turn > 0 and moved < NEAR_MOVE_PX:
            step *= NEAR_STEP
        if not _moved(rotation, translation, step):
            return False
        shift += step[6]
    return False


@compiled
def fit_square(corners, half, rotation, translation, rounds):
    """Move a pose, in place, to where a square's corners (4, 2) are on the normalised plane.

    Corners in the order (-half, half), (half, half), (half, -half), (-half, -half). Returns the sum of the
    squares that are left; infinite where it cannot be.
    """
    a, g, step, row = np.empty((6, 6)), np.empty(6), np.empty(6), np.empty(6)
    damping, before = 1e-3, np.inf
    old_rotation, old_translation = rotation.copy(), translation.copy()
    for turn in range(rounds + 1):
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
            rotation[:, :], translation[:] = old_rotation, old_translation
            return before
        if turn == rounds or left > 0.999 * before:
            return left
        before, damping = left, 0.1 * damping
        old_rotation[:, :], old_translation[:] = rotation, translation
        for m in range(6):
            a[m, m] *= 1.0 + damping
        if not solve_positive(a, g, step):
            return left
        for m in range(3):
            translation[m] += step[m]
        turn_by(rotation, step[3:6])
    return before


@compiled
def refine_both(
    gx, gy, left, top, lens, points, normals, strength, least, reaches, shift_sd,
    rotation, translation, most, min_px2, decided,
):  # fmt: skip
    """Both planar solutions around a pose, each refined, the better one first.

    A fit that stopped halfway costs more than the wrong solution well fitted, and its mirror image mirrors
    nothing: what is taken stands only after its own mirror image, fitted from it, has lost, or after `most`.
    Costs that differ by `decided` variances of an edge (at least `min_px2`) need no exact loser.

    Returns:
        rotations (3, 3, 3), translations (3, 3), matrices (3, 7, 7) and numbers (3, 5) of three fits: robust
        cost in px^2, shift common to all edges in px, weighted sum of squared residuals in px^2, sum of
        weights, number of edges; then which is the better and which the other, -1 where there is none.
    """
    rotations, translations = np.empty((3, 3, 3)), np.empty((3, 3))
    matrices, numbers = np.zeros((3, PARAMETERS, PARAMETERS)), np.zeros((3, 5))
    rotations[0], translations[0] = rotation, translation
    seed_rotation, seed_translation = rotation.copy(), translation.copy()
    better, other, free, hopeless = -1, -1, 0, np.inf
    for fit in range(most + 1):
        if fit > 0:
            mirror(seed_rotation, seed_translation, rotations[free])
            translations[free] = seed_translation
        fits = _refine(
            gx,
            gy,
            left,
            top,
            lens,
            points,
            normals,
            strength,
            least,
            reaches,
            shift_sd,
            hopeless,
            (rotations[free], translations[free]),
            matrices[free],
            numbers[free],
        )
        if not fits and fit > 0:
            break
        if fits and better >= 0 and numbers[free, 0] >= numbers[better, 0]:
            other = free
            break
        if fits:
            better, other = free, better
            seed_rotation[:, :], seed_translation[:] = rotations[free], translations[free]
            cost, squares, weights = numbers[free, 0], numbers[free, 2], numbers[free, 3]
            hopeless = cost + decided * max(squares / weights, cost / max(strength.sum(), 1.0), min_px2)
        for slot in range(3):
            if slot not in (better, other):
                free = slot
    return rotations, translations, matrices, numbers, better, other
