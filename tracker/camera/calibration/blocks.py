"""Information of each view about the shared parameters, with its pose marginalised (Schur complement)."""

from collections.abc import Sequence
from dataclasses import dataclass

import cv2
import numpy as np

from tracker.camera.calibration.fit import Fit
from tracker.camera.detection.view import BoardView
from tracker.geometry import Array


@dataclass(frozen=True, slots=True, kw_only=True)
class Block:
    """One view in the normal equations of the shared parameters.

    Attributes:
        information: (p, p), in units of 1 / px2 before scaling by the noise.
        gradient: (p,), right-hand side of the normal equations.
        squares_px2: sum of its squared residuals.
        coordinates: number of measured coordinates (two per point).
        own: number of parameters of this view only (its pose).
    """

    information: Array
    gradient: Array
    squares_px2: float
    coordinates: int
    own: int


def reduced(shared: Array, own: Array, residuals: Array) -> Block:
    """Return a view's block from its Jacobians (m, p) by the shared and (m, q) by its own parameters."""
    # Orthogonal projection (QR), because normal equations would lose half the digits.
    basis, _ = np.linalg.qr(own)
    left = shared - basis @ (basis.T @ shared)
    return Block(
        information=left.T @ left,
        gradient=left.T @ residuals,
        squares_px2=float(residuals @ residuals),
        coordinates=len(residuals),
        own=own.shape[1],
    )


def blocks_of(fit: Fit, views: Sequence[BoardView]) -> list[Block]:
    """Return the block of each view of one camera; fx, fy, cx, cy and the distortion are shared."""
    blocks = []
    for view, r, t, residuals in zip(
        views, fit.rotations_rad, fit.translations_mm, fit.residuals_px, strict=True
    ):
        by_pose, by_camera = derivatives(view.object_points_mm, r, t, fit.matrix, fit.distortion)
        blocks.append(reduced(by_camera, by_pose, residuals.ravel()))
    return blocks


def derivatives(
    points_mm: Array, rotation_rad: Array, translation_mm: Array, matrix: Array, lens: Array
) -> tuple[Array, Array]:
    """Return the Jacobians of projected points (2n,) by the pose (2n, 6) and the camera (2n, 4 + k)."""
    _, derivative = cv2.projectPoints(points_mm.reshape(-1, 1, 3), rotation_rad, translation_mm, matrix, lens)
    by: Array = np.asarray(derivative, dtype=np.float64)
    return by[:, :6], by[:, 6 : 10 + lens.size]


def total_information(blocks: Sequence[Block]) -> Array:
    """Return the sum of the information (p, p) over all views."""
    return np.asarray(sum(block.information for block in blocks))


def inverse(information: Array) -> Array:
    """Return the inverse of an information matrix whose units differ by powers of ten."""
    scale = 1.0 / np.sqrt(np.maximum(np.diag(information), 1e-300))
    scaled = information * scale[:, None] * scale[None, :]
    return np.asarray(np.linalg.pinv(scaled, rcond=1e-14, hermitian=True) * scale[:, None] * scale[None, :])
