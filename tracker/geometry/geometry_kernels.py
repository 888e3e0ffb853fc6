"""Compiled kernels of geometry and linear algebra; argument types follow from the calls."""

import numpy as np

from tracker.compiled import compiled

# Added to the unit diagonal of a scaled matrix: keeps undetermined unknowns at zero.
RIDGE = 1e-9
# No band structure: a dense matrix. No literals, see `compiled`.
NO_BAND = (np.int64(0), np.int64(0))


@compiled
def copy_vector(values, out):
    """Copy values (n,) into `out` (n,)."""
    for k in range(len(values)):
        out[k] = values[k]


@compiled
def copy_pose(rotation, translation, out_rotation, out_translation):
    """Copy a pose into `out_rotation` (3, 3) and `out_translation` (3,)."""
    for r in range(3):
        out_translation[r] = translation[r]
        for c in range(3):
            out_rotation[r, c] = rotation[r, c]


@compiled
def mirror(rotation, translation, out):
    """Write the rotation of the flipped planar solution: mirrored across the line of sight."""
    squared = translation[0] ** 2 + translation[1] ** 2 + translation[2] ** 2
    for c in range(3):
        along = 0.0
        for k in range(3):
            along += translation[k] * rotation[k, c]
        for k in range(3):
            mirrored = rotation[k, c] - 2.0 * translation[k] * along / squared
            out[k, c] = -mirrored if c == 2 else mirrored


@compiled
def orthonormalise(m, out):
    """Write to `out` (3, 3) a rotation without its rounding error."""
    # The first Newton step of the polar decomposition squares the deviation.
    for r in range(3):
        for c in range(3):
            out[r, c] = 1.5 * m[r, c]
            for k in range(3):
                out[r, c] -= 0.5 * m[r, k] * (m[0, k] * m[0, c] + m[1, k] * m[1, c] + m[2, k] * m[2, c])


