"""A capture of an accuracy test: the tip at rest in one divot, from the poses of its images."""

from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from tracker.errors import CalibrationError
from tracker.geometry import Array, Camera, Marker, Rigid, nearest_rotation
from tracker.geometry.rotations import vector_from_rotation
from tracker.pose.second_order import marker_point_covariance_mm2
from tracker.pose.tool import Poses


@dataclass(frozen=True, slots=True, kw_only=True)
class RestLimits:
    """Limits of the motion within one capture.

    Attributes:
        min_images: minimum number of different images.
        max_sd_mm: standard deviation of the tip along its worst axis.
        max_off_mm: largest distance of one image from the mean.
    """

    min_images: int = 5
    max_sd_mm: float = 1.0
    max_off_mm: float = 3.0


@dataclass(frozen=True, slots=True, kw_only=True)
class DivotCapture:
    """The tip at rest in one divot; one sample, however many images it is the mean of.

    Attributes:
        divot: name of the divot.
        placement: name of the placement of the plate; the plate did not move within it.
        posture: how the tool was held, such as "upright", "tilted" or "turned".
        camera_from_marker: mean pose of the tool's marker.
        tip_in_camera_mm: (3,), mean position of the tip.
        image_tip_in_camera_mm: (3,), position of the tip in the first image.
        covariance_mm2: (3, 3), stated by the tracker for this position, without the calibration of the tip;
            None if the poses have no covariance.
        jitter_covariance_mm2: (3, 3), scatter of the images about the mean.
        jitter_deg: RMS rotation of the images about their mean.
        images: number of different images.
    """

    divot: str
    placement: str
    posture: str
    camera_from_marker: Rigid[Camera, Marker]
    tip_in_camera_mm: Array
    image_tip_in_camera_mm: Array
    covariance_mm2: Array | None
    jitter_covariance_mm2: Array
    jitter_deg: float
    images: int

    @property
    def group(self) -> tuple[str, str]:
        """Return placement and divot, in which a position is the same."""
        return self.placement, self.divot

    @property
    def averaged_covariance_mm2(self) -> Array:
        """Return the covariance (3, 3) of the tip in a single image about the mean of the capture."""
        return np.asarray(self.jitter_covariance_mm2 * (1.0 - 1.0 / self.images))

    @property
    def title(self) -> str:
        """Return a short name for messages."""
        return f"divot {self.divot[:20]}, placement {self.placement[:20]}, {self.posture[:20]}"


def capture_at_rest(
    poses: Poses,
    tip_in_marker_mm: npt.ArrayLike,
    *,
    divot: str,
    placement: str,
    posture: str,
    limits: RestLimits | None = None,
) -> DivotCapture:
    """Return the capture of a tool at rest from the poses of its marker.

    The stated covariance is not divided by the number of images: errors of a tool at rest are correlated.

    Raises:
        CalibrationError: ACCURACY_CAPTURE_SHORT or ACCURACY_CAPTURE_MOVED.
    """
    limits = limits or RestLimits()
    tip = np.asarray(tip_in_marker_mm, dtype=np.float64)
    fresh = poses.of(~poses.repeats)
    name = f"divot {divot[:20]}, placement {placement[:20]}, {posture[:20]}"
    if len(fresh) < limits.min_images:
        raise CalibrationError(
            "ACCURACY_CAPTURE_SHORT",
            f"the capture {name} has {len(fresh)} different images, needed {limits.min_images}",
            "Hold the tip in the divot longer, and record this capture again.",
            {"capture": name, "images": len(fresh), "needed": limits.min_images},
        )
    tips = fresh.points_mm(tip)
    mean = tips.mean(axis=0)
    scatter = np.cov(tips.T)
    sd_mm = float(np.sqrt(max(np.linalg.eigvalsh(scatter)[-1], 0.0)))
    off_mm = float(np.linalg.norm(tips - mean, axis=1).max())
    if not (sd_mm <= limits.max_sd_mm and off_mm <= limits.max_off_mm):
        raise CalibrationError(
            "ACCURACY_CAPTURE_MOVED",
            f"the tip moved in the capture {name}: standard deviation {sd_mm:.2f} mm, allowed "
            f"{limits.max_sd_mm:g} mm; {off_mm:.2f} mm from the mean at most, allowed "
            f"{limits.max_off_mm:g} mm",
            "Rest the hand, hold the tip still in the divot, and record this capture again.",
            {
                "capture": name,
                "sd_mm": sd_mm,
                "allowed_mm": limits.max_sd_mm,
                "off_mm": off_mm,
                "allowed_off_mm": limits.max_off_mm,
            },
        )
    rotation = nearest_rotation(fresh.rotations.mean(axis=0))
    pose: Rigid[Camera, Marker] = Rigid(rotation=rotation, translation_mm=fresh.translations_mm.mean(axis=0))
    angles = np.array([np.linalg.norm(vector_from_rotation(one @ rotation.T)) for one in fresh.rotations])
    covariance = None
    if fresh.covariances is not None:
        stated = [marker_point_covariance_mm2(pose, one, tip) for one in fresh.covariances]
        covariance = np.mean(stated, axis=0)
    return DivotCapture(
        divot=divot,
        placement=placement,
        posture=posture,
        camera_from_marker=pose,
        tip_in_camera_mm=mean,
        image_tip_in_camera_mm=tips[0],
        covariance_mm2=covariance,
        jitter_covariance_mm2=scatter,
        jitter_deg=float(np.degrees(np.sqrt((angles**2).sum() / (len(angles) - 1)))),
        images=len(fresh),
    )
