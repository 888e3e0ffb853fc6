"""The compiled loops of the pose; their types are those of their calls."""

import numpy as np

from tracker.camera.kernels import project_with_derivative
from tracker.compiled import compiled
from tracker.edges.kernels import crossing
from tracker.geometry.kernels import solve_positive, turn_by

PARAMETERS = 7  # translation, rotation, and one shift common to all edges
LEAST_EDGES = 12


@compiled
def project_edges(rotation, translation, lens, points, normals, pixels, directions):
    """Active edges (n, 2) in mm as pixels (n, 2) and unit image normals (n, 2), dark to bright.

    False where the marker reaches behind the camera.
    """
    derivative = np.empty((2, 3))
    p = np.empty(3)
    for i in range(len(points)):
        x, y = points[i, 0], points[i, 1]
        for k in range(3):
            p[k] = rotation[k, 0] * x + rotation[k, 1] * y + translation[k]
        if p[2] < 1.0:
            return False
        pixels[i, 0], pixels[i, 1] = project_with_derivative(p, lens, derivative)
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
    return True


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
def _normal_equations(
    rotation, translation, lens, points, directions, found, offset, weight, shift, shift_sd, scale, a, g
):
    """Gauss-Newton's matrix (7, 7) and right side (7,) of the robustly weighted offsets."""
    a[:, :] = 0.0
    g[:] = 0.0
    derivative = np.empty((2, 3))
    p, arm, row, toward = np.empty(3), np.empty(3), np.empty(PARAMETERS), np.empty(3)
    weights = 0.0
    for i in range(len(points)):
        if not found[i]:
            continue
        for k in range(3):
            arm[k] = rotation[k, 0] * points[i, 0] + rotation[k, 1] * points[i, 1]
            p[k] = arm[k] + translation[k]
        project_with_derivative(p, lens, derivative)
        for k in range(3):
            toward[k] = directions[i, 0] * derivative[0, k] + directions[i, 1] * derivative[1, k]
        row[0], row[1], row[2] = toward[0], toward[1], toward[2]
        row[3] = arm[1] * toward[2] - arm[2] * toward[1]
        row[4] = arm[2] * toward[0] - arm[0] * toward[2]
        row[5] = arm[0] * toward[1] - arm[1] * toward[0]
        row[6] = 1.0
        r = offset[i] - shift
        # Tukey's biweight: what is far off is another edge and has no say at all.
        z = r / (4.685 * scale)
        w = weight[i] * (1.0 - z * z) ** 2 if abs(z) < 1.0 else 0.0
        weights += w
        for m in range(PARAMETERS):
            for k in range(PARAMETERS):
                a[m, k] += w * row[m] * row[k]
            g[m] += w * row[m] * r
    # The shift is not free: a camera's response or the printer's ink moves all edges by tenths of a pixel.
    prior = (scale / shift_sd) ** 2
    a[6, 6] += prior
    g[6] -= prior * shift
    return weights


@compiled
def _median_size(values, found):
    """Median of the absolute values that are found, as the sd of a normal distribution."""
    kept = np.empty(len(values))
    n = 0
    for i in range(len(values)):
        if found[i]:
            kept[n] = abs(values[i])
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
def _sums(offset, found, weight, shift, scale, reach):
    """Robustly weighted sum of squares, and the cost in which a missing edge counts as far off: px^2."""
    squares, cost = 0.0, 0.0
    for i in range(len(offset)):
        if not found[i]:
            cost += weight[i] * reach * reach
            continue
        r = offset[i] - shift
        cost += weight[i] * min(r * r, reach * reach)
        z = r / (4.685 * scale)
        if abs(z) < 1.0:
            squares += weight[i] * (1.0 - z * z) ** 2 * r * r
    return squares, cost


@compiled
def refine(
    gx,
    gy,
    left,
    top,
    rotation,
    translation,
    lens,
    points,
    normals,
    strength,
    weight,
    least,
    reaches,
    shift_sd,
):
    """Gauss-Newton of the pose on the offsets along the normals, searched anew at each of `reaches` px.

    Changes rotation (3, 3) and translation (3,) in place. Returns the matrix (7, 7) at the end, the shift
    common to all edges in px, the weighted sum of squared residuals in px^2, the robust cost in px^2, the
    sum of weights and the number of edges; a number of 0 means that it failed.
    """
    n = len(points)
    pixels, directions = np.empty((n, 2)), np.empty((n, 2))
    found, offset = np.zeros(n, np.bool_), np.zeros(n)
    a, g, step = np.zeros((PARAMETERS, PARAMETERS)), np.zeros(PARAMETERS), np.zeros(PARAMETERS)
    shift, last = 0.0, len(reaches)
    failed = (a, 0.0, 0.0, 0.0, 0.0, 0)
    for turn in range(last + 1):
        # One look more than steps: what is returned belongs to the pose that is returned.
        reach = reaches[min(turn, last - 1)]
        if not project_edges(rotation, translation, lens, points, normals, pixels, directions):
            return failed
        count = _residuals(gx, gy, left, top, pixels, directions, strength, least, reach, found, offset)
        if count < LEAST_EDGES:
            return failed
        scale = max(_median_size(offset - shift, found), 0.05 if turn < last else 0.02)
        weights = _normal_equations(
            rotation,
            translation,
            lens,
            points,
            directions,
            found,
            offset,
            weight,
            shift,
            shift_sd,
            scale,
            a,
            g,
        )
        if turn == last:
            squares, cost = _sums(offset, found, weight, shift, scale, reach)
            return a, shift, squares, cost, weights, count
        if not solve_positive(a, g, step) or not _moved(rotation, translation, step):
            return failed
        shift += step[6]
    return failed