@compiled
def median(values, count):
    """Return the median of the first `count` values, at least one, and reorder them."""
    # Hoare's selection; `np.median` takes two seconds to compile for each type of array.
    low, high, middle = 0, count - 1, count // 2
    while low < high:
        pivot, i, j = values[(low + high) // 2], low, high
        while i <= j:
            while values[i] < pivot:
                i += 1
            while pivot < values[j]:
                j -= 1
            if i <= j:
                values[i], values[j] = values[j], values[i]
                i += 1
                j -= 1
        if middle <= j:
            high = j
        elif middle >= i:
            low = i
        else:
            break
    if count % 2 == 1:
        return values[middle]
    below = values[0]
    for k in range(1, middle):
        below = max(below, values[k])
    return 0.5 * (below + values[middle])


@compiled
def rotate_by(rotation, vector, share):
    """Left-multiply a rotation matrix by the rotation of `share` times a vector (3,), in place."""
    w = share * vector[0], share * vector[1], share * vector[2]
    angle = np.sqrt(w[0] * w[0] + w[1] * w[1] + w[2] * w[2])
    a, b = 1.0, 0.5
    if angle > 1e-6:
        a, b = np.sin(angle) / angle, (1.0 - np.cos(angle)) / (angle * angle)
    # Rodrigues' formula column by column: r + a (w x r) + b (w x (w x r)).
    for c in range(3):
        x, y, z = rotation[0, c], rotation[1, c], rotation[2, c]
        p, q, r = w[1] * z - w[2] * y, w[2] * x - w[0] * z, w[0] * y - w[1] * x
        rotation[0, c] = x + a * p + b * (w[1] * r - w[2] * q)
        rotation[1, c] = y + a * q + b * (w[2] * p - w[0] * r)
        rotation[2, c] = z + a * r + b * (w[0] * q - w[1] * p)


@compiled
def _factor(a, ridge, band, upper, d):
    """Compute the Cholesky factor of a symmetric positive definite matrix (n, n), scaled by `d` (n,).

    Reads and writes the upper half only. Returns False where the matrix is not positive definite. `d` scales
    to a unit diagonal, because mm and radians differ by orders of magnitude; `ridge` is added to it. `band`
    (count, width): the first `count` unknowns are coupled only within `width`, and with all after `count`.
    """
    n = len(d)
    banded, wide = band
    for i in range(n):
        if not a[i, i] > 0.0:
            return False
        d[i] = 1.0 / np.sqrt(a[i, i])
    for i in range(n):
        row, source = upper[i], a[i]
        for k in range(i, min(i + wide, banded)):
            row[k] = source[k] * d[i] * d[k]
        for k in range(max(i, banded), n):
            row[k] = source[k] * d[i] * d[k]
        row[i] += ridge
    for i in range(n):
        row, end = upper[i], min(i + wide, banded)
        if not row[i] > 1e-13:
            return False
        row[i] = np.sqrt(row[i])
        unit = 1.0 / row[i]
        for k in range(i + 1, end):
            row[k] *= unit
        for k in range(max(i + 1, banded), n):
            row[k] *= unit
        for j in range(i + 1, end):
            to, by = upper[j], row[j]
            for k in range(j, end):
                to[k] -= by * row[k]
            for k in range(banded, n):
                to[k] -= by * row[k]
        for j in range(max(i + 1, banded), n):
            to, by = upper[j], row[j]
            for k in range(j, n):
                to[k] -= by * row[k]
    return True


@compiled
def _substitute(upper, d, band, g, out):
    """Solve for one right-hand side (n,) with a Cholesky factor, into `out`."""
    n = len(g)
    banded, wide = band
    for i in range(n):
        out[i] = g[i] * d[i]
    for i in range(n):
        row = upper[i]
        out[i] /= row[i]
        for k in range(i + 1, min(i + wide, banded)):
            out[k] -= row[k] * out[i]
        for k in range(max(i + 1, banded), n):
            out[k] -= row[k] * out[i]
    for i in range(n - 1, -1, -1):
        row, rest = upper[i], out[i]
        for k in range(i + 1, min(i + wide, banded)):
            rest -= row[k] * out[k]
        for k in range(max(i + 1, banded), n):
            rest -= row[k] * out[k]
        out[i] = rest / row[i]
    for i in range(n):
        out[i] *= d[i]


@compiled
def solve_banded(a, band, g, out):
    """Solve a x = g for a symmetric positive definite matrix (n, n) into `out`; False where it is not.

    Reads the upper half only. `band` as in `_factor`. NumPy's solver is not used, because in compiled code it
    raises on a singular matrix, does not detect an indefinite one, and took a third longer with few unknowns.
    """
    n = len(g)
    upper, d = np.empty((n, n)), np.empty(n)
    if not _factor(a, RIDGE, band, upper, d):
        return False
    _substitute(upper, d, band, g, out)
    return True


@compiled
def solve_positive(a, g, out):
    """Solve as `solve_banded` with a dense matrix."""
    return solve_banded(a, NO_BAND, g, out)


@compiled
def rotation_angle_between(a, b):
    """Return the angle 0..pi [rad] between two rotations (3, 3)."""
    # Of a times b transposed, the antisymmetric part gives the sine and the trace the cosine.
    x, y, z, trace = 0.0, 0.0, 0.0, 0.0
    for k in range(3):
        x += a[2, k] * b[1, k] - a[1, k] * b[2, k]
        y += a[0, k] * b[2, k] - a[2, k] * b[0, k]
        z += a[1, k] * b[0, k] - a[0, k] * b[1, k]
        trace += a[0, k] * b[0, k] + a[1, k] * b[1, k] + a[2, k] * b[2, k]
    return np.arctan2(0.5 * np.sqrt(x * x + y * y + z * z), 0.5 * (trace - 1.0))


@compiled
def is_plausible_foreshortening(squares, squared_area, min_ratio):
    """Return whether two sides of a parallelogram can be a square foreshortened to at least `min_ratio`.

    `squares` is the sum of their squared lengths. The ratio of the singular values is the cosine of the tilt.
    """
    root = np.sqrt(max(squares * squares - 4.0 * squared_area, 0.0))
    return squares - root > min_ratio * min_ratio * (squares + root)


@compiled
def pose_rows(matrix, order, band, ridge):
    """Return the first six rows (6, n) of the inverse of a positive matrix (n, n), and False without one.

    The first six unknowns are the pose, so the block (6, 6) is its marginal covariance. `order` (n,) is the
    elimination order, `band` the band structure in it. `ridge` is added to the scaled unit diagonal and
    bounds the variance of weakly determined unknowns.
    """
    n = len(matrix)
    upper, d, ordered = np.empty((n, n)), np.empty(n), np.empty((n, n))
    unit, out, rows = np.zeros(n), np.empty(n), np.empty((6, n))
    for i in range(n):
        for j in range(i, n):
            ordered[i, j] = matrix[order[i], order[j]]
    if not _factor(ordered, ridge, band, upper, d):
        return rows, False
    for i in range(n):
        if order[i] > 5:
            continue
        unit[i] = 1.0
        _substitute(upper, d, band, unit, out)
        unit[i] = 0.0
        for j in range(n):
            rows[order[i], order[j]] = out[j]
    for k in range(6):
        for m in range(k):
            rows[m, k] = rows[k, m] = 0.5 * (rows[m, k] + rows[k, m])
    return rows, True


@compiled
def add_products(rows, weights, count, workspace, a):
    """Add the weighted Gram matrix of `rows` (m, many), over the first `count` columns, to `a` (m, m).

    Row by row over many columns, so that the loops vectorise. `workspace` is (many,).
    """
    m = len(a)
    for i in range(m):
        own = rows[i]
        for k in range(count):
            workspace[k] = weights[k] * own[k]
        j = 0
        while j <= i:
            # Four at a time, to reuse the loaded values.
            b = rows[j], rows[min(j + 1, i)], rows[min(j + 2, i)], rows[min(j + 3, i)]
            total = products_of_four(workspace, b, count)
            for n in range(min(4, i + 1 - j)):
                a[i, j + n] += total[n]
            j += 4
    for i in range(m):
        for j in range(i):
            a[j, i] = a[i, j]


@compiled
def products_of_four(one, rows, count):
    """Return the dot products of one row (many,) with four others over the first `count` columns."""
    b0, b1, b2, b3 = rows
    s0, s1, s2, s3 = 0.0, 0.0, 0.0, 0.0
    for k in range(count):
        value = one[k]
        s0 += value * b0[k]
        s1 += value * b1[k]
        s2 += value * b2[k]
        s3 += value * b3[k]
    return s0, s1, s2, s3


@compiled
def mean_generalised_eigenvalue(a, b):
    """Return trace(inv(a) b) / n, the mean generalised eigenvalue; 0 where `a` is not positive definite."""
    n = len(a)
    upper, d, out = np.empty((n, n)), np.empty(n), np.empty(n)
    if not _factor(a, 0.0, NO_BAND, upper, d):
        return 0.0
    total = 0.0
    for k in range(n):
        _substitute(upper, d, NO_BAND, b[k], out)
        total += out[k]
    return total / n
