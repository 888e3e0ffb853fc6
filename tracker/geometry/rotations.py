"""Rotations as 3x3 matrices and as rotation vectors (axis times angle in radians)."""

from math import atan2, hypot, inf, isfinite

import numpy as np
import numpy.typing as npt

from tracker.geometry.geometry_kernels import orthonormalise

Array = npt.NDArray[np.float64]
# Deviation from orthonormal below which it is a rounding error.
ROUNDING = 1e-7


def skew(vector: npt.ArrayLike) -> Array:
    """Return the skew-symmetric matrix (3, 3) whose product with `a` is the cross product `vector x a`."""
    x, y, z = np.asarray(vector, dtype=np.float64)
    return np.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])


def rotation_from_vector(vector_rad: npt.ArrayLike) -> Array:
    """Return the rotation matrix (3, 3) of a rotation vector (3,) in radians, by Rodrigues' formula."""
    v = np.asarray(vector_rad, dtype=np.float64)
    angle = float(np.linalg.norm(v))
    k = skew(v)
    # Series below 1e-4 rad: the quotients lose their digits there, and the next term is under 1e-17.
    if angle < 1e-4:
        a, b = 1.0 - angle**2 / 6.0, 0.5 - angle**2 / 24.0
    else:
        a, b = np.sin(angle) / angle, (1.0 - np.cos(angle)) / angle**2
    return np.eye(3) + a * k + b * (k @ k)


def vector_from_rotation(rotation: npt.ArrayLike) -> Array:
    """Return the rotation vector (3,) in radians, length 0..pi, of a rotation matrix (3, 3)."""
    r = np.asarray(rotation, dtype=np.float64)
    # Python floats: NumPy is far slower on so few numbers, and this runs for each image.
    (a, b, c), (d, e, f), (g, h, i) = r.tolist()
    x, y, z = (h - f) / 2.0, (c - g) / 2.0, (d - b) / 2.0
    sine, cosine = hypot(x, y, z), (a + e + i - 1.0) / 2.0
    # atan2 of both, because arccos loses half its digits near zero degrees.
    angle = atan2(sine, cosine)
    w = np.array([x, y, z])
    if sine > 1e-7:
        return w * (angle / sine)
    if cosine > 0.0:
        return w
    # At 180 degrees the antisymmetric part vanishes, and the axis is a column of the symmetric part.
    s = (r + np.eye(3)) / 2.0
    axis = s[:, int(np.argmax(np.diag(s)))]
    axis = axis / np.linalg.norm(axis)
    return axis * angle * (1.0 if float(axis @ w) >= 0.0 else -1.0)


def rotation_between(a: npt.ArrayLike, b: npt.ArrayLike) -> Array:
    """Return the smallest rotation (3, 3) that takes direction `a` to direction `b`."""
    p = np.asarray(a, dtype=np.float64) / np.linalg.norm(a)
    q = np.asarray(b, dtype=np.float64) / np.linalg.norm(b)
    axis = np.cross(p, q)
    sine, cosine = float(np.linalg.norm(axis)), float(p @ q)
    if sine < 1e-12:
        if cosine > 0.0:
            return np.eye(3)
        other = np.eye(3)[int(np.argmin(np.abs(p)))]
        normal = np.cross(p, other)
        return rotation_from_vector(normal / np.linalg.norm(normal) * np.pi)
    return rotation_from_vector(axis / sine * np.arctan2(sine, cosine))


def rotation_from_half_axes(half_axes: npt.ArrayLike) -> Array:
    """Return the rotation (3, 3) whose columns are the directions of an ellipsoid's half axes.

    Args:
        half_axes: (3, 3), perpendicular rows, the longest first. Rows of length 0 get a direction that
            completes a right-handed frame; the sign of a direction is arbitrary.
    """
    directions, _ = np.linalg.qr(np.asarray(half_axes, dtype=np.float64).T + 1e-12 * np.eye(3))
    directions[:, 2] *= np.sign(np.linalg.det(directions))
    return np.asarray(directions)


def orthonormality_error(matrix: Array) -> tuple[float, float]:
    """Return the largest deviation of a matrix (3, 3) from orthonormal columns, and its determinant.

    The deviation of a matrix with a number that is not finite is infinite.
    """
    # Python floats: the first call of a compiled loop takes a fifth of a second, and the web server makes no
    # other one at its start.
    (a, b, c), (d, e, f), (g, h, i) = matrix.tolist()
    x, y, z = a * a + d * d + g * g - 1.0, b * b + e * e + h * h - 1.0, c * c + f * f + i * i - 1.0
    p, q, r = a * b + d * e + g * h, a * c + d * f + g * i, b * c + e * f + h * i
    off = max(abs(x), abs(y), abs(z), abs(p), abs(q), abs(r)) if isfinite(x + y + z + p + q + r) else inf
    return off, a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)


def nearest_rotation(matrix: npt.ArrayLike) -> Array:
    """Return the rotation (3, 3) nearest to a matrix that is nearly a rotation (orthogonal Procrustes)."""
    given = np.array(matrix, dtype=np.float64, order="C")
    if orthonormality_error(given)[0] < ROUNDING:
        straight = np.empty((3, 3))
        orthonormalise(given, straight)
        return straight
    u, _, vt = np.linalg.svd(given)
    return np.asarray(u @ vt)


def angle_between_deg(a: npt.ArrayLike, b: npt.ArrayLike) -> float:
    """Return the angle 0..180 degrees between two directions (3,)."""
    p, q = np.asarray(a, dtype=np.float64), np.asarray(b, dtype=np.float64)
    # atan2 of cross and dot, because arccos loses half its digits near zero degrees,
    # which is exactly where the surgeon works.
    return float(np.degrees(np.arctan2(np.linalg.norm(np.cross(p, q)), p @ q)))
