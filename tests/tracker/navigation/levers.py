"""Points on levers of given length, displaced by pose errors of a marker that nearly faces the camera."""

import numpy as np

from tests.tracker.scenes import camera_of, facing, perfectly_seen
from tracker.geometry import (
    Array,
    Camera,
    Marker,
    Reference,
    Rigid,
    Vertebra,
    point_covariance_mm2,
    rotation_from_vector,
)
from tracker.navigation import Absent, Setup
from tracker.navigation.drill_reference import tool_in_vertebra
from tracker.navigation.snapshot_builder import locate_vertebra
from tracker.navigation.uncertainty import UncertainPose
from tracker.plan import Channel
from tracker.pose import ToolModel
from tracker.registration import Registration

LEVERS_MM = (60.0, 120.0, 250.0)
TILTS_SD_DEG = (0.5, 1.0, 2.0)
# Within this squared Mahalanobis distance are 95 % of three normally distributed numbers.
CHI2_95 = 7.815
MARKER: Rigid[Camera, Marker] = facing([20.0, -15.0, 500.0], tilt_deg=3.0, about_deg=40.0, roll_deg=15.0)
# The origin of a CT is far from the vertebra.
CAMERA_FROM_VERTEBRA: Rigid[Camera, Vertebra] = Rigid.from_vector([0.4, 1.2, -0.3], [260.0, -180.0, 900.0])


def pose_covariance(tilt_sd_deg: float) -> Array:
    """The covariance (6, 6) of a small marker that faces the camera: its tilt is the least certain."""
    tilt, roll = np.radians(tilt_sd_deg) ** 2, np.radians(0.02) ** 2
    return np.diag([1e-4, 1e-4, 1e-2, tilt, tilt, roll])


def tips_inside(lever_mm: float, tilt_sd_deg: float, *, draws: int, seed: int) -> int:
    """Return how many true tips lie in the 95 % ellipsoid that navigation states in the vertebra frame."""
    tool = ToolModel.from_tip_and_axis(
        name="drill",
        marker="drill",
        tip_in_marker_mm=(0.0, -lever_mm, 0.0),
        axis_in_marker=(0.0, -1.0, 0.0),
        radius_mm=2.0,
        length_mm=lever_mm,
    )
    covariance = pose_covariance(tilt_sd_deg)
    stated = tool_in_vertebra(
        UncertainPose(pose=CAMERA_FROM_VERTEBRA, covariance=np.zeros((6, 6))),
        UncertainPose(pose=MARKER, covariance=covariance),
        tool,
    )
    off = _displacements(MARKER, tool.marker_from_tool.translation_mm, covariance, draws=draws, seed=seed)
    return _inside(off @ CAMERA_FROM_VERTEBRA.rotation, stated.covariance[:3, :3])


def entries_inside(lever_mm: float, tilt_sd_deg: float, *, draws: int, seed: int) -> int:
    """Return how many true entry points lie in the 95 % ellipsoid of a vertebra placed by a reference."""
    in_reference = np.array([0.0, -lever_mm, 0.0])
    camera_from_reference: Rigid[Camera, Reference] = Rigid(
        rotation=MARKER.rotation, translation_mm=MARKER.translation_mm
    )
    reference_from_vertebra = camera_from_reference.inverse @ CAMERA_FROM_VERTEBRA
    entry = reference_from_vertebra.inverse.move_points(in_reference)
    setup = Setup(
        camera=camera_of(),
        camera_calibrated=True,
        tools={},
        channel=Channel(
            name="L3 left",
            entry_in_vertebra_mm=entry,
            target_in_vertebra_mm=entry - np.array([0.0, 40.0, 0.0]),
            radius_mm=4.0,
        ),
        registration=Registration.known_to_reference(reference_from_vertebra),
        reference="patient",
    )
    covariance = pose_covariance(tilt_sd_deg)
    placed = locate_vertebra(setup, {"patient": perfectly_seen(MARKER, covariance=covariance)})
    assert not isinstance(placed, Absent)
    stated = point_covariance_mm2(placed.camera_from_vertebra, placed.covariance, entry)
    return _inside(_displacements(MARKER, in_reference, covariance, draws=draws, seed=seed), stated)


def _displacements(
    pose: Rigid[Camera, Marker], point_mm: Array, covariance: Array, *, draws: int, seed: int
) -> Array:
    """Return displacements (n, 3) in the camera frame of a point fixed to a marker, without linearisation."""
    arm = pose.rotate_directions(point_mm)
    errors = np.random.default_rng(seed).multivariate_normal(np.zeros(6), covariance, draws)
    return np.array([one[:3] + rotation_from_vector(one[3:]) @ arm - arm for one in errors])


def _inside(off: Array, covariance: Array) -> int:
    squared = np.einsum("ni,ij,nj->n", off, np.linalg.inv(covariance), off)
    return int(np.count_nonzero(squared < CHI2_95))
