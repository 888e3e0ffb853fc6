"""Cameras of the scenes: the paper's, with a small distant marker, and a modern one."""

from dataclasses import dataclass, replace

import cv2
import numpy as np
import numpy.typing as npt

from tracker import CameraModel
from tracker.geometry import Array, Camera, Marker, Rigid

BENT = (-0.21, 0.07, 0.0005, -0.0006, 0.0)


@dataclass(frozen=True, slots=True, kw_only=True)
class Rig:
    """A camera and the distance of its marker.

    Attributes:
        name: "A", "B", ...
        size_wh_px: of its images.
        focal_px: the same in both directions; the principal point is the middle of the image.
        distortion: k1, k2, p1, p2, k3 as OpenCV has them.
        depth_mm: least and most distance of the marker.
    """

    name: str
    size_wh_px: tuple[int, int]
    focal_px: float
    depth_mm: tuple[float, float]
    distortion: tuple[float, ...] = (0.0, 0.0, 0.0, 0.0, 0.0)

    @property
    def is_small(self) -> bool:
        """Return whether a marker is some 27 px wide, not some 70."""
        return self.size_wh_px[0] < 1200

    @property
    def is_bent(self) -> bool:
        """Return whether the lens has distortion."""
        return any(self.distortion)

    @property
    def matrix(self) -> Array:
        """Return OpenCV's camera matrix (3, 3)."""
        width, height = self.size_wh_px
        f = self.focal_px
        return np.array([[f, 0.0, (width - 1) / 2], [0.0, f, (height - 1) / 2], [0.0, 0.0, 1.0]])

    @property
    def camera(self) -> CameraModel:
        """Return the camera model for the tracker."""
        return CameraModel(
            matrix=self.matrix, distortion=np.array(self.distortion), size_wh_px=self.size_wh_px
        )

    def px_of(self, pose: Rigid[Camera, Marker], points_mm: npt.ArrayLike) -> Array:
        """Project points (n, 3) of the marker to pixels (n, 2) with OpenCV."""
        seen, _ = cv2.projectPoints(
            np.asarray(points_mm, dtype=np.float64).reshape(-1, 1, 3),
            cv2.Rodrigues(pose.rotation)[0],
            np.array(pose.translation_mm),
            self.matrix,
            np.array(self.distortion),
        )
        return np.asarray(seen, dtype=np.float64).reshape(-1, 2)

    def sight_through(self, at_px: npt.ArrayLike) -> Array:
        """Return the unit viewing direction (3,) of a pixel."""
        points = np.asarray(at_px, dtype=np.float64).reshape(1, 1, 2)
        x, y = cv2.undistortPoints(points, self.matrix, np.array(self.distortion)).reshape(2)
        sight = np.array([x, y, 1.0])
        return np.asarray(sight / np.linalg.norm(sight), dtype=np.float64)

    def bent(self) -> "Rig":
        """Return the same camera with lens distortion."""
        return replace(self, distortion=BENT)


RIG_A = Rig(name="A", size_wh_px=(768, 576), focal_px=1028.0, depth_mm=(900.0, 1000.0))
RIG_B = Rig(name="B", size_wh_px=(1920, 1080), focal_px=1400.0, depth_mm=(350.0, 600.0))
RIGS = {"A": RIG_A, "B": RIG_B}
# Two sizes between and below, for time by resolution.
RIG_VGA = Rig(name="VGA", size_wh_px=(640, 480), focal_px=860.0, depth_mm=(900.0, 1000.0))
RIG_HD = Rig(name="HD", size_wh_px=(1280, 720), focal_px=1100.0, depth_mm=(400.0, 700.0))
