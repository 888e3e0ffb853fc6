"""The pose of a square from its four corners: both of its solutions."""

from dataclasses import dataclass

import cv2
import numpy as np

from tracker.camera import CameraModel
from tracker.geometry import Array, Camera, Marker, Rigid, nearest_rotation
from tracker.geometry.kernels import mirror
from tracker.pose.foreshortening.kernels import foreshortened
from tracker.pose.kernels import fit_square

# The closed form is within a few pixels; each round squares what is left.
FIT_ROUNDS = 6


def pose_from_corners(
    camera: CameraModel, corners_px: Array, *, side_mm: float
) -> Rigid[Camera, Marker] | None:
    """The pose that four corners (4, 2) are seen of; None when they are no square in front.

    Corners in the order top-left, top-right, bottom-right, bottom-left of the printed face. A small square
    has next to no perspective: what there is of it in its corners is mostly their error, and a homography's
    last row no measure of tilt. So the tilt is taken from how the middle is foreshortened, and both poses
    that foreshorten so are fitted to the corners.
    """
    h = side_mm / 2.0
    plane = np.array([[-h, h], [h, h], [h, -h], [-h, -h]], dtype=np.float32)
    corners = camera.normalised_from_px(corners_px)
    homography = np.asarray(cv2.getPerspectiveTransform(plane, corners.astype(np.float32)), dtype=np.float64)
    if not np.isfinite(homography).all():
        return None
    start = _foreshortened(homography)
    if start is None:
        return None
    best, least = None, np.inf
    for pose in (start, other_solution(start)):
        fitted = fitted_square(corners, pose, side_mm=side_mm)
        if fitted is not None and fitted.left < least:
            best, least = fitted, fitted.left
    return None if best is None else best.pose


@dataclass(frozen=True, slots=True)
class FittedSquare:
    """Where a fit to four corners ended, in front of the camera; `left` is the sum of squares that remain."""

    rotation: Array
    translation_mm: Array
    left: float

    @property
    def pose(self) -> Rigid[Camera, Marker]:
        """The same with its rotation free of rounding: made of the best one alone, as it takes its time."""
        return Rigid(rotation=nearest_rotation(self.rotation), translation_mm=self.translation_mm)


def fitted_square(corners: Array, start: Rigid[Camera, Marker], *, side_mm: float) -> FittedSquare | None:
    """The pose near a start at which a square's corners (4, 2) are seen on the plane at z = 1, if any is."""
    rotation, translation = start.rotation.copy(), start.translation_mm.copy()
    left = float(fit_square(corners, side_mm / 2.0, rotation, translation, FIT_ROUNDS))
    # The printed face looks at the camera, and the camera looks at the marker.
    facing = translation[2] > 0.0 and float(rotation[:, 2] @ translation) < 0.0
    return FittedSquare(rotation, translation, left) if facing and np.isfinite(left) else None


def _foreshortened(homography: Array) -> Rigid[Camera, Marker] | None:
    """A pose whose image is, to first order, that of a homography (3, 3) from the plane in mm, if any."""
    rotation, translation = np.empty((3, 3)), np.empty(3)
    if not foreshortened(homography, rotation, translation):
        return None
    return Rigid(rotation=nearest_rotation(rotation), translation_mm=translation)


def other_solution(pose: Rigid[Camera, Marker]) -> Rigid[Camera, Marker]:
    """The pose that looks the same as this one but for perspective: tilted the other way.

    Far away, the image of a plane depends on the tilt's amount and on the line it turns about, not on which
    half is nearer. In a frame whose z is the line of sight that is the reflection D R D, D = diag(1, 1, -1).
    """
    rotation = np.empty((3, 3))
    mirror(pose.rotation, pose.translation_mm, rotation)
    return Rigid(rotation=rotation, translation_mm=pose.translation_mm)
