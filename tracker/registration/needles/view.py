"""What is known of the camera before any needle is looked at: its tilt and distance, and touched points."""

from dataclasses import dataclass, field
from enum import StrEnum

import numpy as np
import numpy.typing as npt

from tracker.camera import CameraModel
from tracker.camera.ruler import axial_distance_mm
from tracker.errors import InvalidInput
from tracker.geometry import Array


class Standing(StrEnum):
    """From which end of the patient the camera looks."""

    FEET = "feet"
    HEAD = "head"


@dataclass(frozen=True, slots=True, kw_only=True)
class TouchedPoint:
    """A point of the plan that the tool's tip was held on: it tells the depth that one image cannot.

    Attributes:
        name: of the landmark.
        point_lps_mm: (3,), where the plan has it.
        point_in_camera_mm: (3,), where the tip was.
        covariance_mm2: (3, 3), camera frame, of the tip and how it was held. Where it has the name of a
            needle the tip was held where that needle goes in, and its placing is taken from there; elsewhere
            the landmark's own error belongs into it.
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
class View:
    """The camera's tilt and distance, as measured by a ruler, and how sure they are.

    Attributes:
        rotation: (3, 3), camera from vertebra.
        rotation_covariance: (3, 3) rad^2, of a small rotation multiplied from the left (camera frame).
        distance_mm: from the camera's centre to the middle of the needles' places.
        distance_sd_mm: of it.
        touched: points that the tool's tip was held on; none where there is no tool yet.
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
                f"the camera is {self.distance_mm:g} mm away, known to {self.distance_sd_mm:g} mm; "
                "needed above 0",
                "Measure V and H from the camera to the patient, and say how well.",
                {"distance_mm": self.distance_mm, "distance_sd_mm": self.distance_sd_mm},
            )


@dataclass(frozen=True, slots=True, kw_only=True)
class MeasuredView:
    """What a ruler tells of a camera above and beside a patient who lies prone (paper, 2.2 and figure 2).

    Attributes:
        vertical_mm: V, how far the camera is above the vertebra.
        horizontal_mm: H, how far it is beside it.
        azimuth_deg: where it stands, seen from above: 0 in line with the spine, positive to the left side.
        standing: at which end of the patient.
        ruler_sd_mm: of V and of H.
        azimuth_sd_deg: of the azimuth.
        level_sd_deg: how far the camera may lean to its side.
        lying_sd_deg: how far the vertebra may be turned from lying flat, about each axis: lordosis is in it.
    """

    vertical_mm: float
    horizontal_mm: float
    azimuth_deg: float = 0.0
    standing: Standing = Standing.FEET
    ruler_sd_mm: float = 10.0
    azimuth_sd_deg: float = 5.0
    level_sd_deg: float = 3.0
    lying_sd_deg: float = 5.0


def view_from_ruler(
    measured: MeasuredView,
    camera: CameraModel,
    seen_at_px: npt.ArrayLike,
    *,
    touched: tuple[TouchedPoint, ...] = (),
) -> View:
    """The camera's tilt and distance from V and H, with the patient prone and the camera upright.

    Args:
        measured: V, H and where the camera stands.
        camera: calibrated.
        seen_at_px: (2,), where the needles are in the image: V and H were measured to there.
        touched: points that the tool's tip was held on.

    Raises:
        InvalidInput: RULER_INVALID, VIEW_INVALID.
    """
    v, h = measured.vertical_mm, measured.horizontal_mm
    distance_mm = axial_distance_mm(v, h)
    elevation = np.arctan2(v, h)
    spine = 1.0 if measured.standing is Standing.HEAD else -1.0
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
    spread = np.radians(measured.lying_sd_deg) ** 2 * np.eye(3)
    for axis, sd in (
        (level, ruler_sd),
        (up_seen, np.radians(measured.azimuth_sd_deg)),
        (sight, np.radians(measured.level_sd_deg)),
    ):
        spread += sd**2 * np.outer(axis, axis)
    return View(
        rotation=rotation,
        rotation_covariance=spread,
        distance_mm=distance_mm,
        distance_sd_mm=measured.ruler_sd_mm,
        touched=touched,
    )


def frame_of_sight(sight: Array) -> Array:
    """Columns (3, 3), camera frame: to the right, up in the image, and along a line of sight (3,)."""
    return _frame(sight, np.array([0.0, -1.0, 0.0]))


def _frame(along: Array, up: Array) -> Array:
    """Columns: to the right, up, and along, where up is taken as far as it is across."""
    right = np.cross(along, up)
    length = float(np.linalg.norm(right))
    if length < 1e-3:
        raise InvalidInput(
            "VIEW_INVALID",
            "the camera looks straight down, so that V and H do not tell which way is up in its image",
            "Measure H to the vertebra again, or tilt the camera.",
        )
    right /= length
    return np.stack([right, np.cross(right, along), along], axis=1)
