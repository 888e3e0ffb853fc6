"""The pose of a square from its four corners: both of its solutions."""

import cv2
import numpy as np

from tracker.camera import CameraModel
from tracker.geometry import Array, Camera, Marker, Rigid
from tracker.pose.kernels import mirror


def pose_from_corners(
    camera: CameraModel, corners_px: Array, *, side_mm: float
) -> Rigid[Camera, Marker] | None:
    """The pose that the homography of four corners (4, 2) gives; None when they are no square in front.

    Corners in the order top-left, top-right, bottom-right, bottom-left of the printed face.
    """
    h = side_mm / 2.0
    plane = np.array([[-h, h], [h, h], [h, -h], [-h, -h]], dtype=np.float32)
    image = camera.normalised_from_px(corners_px).astype(np.float32)
    homography = np.asarray(cv2.getPerspectiveTransform(plane, image), dtype=np.float64)
    if not np.isfinite(homography).all():
        return None
    scale = (float(np.linalg.norm(homography[:, 0])) + float(np.linalg.norm(homography[:, 1]))) / 2.0
    if scale < 1e-12:
        return None
    columns = homography / (scale if homography[2, 2] > 0.0 else -scale)
    (ax, bx, x), (ay, by, y), (az, bz, z) = columns.tolist()
    across = [[ax, bx, ay * bz - az * by], [ay, by, az * bx - ax * bz], [az, bz, ax * by - ay * bx]]
    u, _, vt = np.linalg.svd(np.array(across))
    if np.linalg.det(u @ vt) < 0.0:
        u[:, 2] = -u[:, 2]
    rotation, translation = u @ vt, np.array([x, y, z])
    # The printed face looks at the camera, and the camera looks at the marker.
    if translation[2] <= 0.0 or float(rotation[:, 2] @ translation) >= 0.0:
        return None
    return Rigid(rotation=rotation, translation_mm=translation)


def other_solution(pose: Rigid[Camera, Marker]) -> Rigid[Camera, Marker]:
    """The pose that looks the same as this one but for perspective: tilted the other way.

    Far away, the image of a plane depends on the tilt's amount and on the line it turns about, not on which
    half is nearer. In a frame whose z is the line of sight that is the reflection D R D, D = diag(1, 1, -1).
    """
    rotation = np.empty((3, 3))
    mirror(pose.rotation, pose.translation_mm, rotation)
    return Rigid(rotation=rotation, translation_mm=pose.translation_mm)
