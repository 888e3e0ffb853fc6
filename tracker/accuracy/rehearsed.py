"""A rehearsed accuracy test: simulated captures of a plate with known truth and known faults.

Corners of the marker are projected through the true camera, displaced by noise and by a smooth residual
distortion, and the pose is fitted with the stated camera. A wrong focal length, a wrong tip and a wrong print
scale therefore act as they do in reality, and not as the diagnosis models them.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np

from tracker.accuracy.capture import DivotCapture, capture_at_rest
from tracker.accuracy.marker_geometry import TrackedTool, corners_mm, pose_from_corner_shift
from tracker.accuracy.plate import DivotPlate
from tracker.accuracy.plate_fit import fit_plate
from tracker.camera import CameraModel
from tracker.geometry import Array, Camera, Marker, Pattern, Rigid, rotation_from_vector
from tracker.pose.planar import fit_square_pose
from tracker.pose.tool import Poses

# Rotations of the tool from its upright posture, in the plate's frame [deg]: about x away from the camera,
# about y to the sides, about z around the tool.
POSTURES: Mapping[str, tuple[tuple[float, float, float], ...]] = {
    "upright": ((0.0, 0.0, 0.0),),
    "tilted": ((-15.0, 0.0, 0.0), (0.0, 28.0, 0.0), (0.0, -28.0, 0.0)),
    "turned": ((0.0, 0.0, 30.0), (0.0, 0.0, -30.0)),
}
POSTURE_SD_DEG = 4.0
# Waves of the residual distortion across the image.
FIELD_WAVES = 3


@dataclass(frozen=True, slots=True, kw_only=True)
class RehearsedFaults:
    """Faults of a rehearsed system, each with the sign of `FaultEstimate.value`.

    Attributes:
        print_scale_ratio: true by stated distances of the plate, minus 1.
        tip_offset_mm: length of stated minus true tip.
        focal_error_ratio: stated by true focal length, minus 1.
    """

    print_scale_ratio: float = 0.0
    tip_offset_mm: float = 0.0
    focal_error_ratio: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class RehearsedPlacement:
    """A placement of the plate before the camera.

    Attributes:
        centre_mm: (3,), centre of the plate in the camera's frame.
        tilt_deg: angle between the plate and the image plane.
    """

    centre_mm: tuple[float, float, float]
    tilt_deg: float


NEAR_AND_FAR = {
    "near": RehearsedPlacement(centre_mm=(-30.0, 60.0, 420.0), tilt_deg=55.0),
    "far": RehearsedPlacement(centre_mm=(40.0, 40.0, 600.0), tilt_deg=40.0),
}


@dataclass(frozen=True, kw_only=True)
class RehearsedSystem:
    """Camera, tool and plate with their truth.

    Attributes:
        camera: the true camera.
        plate: the plate as it is stated; its `sd_mm` is the true scatter of the tip in a divot.
        side_mm: side of the marker.
        tip_in_marker_mm: the true tip.
        tip_sd_mm: standard deviation along each axis of the calibration of the tip.
        faults: faults of the system.
        corner_sd_px: error of each coordinate of a corner, the same in all images of a capture.
        jitter_sd_px: noise of each coordinate of a corner between images.
        field_sd_px: residual distortion, a smooth function of the place in the image.
        placements: placements of the plate by name.
        images: images of a capture.
        seed: of the calibration of the tip and of the residual distortion.
    """

    plate: DivotPlate
    camera: CameraModel = field(
        default_factory=lambda: CameraModel(
            matrix=np.array([[1400.0, 0.0, 959.5], [0.0, 1400.0, 539.5], [0.0, 0.0, 1.0]]),
            distortion=np.zeros(5),
            size_wh_px=(1920, 1080),
        )
    )
    side_mm: float = 25.0
    tip_in_marker_mm: tuple[float, float, float] = (4.0, -120.0, -6.0)
    tip_sd_mm: float = 0.05
    faults: RehearsedFaults = field(default_factory=RehearsedFaults)
    corner_sd_px: float = 0.03
    jitter_sd_px: float = 0.02
    field_sd_px: float = 0.03
    placements: Mapping[str, RehearsedPlacement] = field(default_factory=lambda: NEAR_AND_FAR)
    images: int = 8
    seed: int = 0

    @cached_property
    def stated_camera(self) -> CameraModel:
        """Return the camera model that poses are computed with."""
        matrix = self.camera.matrix.copy()
        matrix[0, 0] *= 1.0 + self.faults.focal_error_ratio
        matrix[1, 1] *= 1.0 + self.faults.focal_error_ratio
        return replace(self.camera, matrix=matrix)

    @property
    def tool(self) -> TrackedTool:
        """Return camera, marker and tip as they are stated."""
        random = np.random.default_rng([self.seed, 1])
        error = random.normal(size=3) * self.tip_sd_mm
        # Across the lever and along it: an offset along the lever alone does not change with a turn.
        direction = np.array([2.0, 1.0, 2.0]) / 3.0
        return TrackedTool(
            camera=self.stated_camera,
            side_mm=self.side_mm,
            tip_in_marker_mm=np.array(self.tip_in_marker_mm) + error + self.faults.tip_offset_mm * direction,
            tip_covariance_mm2=self.tip_sd_mm**2 * np.eye(3),
        )


@dataclass(frozen=True, slots=True, kw_only=True)
class RehearsedCapture:
    """The poses of one capture, as a camera would have recorded them."""

    divot: str
    placement: str
    posture: str
    poses: Poses

    def at_rest(self, tool: TrackedTool) -> DivotCapture:
        """Return the capture."""
        return capture_at_rest(
            self.poses,
            tool.tip_in_marker_mm,
            divot=self.divot,
            placement=self.placement,
            posture=self.posture,
        )


def rehearse(system: RehearsedSystem, *, seed: int, repetitions: int = 1) -> list[RehearsedCapture]:
    """Return the captures of a test: each divot upright, tilted and turned in each placement.

    With `repetitions`, the upright posture is captured that many times.
    """
    random = np.random.default_rng([system.seed, 2, seed])
    waves = _field_waves(system)
    captures = []
    for placement in system.placements:
        for number, divot in enumerate(system.plate.points_mm):
            for posture, ways in POSTURES.items():
                for _ in range(repetitions if posture == "upright" else 1):
                    way_deg = ways[number % len(ways)]
                    poses = _capture(system, placement, divot, way_deg, waves, random)
                    captures.append(
                        RehearsedCapture(divot=divot, placement=placement, posture=posture, poses=poses)
                    )
    return captures


def true_errors_mm(system: RehearsedSystem, *, seed: int, rounds: int) -> Array:
    """Return the errors (n, 2, 3) of captures in many rounds of the same test, relative to the true plate.

    The first is that of the first image, the second that of the mean of all images.
    """
    tool = system.tool
    captures = [one.at_rest(tool) for number in range(rounds) for one in rehearse(system, seed=seed + number)]
    scale = 1.0 + system.faults.print_scale_ratio
    of_mean = fit_plate(system.plate.scaled(scale, scale), captures).residuals_mm
    of_image = np.array([one.image_tip_in_camera_mm - one.tip_in_camera_mm for one in captures])
    return np.stack([of_mean + of_image, of_mean], axis=1)


def _capture(
    system: RehearsedSystem,
    placement: str,
    divot: str,
    way_deg: tuple[float, float, float],
    waves: Array,
    random: np.random.Generator,
) -> Poses:
    """Return the fitted poses of one capture."""
    plate = _camera_from_plate(system.placements[placement])
    divots = np.array(list(system.plate.points_mm.values()))
    in_plate = np.array(system.plate.points_mm[divot]) - divots.mean(axis=0)
    at = plate.move_points((1.0 + system.faults.print_scale_ratio) * in_plate)
    at = at + random.normal(size=3) * system.plate.sd_mm
    posture_deg = np.array(way_deg) + random.normal(size=3) * POSTURE_SD_DEG
    rotation = plate.rotation @ rotation_from_vector(np.radians(posture_deg)) @ _upright(system)
    true: Rigid[Camera, Marker] = Rigid(
        rotation=rotation, translation_mm=at - rotation @ np.array(system.tip_in_marker_mm)
    )
    px = system.camera.px_from_camera(true.move_points(corners_mm(system.side_mm)))
    px = px + _field_px(system, waves, px) + random.normal(size=(4, 2)) * system.corner_sd_px
    stated = system.stated_camera
    poses = []
    for _ in range(system.images):
        corners = stated.normalised_from_px(px + random.normal(size=(4, 2)) * system.jitter_sd_px)
        fitted = fit_square_pose(corners, true, side_mm=system.side_mm)
        if fitted is None:
            raise AssertionError("a rehearsed marker faces away from the camera")
        poses.append(fitted.pose)
    # The covariance that the tracker would state, which varies little within a capture.
    from_px = pose_from_corner_shift(stated, system.side_mm, poses[0])
    variance = system.corner_sd_px**2 + system.jitter_sd_px**2 + system.field_sd_px**2
    return Poses.from_rigids(poses, [variance * from_px @ from_px.T] * len(poses))


def _camera_from_plate(placement: RehearsedPlacement) -> Rigid[Camera, Pattern]:
    tilt = np.radians(placement.tilt_deg)
    rotation = np.array(
        [[1.0, 0.0, 0.0], [0.0, np.cos(tilt), np.sin(tilt)], [0.0, -np.sin(tilt), np.cos(tilt)]]
    )
    return Rigid(rotation=rotation, translation_mm=np.array(placement.centre_mm))


def _upright(system: RehearsedSystem) -> Array:
    """Return the rotation from marker to plate of a tool that stands on the plate and faces the camera."""
    up = -np.array(system.tip_in_marker_mm) / np.linalg.norm(system.tip_in_marker_mm)
    face = np.array([0.0, 0.0, 1.0]) - up[2] * up
    face /= np.linalg.norm(face)
    in_marker = np.stack([np.cross(up, face), up, face], axis=1)
    # The plate's z points into the plate, and its y down the page, towards the camera.
    in_plate = np.stack([[1.0, 0.0, 0.0], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]], axis=1)
    return np.asarray(in_plate @ in_marker.T)


def _field_waves(system: RehearsedSystem) -> Array:
    """Return amplitude and phase (2, 2, waves, waves) of the residual distortion along x and y."""
    random = np.random.default_rng([system.seed, 3])
    shape = (2, FIELD_WAVES, FIELD_WAVES)
    return np.stack([random.normal(size=shape), random.uniform(0.0, 2.0 * np.pi, shape)])


def _field_px(system: RehearsedSystem, waves: Array, px: Array) -> Array:
    """Return the residual distortion (n, 2) at pixels (n, 2)."""
    x, y = (px / np.array(system.camera.size_wh_px)).T
    number = np.arange(FIELD_WAVES)
    phase = np.pi * (number[:, None, None] * x + number[None, :, None] * y)
    amplitude, offset = waves
    shifted = [
        (amplitude[axis][..., None] * np.cos(phase + offset[axis][..., None])).sum((0, 1)) for axis in (0, 1)
    ]
    return np.asarray(np.stack(shifted, axis=1) * system.field_sd_px * 2.0**0.5 / FIELD_WAVES)
