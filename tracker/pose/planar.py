"""Planar pose estimation (PnP) of a square from its four corners, with both solutions."""

from dataclasses import dataclass

import cv2
import numpy as np

from tracker.camera import CameraModel
from tracker.geometry import Array, Camera, Marker, Rigid, nearest_rotation
from tracker.geometry.geometry_kernels import mirror
from tracker.pose.pose_kernels import fit_square, pose_from_foreshortening

# The closed form is accurate to a few pixels, and Gauss-Newton converges quadratically.
FIT_ROUNDS = 6


def pose_from_corners(
    camera: CameraModel, corners_px: Array, *, side_mm: float
) -> Rigid[Camera, Marker] | None:
    """Return the pose of a square with these corners (4, 2) in px; None when no pose before the camera fits.

    Corners are in the order top-left, top-right, bottom-right, bottom-left of the printed face. The
    perspective of a small square is mostly noise, so the last row of the homography does not determine the
    tilt. The tilt is estimated from the foreshortening at the centre, and both poses with that foreshortening
    are fitted to the corners.
    """
    h = side_mm / 2.0
    plane = np.array([[-h, h], [h, h], [h, -h], [-h, -h]], dtype=np.float32)
    corners = camera.normalised_from_px(corners_px)
    homography = np.asarray(cv2.getPerspectiveTransform(plane, corners.astype(np.float32)), dtype=np.float64)
    if not np.isfinite(homography).all():
        return None
    start = _foreshortening_start(homography)
    if start is None:
        return None
    best, minimum = None, np.inf
    for pose in (start, flipped_pose(start)):
        fitted = fit_square_pose(corners, pose, side_mm=side_mm)
        if fitted is not None and fitted.left < minimum:
            best, minimum = fitted, fitted.left
    return None if best is None else best.pose


@dataclass(frozen=True, slots=True)
class SquareFit:
    """Result of a pose fit to four corners; `left` is the residual sum of squares on the plane z = 1."""

    rotation: Array
    translation_mm: Array
    left: float

    @property
    def pose(self) -> Rigid[Camera, Marker]:
        """Return the pose with an orthonormal rotation. Computed on access, because it is slow."""
        return Rigid(rotation=nearest_rotation(self.rotation), translation_mm=self.translation_mm)


def fit_square_pose(corners: Array, start: Rigid[Camera, Marker], *, side_mm: float) -> SquareFit | None:
    """Return the pose near `start` fitted to corners (4, 2) on the plane z = 1; None where the fit fails."""
    rotation, translation = start.rotation.copy(), start.translation_mm.copy()
    left = float(fit_square(corners, side_mm / 2.0, rotation, translation, FIT_ROUNDS))
    # The printed face is towards the camera, and the marker is in front of it.
    facing = translation[2] > 0.0 and float(rotation[:, 2] @ translation) < 0.0
    return SquareFit(rotation, translation, left) if facing and np.isfinite(left) else None


def _foreshortening_start(homography: Array) -> Rigid[Camera, Marker] | None:
    """Return the pose whose projection equals a homography (3, 3) from mm to first order, or None."""
    rotation, translation = np.empty((3, 3)), np.empty(3)
    if not pose_from_foreshortening(homography, rotation, translation):
        return None
    return Rigid(rotation=nearest_rotation(rotation), translation_mm=translation)


def flipped_pose(pose: Rigid[Camera, Marker]) -> Rigid[Camera, Marker]:
    """Return the other planar solution, with the opposite tilt and the same image under weak perspective.

    In a frame whose z is the line of sight it is the reflection D R D, D = diag(1, 1, -1): under weak
    perspective, the image depends on the amount and the axis of the tilt, but not on its sign.
    """
    rotation = np.empty((3, 3))
    mirror(pose.rotation, pose.translation_mm, rotation)
    return Rigid(rotation=rotation, translation_mm=pose.translation_mm)
