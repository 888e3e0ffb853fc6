"""Rigid transforms `Rigid[To, From]` between coordinate frames, and covariance propagation."""

from dataclasses import dataclass
from math import isfinite
from typing import Generic, TypeVar

import numpy as np
import numpy.typing as npt

from tracker.errors import InvalidInput
from tracker.geometry.rotations import Array, orthonormality_error, rotation_from_vector, skew

To = TypeVar("To")
From = TypeVar("From")
Other = TypeVar("Other")

# A rotation read from a file with six digits deviates by 1e-6; a deviation of 0.01 is not rounding.
ORTHONORMAL_TOLERANCE = 1e-3


@dataclass(frozen=True, slots=True, kw_only=True)
class Rigid(Generic[To, From]):
    """Rigid transform from frame `From` to frame `To`: x_to = rotation @ x_from + translation_mm.

    Named `<to>_from_<from>` in code (`camera_from_marker`); in a product, equal names are adjacent.

    Attributes:
        rotation: (3, 3), orthonormal, determinant +1.
        translation_mm: (3,), the origin of `From` in `To`.

    Raises:
        InvalidInput: ROTATION_INVALID, the matrix is not a rotation or a number is not finite.
    """

    rotation: Array
    translation_mm: Array

    def __post_init__(self) -> None:
        rotation = np.array(self.rotation, dtype=np.float64, order="C").reshape(3, 3)
        translation = np.array(self.translation_mm, dtype=np.float64, order="C").reshape(3)
        off, determinant = orthonormality_error(rotation)
        if not all(map(isfinite, translation.tolist())) or off > ORTHONORMAL_TOLERANCE or determinant < 0.0:
            raise InvalidInput(
                "ROTATION_INVALID",
                f"a pose is not a rigid motion: its rotation deviates from orthonormal by {off:.3g}, "
                f"allowed {ORTHONORMAL_TOLERANCE:g}, and all numbers must be finite",
                "Check the source of this 4x4 matrix: no scale, no reflection, row-major order.",
                {"off_orthonormal": off, "allowed": ORTHONORMAL_TOLERANCE},
            )
        rotation.setflags(write=False)
        translation.setflags(write=False)
        object.__setattr__(self, "rotation", rotation)
        object.__setattr__(self, "translation_mm", translation)

    @classmethod
    def identity(cls) -> "Rigid[To, From]":
        """Return the identity transform."""
        return cls(rotation=np.eye(3), translation_mm=np.zeros(3))

    @classmethod
    def from_matrix(cls, matrix: npt.ArrayLike) -> "Rigid[To, From]":
        """Create from a homogeneous (4, 4) matrix."""
        m = np.asarray(matrix, dtype=np.float64).reshape(4, 4)
        return cls(rotation=m[:3, :3], translation_mm=m[:3, 3])

    @classmethod
    def from_vector(cls, rotation_rad: npt.ArrayLike, translation_mm: npt.ArrayLike) -> "Rigid[To, From]":
        """Create from a rotation vector (3,) in radians and a translation (3,) in mm."""
        return cls(
            rotation=rotation_from_vector(rotation_rad),
            translation_mm=np.asarray(translation_mm, dtype=np.float64),
        )

    @property
    def matrix(self) -> Array:
        """Return the homogeneous matrix (4, 4)."""
        m = np.eye(4)
        m[:3, :3], m[:3, 3] = self.rotation, self.translation_mm
        return m

    @property
    def inverse(self) -> "Rigid[From, To]":
        """Return the inverse transform, from `To` to `From`."""
        return Rigid(rotation=self.rotation.T, translation_mm=-self.rotation.T @ self.translation_mm)

    def __matmul__(self, other: "Rigid[From, Other]") -> "Rigid[To, Other]":
        """Compose transforms: `a_from_b @ b_from_c` is `a_from_c`."""
        return Rigid(
            rotation=self.rotation @ other.rotation,
            translation_mm=self.rotation @ other.translation_mm + self.translation_mm,
        )

    def displaced(self, step: Array) -> "Rigid[To, From]":
        """Return the transform after a small step, in the convention of its covariances.

        Args:
            step: (6,) [mm, rad]; translation first, then a rotation vector, multiplied from the left in `To`.
        """
        return Rigid(
            rotation=rotation_from_vector(step[3:]) @ self.rotation,
            translation_mm=self.translation_mm + step[:3],
        )

    def move_points(self, points_mm: npt.ArrayLike) -> Array:
        """Transform points (..., 3) in mm from frame `From` to frame `To`."""
        return np.asarray(points_mm, dtype=np.float64) @ self.rotation.T + self.translation_mm

    def rotate_directions(self, directions: npt.ArrayLike) -> Array:
        """Rotate directions (..., 3) from frame `From` to frame `To`, without translation."""
        return np.asarray(directions, dtype=np.float64) @ self.rotation.T


def point_covariance_mm2(
    transform: Rigid[To, From], pose_covariance: npt.ArrayLike, point_mm: npt.ArrayLike
) -> Array:
    """Return the covariance (3, 3) in mm^2, in `To`, of a point (3,) fixed in `From`.

    `pose_covariance` is (6, 6) [mm, rad], of an error of the translation t, then of the rotation R as a small
    rotation vector w multiplied from the left in `To`: the point p moves by dt + w x (R p). The arm begins at
    the origin of `From`, not of `To`. First order: valid for small angles (under about 5 degrees).
    """
    arm = transform.rotate_directions(point_mm)
    jacobian = np.hstack([np.eye(3), -skew(arm)])
    return np.asarray(jacobian @ np.asarray(pose_covariance, dtype=np.float64) @ jacobian.T)


def chained_covariance(
    first: Rigid[To, From], of_first: npt.ArrayLike, second: Rigid[From, Other], of_second: npt.ArrayLike
) -> Array:
    """Return the covariance (6, 6) of `first @ second` from independent covariances of both.

    All three as in `point_covariance_mm2`, each in the `To` frame of its transform.
    """
    outer, inner = product_jacobians(first, second)
    near, far = np.asarray(of_first, dtype=np.float64), np.asarray(of_second, dtype=np.float64)
    return np.asarray(outer @ near @ outer.T + inner @ far @ inner.T)


def product_jacobians(first: Rigid[To, From], second: Rigid[From, Other]) -> tuple[Array, Array]:
    """Return the Jacobians (6, 6) of the product by errors (6) of the first and of the second transform."""
    outer, inner = np.eye(6), np.zeros((6, 6))
    outer[:3, 3:] = -skew(first.rotate_directions(second.translation_mm))
    inner[:3, :3] = inner[3:, 3:] = first.rotation
    return outer, inner


def inverse_jacobian(transform: Rigid[To, From]) -> Array:
    """Return the Jacobian (6, 6) of `transform.inverse` by errors (6) of `transform`."""
    back = -transform.rotation.T
    jacobian = np.zeros((6, 6))
    jacobian[:3, :3] = jacobian[3:, 3:] = back
    jacobian[:3, 3:] = back @ skew(transform.translation_mm)
    return jacobian


def inverse_covariance(transform: Rigid[To, From], covariance: npt.ArrayLike) -> Array:
    """Return the covariance (6, 6) of `transform.inverse` from that of `transform`."""
    jacobian = inverse_jacobian(transform)
    return np.asarray(jacobian @ np.asarray(covariance, dtype=np.float64) @ jacobian.T)
