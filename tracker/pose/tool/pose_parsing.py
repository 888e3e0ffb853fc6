"""Parse a pose from a file: validate that it is a rigid motion, and convert it to millimetres."""

import numpy as np
import numpy.typing as npt

from tracker.errors import InvalidInput
from tracker.geometry import Array, Camera, Marker, Rigid

# A rotation rounded to three decimals deviates by 1e-3 in each number; a larger deviation is not rounding.
ROUNDING = 5e-3
LAST_ROW = np.array([0.0, 0.0, 0.0, 1.0])
MATRIX_REMEDY = (
    "Each pose is a 4x4 matrix that maps points from the marker's frame to the camera's: rotation on the "
    "left, translation in the last column, 0 0 0 1 in the last row."
)


def rigid_from_matrix(matrix: npt.ArrayLike, *, unit_mm: float = 1.0) -> Rigid[Camera, Marker]:
    """Return the rigid motion of a matrix (4, 4) or (3, 4) whose translation is in units of `unit_mm`.

    A rotation that deviates by rounding is orthonormalised; a larger deviation is rejected.

    Raises:
        InvalidInput: POSE_MATRIX_INVALID, with what is wrong with it.
    """
    given = np.asarray(matrix, dtype=np.float64)
    if given.shape not in {(3, 4), (4, 4)}:
        raise _invalid(f"its shape is {given.shape}, needed (4, 4)")
    if not np.isfinite(given).all():
        raise _invalid(f"{int((~np.isfinite(given)).sum())} of its numbers are not finite")
    if given.shape == (4, 4) and not np.allclose(given[3], LAST_ROW, atol=1e-6):
        if np.allclose(given[:, 3], LAST_ROW, atol=1e-6):
            raise _invalid("it is transposed: its translation is in the last row")
        raise _invalid(f"its last row is {_numbers(given[3])}, needed 0 0 0 1")
    return Rigid(rotation=_nearest_rotation(given[:3, :3]), translation_mm=given[:3, 3] * unit_mm)


def rigid_from_quaternion(
    quaternion_wxyz: npt.ArrayLike, translation: npt.ArrayLike, *, unit_mm: float = 1.0
) -> Rigid[Camera, Marker]:
    """Return the rigid motion of a quaternion (4,), w first, and a translation (3,) in units of `unit_mm`.

    Raises:
        InvalidInput: POSE_MATRIX_INVALID, with what is wrong with it.
    """
    w, x, y, z = (float(number) for number in np.asarray(quaternion_wxyz, dtype=np.float64))
    length = float(np.sqrt(w * w + x * x + y * y + z * z))
    if not abs(length - 1.0) <= ROUNDING:
        raise _invalid(f"the length of its quaternion is {length:.4g}, needed 1")
    w, x, y, z = w / length, x / length, y / length, z / length
    rotation = [
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ]
    column = np.asarray(translation, dtype=np.float64).reshape(3, 1)
    return rigid_from_matrix(np.hstack([np.array(rotation), column]), unit_mm=unit_mm)


def _nearest_rotation(given: Array) -> Array:
    left, sizes, right = np.linalg.svd(given)
    if float(np.linalg.det(given)) < 0.0:
        raise _invalid("its rotation is a reflection (its determinant is negative)")
    scale = float(sizes.mean())
    if float(np.ptp(sizes)) <= ROUNDING * scale < scale and abs(scale - 1.0) > ROUNDING:
        raise _invalid(f"it scales by {scale:.4g}, needed 1")
    off = float(np.abs(sizes - 1.0).max())
    if off > ROUNDING:
        raise _invalid(f"its rotation deviates from orthonormal by {off:.2g}, allowed {ROUNDING:g}")
    return np.asarray(left @ right)


def _numbers(row: Array) -> str:
    return " ".join(f"{number:.4g}" for number in row)


def _invalid(what: str) -> InvalidInput:
    return InvalidInput(
        "POSE_MATRIX_INVALID",
        f"a pose is not a rigid motion: {what}",
        MATRIX_REMEDY,
        {"pose_problem": what},
    )
