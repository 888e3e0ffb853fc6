"""Prior knowledge of the camera: tilt and distance from a ruler, and touched points."""

from dataclasses import dataclass, field
from enum import StrEnum

import numpy as np
import numpy.typing as npt

from tracker.camera import CameraModel
from tracker.camera.ruler import axial_distance_mm
from tracker.errors import InvalidInput
from tracker.geometry import Array


class PatientEnd(StrEnum):
    """From which end of the patient the camera looks."""

    FEET = "feet"
    HEAD = "head"


@dataclass(frozen=True, slots=True, kw_only=True)
class TouchedPoint:
    """A point of the plan captured with the tool's tip; it determines the depth.

    Attributes:
        name: of the landmark.
        point_lps_mm: (3,), in the plan.
        point_in_camera_mm: (3,), captured tip position.
        covariance_mm2: (3, 3), camera frame, of the capture. If it has the name of a needle, the tip was at
            that needle's entry, and the error of its placement is added there; otherwise include the
            landmark's own error.
    """

    name: str
    point_lps_mm: Array
    point_in_camera_mm: Array
    covariance_mm2: Array

    def __post_init__(self) -> None:
        for name, shape in (("point_lps_mm", 3), ("point_in_camera_mm", 3), ("covariance_mm2", (3, 3))):
            array = np.array(getattr(self, name), dtype=np.float64).reshape(shape)
            array.setflags(write=False)
            object.__setattr__(self, name, array)


@dataclass(frozen=True, slots=True, kw_only=True)
class ViewPrior:
    """Tilt and distance of the camera from a ruler, with their uncertainty.

    Attributes:
        rotation: (3, 3), camera from vertebra.
        rotation_covariance: (3, 3) rad^2, of a small rotation multiplied from the left (camera frame).
        distance_mm: from the camera's centre to the centroid of the planned needles.
        distance_sd_mm: standard deviation of the distance.
        touched: points captured with the tool's tip; none without a tool.
    """

    rotation: Array
    rotation_covariance: Array
    distance_mm: float
    distance_sd_mm: float
    touched: tuple[TouchedPoint, ...] = field(default=())

    def __post_init__(self) -> None:
        for name in ("rotation", "rotation_covariance"):
            array = np.array(getattr(self, name), dtype=np.float64).reshape(3, 3)
            array.setflags(write=False)
            object.__setattr__(self, name, array)
        smallest = float(np.linalg.eigvalsh(self.rotation_covariance).min())
        numbers = np.array([self.distance_mm, self.distance_sd_mm, smallest])
        if not (np.isfinite(numbers).all() and (numbers > 0.0).all()):
            raise InvalidInput(
                "VIEW_INVALID",
                f"the camera is {self.distance_mm:g} mm away with a spread of {self.distance_sd_mm:g} mm; "
                "needed above 0",
                "Measure V and H from the camera to the patient, and give their accuracy.",
                {"distance_mm": self.distance_mm, "distance_sd_mm": self.distance_sd_mm},
            )


@dataclass(frozen=True, slots=True, kw_only=True)
class RulerMeasurement:
    """Ruler measurements of a camera above and beside a prone patient (paper, 2.2 and figure 2).

    Attributes:
        vertical_mm: V, height of the camera above the vertebra.
        horizontal_mm: H, its horizontal distance.
        azimuth_deg: its direction seen from above: 0 in line with the spine, positive to the left side.
        patient_end: at which end of the patient.
        ruler_sd_mm: of V and H.
        azimuth_sd_deg: of the azimuth.
        roll_sd_deg: of the camera's roll.
        prone_sd_deg: rotation of the vertebra from lying flat, about each axis, including lordosis.
    """

    vertical_mm: float
    horizontal_mm: float
    azimuth_deg: float = 0.0
    patient_end: PatientEnd = PatientEnd.FEET
    ruler_sd_mm: float = 10.0
    azimuth_sd_deg: float = 5.0
    roll_sd_deg: float = 3.0
    prone_sd_deg: float = 5.0


def view_prior_from_ruler(
    measured: RulerMeasurement,
    camera: CameraModel,
    seen_at_px: npt.ArrayLike,
    *,
    touched: tuple[TouchedPoint, ...] = (),
) -> ViewPrior:
    """Return tilt and distance of the camera from V and H, for a prone patient and an upright camera.

    Args:
        measured: V, H and direction of the camera.
        camera: calibrated.
        seen_at_px: (2,), image position of the needles, to which V and H were measured.
        touched: points captured with the tool's tip.

    Raises:
        InvalidInput: RULER_INVALID, VIEW_INVALID.
    """
    v, h = measured.vertical_mm, measured.horizontal_mm
    distance_mm = axial_distance_mm(v, h)
    elevation = np.arctan2(v, h)
    spine = 1.0 if measured.patient_end is PatientEnd.HEAD else -1.0
    azimuth = np.radians(measured.azimuth_deg)
    flat = np.array([np.sin(azimuth), 0.0, spine * np.cos(azimuth)])
    up = np.array([0.0, 1.0, 0.0])
    to_camera = np.cos(elevation) * flat + np.sin(elevation) * up
    x, y = camera.normalised_from_px(np.asarray(seen_at_px, dtype=np.float64).reshape(1, 2))[0]
    sight = np.array([x, y, 1.0]) / np.linalg.norm([x, y, 1.0])
    rotation = frame_of_sight(sight) @ _frame(-to_camera, up).T
    up_seen = rotation @ up
    level = np.cross(sight, up_seen)
    level /= np.linalg.norm(level)
    ruler_sd = measured.ruler_sd_mm / max(distance_mm, 1e-9)
    spread = np.radians(measured.prone_sd_deg) ** 2 * np.eye(3)
    for axis, sd in (
        (level, ruler_sd),
        (up_seen, np.radians(measured.azimuth_sd_deg)),
        (sight, np.radians(measured.roll_sd_deg)),
    ):
        spread += sd**2 * np.outer(axis, axis)
    return ViewPrior(
        rotation=rotation,
        rotation_covariance=spread,
        distance_mm=distance_mm,
        distance_sd_mm=measured.ruler_sd_mm,
        touched=touched,
    )


def frame_of_sight(sight: Array) -> Array:
    """Return columns (3, 3), camera frame: right, up in the image, and along a line of sight (3,)."""
    return _frame(sight, np.array([0.0, -1.0, 0.0]))


def _frame(along: Array, up: Array) -> Array:
    """Return columns: right, up, and along, with `up` orthogonalised."""
    right = np.cross(along, up)
    length = float(np.linalg.norm(right))
    if length < 1e-3:
        raise InvalidInput(
            "VIEW_INVALID",
            "the camera looks straight down, so V and H do not determine the up direction in its image",
            "Measure H to the vertebra again, or tilt the camera.",
        )
    right /= length
    return np.stack([right, np.cross(right, along), along], axis=1)
