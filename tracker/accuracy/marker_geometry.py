"""First-order effect of corner noise and of the focal length on the tip of a tool.

A pose that minimises the reprojection error of the four corners of a marker satisfies J dx + dp = 0 for a
small change dp of what the camera model projects. With the pseudo-inverse of J this gives the change dx of
the pose, and with the lever of the tip the change of the tip.
"""

from dataclasses import dataclass

import numpy as np

from tracker.camera import CameraModel
from tracker.geometry import Array, Camera, Marker, Rigid, skew

STEP_MM, STEP_RAD = 1e-3, 1e-6


@dataclass(frozen=True, slots=True, kw_only=True)
class TrackedTool:
    """Camera, marker and tip that an accuracy test examines together.

    Attributes:
        camera: camera model that the poses were computed with.
        side_mm: side of the marker.
        tip_in_marker_mm: (3,), the calibrated tip.
        tip_covariance_mm2: (3, 3), of the calibration of the tip; zero if unknown.
    """

    camera: CameraModel
    side_mm: float
    tip_in_marker_mm: Array
    tip_covariance_mm2: Array


@dataclass(frozen=True, slots=True, kw_only=True)
class TipSensitivity:
    """First-order sensitivity of the tip at one pose.

    Attributes:
        covariance_mm2_per_px2: (3, 3), covariance of the tip for corner noise of 1 px along each axis.
        focal_mm: (3,), displacement of the tip per relative error of the stated focal length.
    """

    covariance_mm2_per_px2: Array
    focal_mm: Array


def corners_mm(side_mm: float) -> Array:
    """Return the corners (4, 3) of a marker in its frame."""
    h = side_mm / 2.0
    return np.array([[-h, h, 0.0], [h, h, 0.0], [h, -h, 0.0], [-h, -h, 0.0]])


def pose_from_corner_shift(camera: CameraModel, side_mm: float, pose: Rigid[Camera, Marker]) -> Array:
    """Return the derivative (6, 8) of a pose to its corners in px.

    Translation first, then rotation as a small left-multiplied rotation vector, as in `Seen.pose_covariance`.
    """
    arms = corners_mm(side_mm) @ pose.rotation.T
    points = arms + pose.translation_mm
    steps = [*(STEP_MM * np.eye(3)), *(STEP_RAD * arms @ skew(axis).T for axis in np.eye(3))]
    sizes = [STEP_MM] * 3 + [STEP_RAD] * 3
    columns = [
        (camera.px_from_camera(points + step) - camera.px_from_camera(points - step)).ravel() / (2.0 * size)
        for step, size in zip(steps, sizes, strict=True)
    ]
    return np.asarray(np.linalg.pinv(np.stack(columns, axis=1)), dtype=float)


def tip_sensitivity(tool: TrackedTool, pose: Rigid[Camera, Marker]) -> TipSensitivity:
    """Return the sensitivity of the tip at a pose of the marker."""
    camera = tool.camera
    tip_from_pose = np.hstack([np.eye(3), -skew(pose.rotation @ tool.tip_in_marker_mm)])
    tip_from_px = tip_from_pose @ pose_from_corner_shift(camera, tool.side_mm, pose)
    px = camera.px_from_camera(pose.move_points(corners_mm(tool.side_mm)))
    from_centre_px = (px - camera.matrix[:2, 2]).ravel()
    return TipSensitivity(
        covariance_mm2_per_px2=tip_from_px @ tip_from_px.T, focal_mm=-tip_from_px @ from_centre_px
    )
