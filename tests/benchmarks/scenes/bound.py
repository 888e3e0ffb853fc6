"""Cramer-Rao bound of the six pose parameters from an image."""

from collections.abc import Callable
from dataclasses import dataclass, replace

import numpy as np
import numpy.typing as npt

from tests.benchmarks.scenes.area import coverage_image
from tests.benchmarks.scenes.scene import Pose, Scene, Window, noise_variance_grey2, window_mean_of, window_of
from tracker.geometry import Array, Rigid, rotation_between, rotation_from_vector

TIP_IN_MARKER_MM = np.array([0.0, 120.0, 0.0])
# Only the square and this much around it, in sides: the paper's edge against an unknown cloth says nothing.
RIM_RATIO = 0.12
STEP_PX = 0.03
BLUR_STEP_RATIO = 0.02
SATURATED_GREY = 254.0
DRAWS = 2000
PARAMETERS = ("across_mm", "depth_mm", "roll_deg", "tilt_deg", "tip_mm")


@dataclass(frozen=True, slots=True, kw_only=True)
class Bound:
    """Standard deviations that an unbiased estimator can reach on one scene.

    Attributes:
        covariance: (6, 6) [mm, rad], translation first, then a small rotation multiplied from the left, both
            in the camera frame: as `Seen.pose_covariance`.
        across_mm, depth_mm, roll_deg, tilt_deg, tip_mm: medians of the sizes of errors with this covariance.
    """

    covariance: Array
    across_mm: float
    depth_mm: float
    roll_deg: float
    tilt_deg: float
    tip_mm: float


@dataclass(frozen=True, slots=True, kw_only=True)
class PoseErrors:
    """Absolute pose errors; arrays (n,) for draws, single numbers for one claim.

    Attributes:
        across_mm, depth_mm: of the marker's centre, across the line of sight and along it.
        roll_deg, tilt_deg: about the marker's normal, and of its normal.
        tip_mm: of the point 120 mm from the marker.
    """

    across_mm: Array
    depth_mm: Array
    roll_deg: Array
    tilt_deg: Array
    tip_mm: Array


def pose_errors(truth: Pose, off_mm: Array, turned_rad: Array) -> PoseErrors:
    """Return errors (n,) from translations (n, 3) and small rotations (n, 3) in the camera frame."""
    sight = truth.translation_mm / np.linalg.norm(truth.translation_mm)
    along = off_mm @ sight
    in_marker = np.degrees(turned_rad @ truth.rotation)
    arm = truth.rotation @ TIP_IN_MARKER_MM
    return PoseErrors(
        across_mm=np.linalg.norm(off_mm - along[:, None] * sight, axis=1),
        depth_mm=np.abs(along),
        roll_deg=np.abs(in_marker[:, 2]),
        tilt_deg=np.hypot(in_marker[:, 0], in_marker[:, 1]),
        tip_mm=np.linalg.norm(off_mm + np.cross(turned_rad, arm), axis=1),
    )


def bound_of(scene: Scene) -> Bound:
    """Return the bound for the first marker of a scene, for a linear camera without JPEG."""
    covariance = np.asarray(np.linalg.inv(information_of(scene)), dtype=np.float64)
    draws = np.random.default_rng(0).multivariate_normal(np.zeros(6), covariance, DRAWS)
    errors = pose_errors(scene.pose, draws[:, :3], draws[:, 3:])
    return Bound(
        covariance=covariance,
        **{name: float(np.median(getattr(errors, name))) for name in PARAMETERS},
    )


def information_of(scene: Scene) -> Array:
    """Return the Fisher information (6, 6) on translation [mm] and rotation [rad], camera frame.

    Gain, offset and blur are unknown too, so what they could explain is taken out.
    """
    blur_px = scene.condition.blur_px
    window = window_of(_with_blur(scene, blur_px * 1.1))
    mean = window_mean_of(scene, window)
    # Across and along the sight, because a step along the camera's axis also moves the marker sideways.
    sight = rotation_between([0.0, 0.0, 1.0], scene.pose.translation_mm)
    axes = np.kron(np.eye(2), sight)
    slopes = []
    for size, axis in zip(_steps(scene), axes.T, strict=True):
        ahead, behind = (
            window_mean_of(scene.moved(_mover(scene.pose, sign * size * axis)), window)
            for sign in (1.0, -1.0)
        )
        slopes.append((ahead - behind) / (2.0 * size))
    softer = window_mean_of(_with_blur(scene, blur_px * (1.0 + BLUR_STEP_RATIO)), window)
    counted = _counted(scene, mean, window)
    root = 1.0 / np.sqrt(noise_variance_grey2(mean, scene.condition)[counted])
    by_pose = np.stack([slope[counted] for slope in slopes], axis=1) * root[:, None]
    unknown = np.stack([mean[counted], np.ones(len(root)), (softer - mean)[counted]], axis=1) * root[:, None]
    return np.asarray(axes @ information_without(by_pose, unknown) @ axes.T, dtype=np.float64)


def information_without(by_pose: Array, unknown: Array) -> Array:
    """Return the pose information with nuisance parameters; both (n, ...) in units of the noise."""
    basis, _ = np.linalg.qr(unknown)
    left = by_pose - basis @ (basis.T @ by_pose)
    return np.asarray(left.T @ left, dtype=np.float64)


def _with_blur(scene: Scene, blur_px: float) -> Scene:
    return replace(scene, condition=replace(scene.condition, blur_px=blur_px))


def _steps(scene: Scene) -> Array:
    """Return steps along the sight's axes that move the marker's image by a few hundredths of a pixel."""
    half_px = 0.5 * scene.side_px
    across_mm = STEP_PX * float(np.linalg.norm(scene.pose.translation_mm)) / scene.rig.focal_px
    turn_rad = STEP_PX / half_px
    along_mm = turn_rad * float(np.linalg.norm(scene.pose.translation_mm))
    return np.array([across_mm, across_mm, along_mm, turn_rad, turn_rad, turn_rad])


def _mover(about: Pose, step: Array) -> Callable[[Pose], Pose]:
    """Return the motion of every shutter pose by one step; rotations are about the marker's centre."""
    turn = rotation_from_vector(step[3:])

    def move(pose: Pose) -> Pose:
        from_centre = pose.translation_mm - about.translation_mm
        return Rigid(
            rotation=turn @ pose.rotation, translation_mm=about.translation_mm + from_centre + step[:3]
        )

    return move


def _counted(scene: Scene, mean: Array, window: Window) -> npt.NDArray[np.bool_]:
    """Return the unsaturated pixels of the square and its rim."""
    rim = scene.board.face.corners_mm * (1.0 + 2.0 * RIM_RATIO)
    outline = scene.rig.px_of(scene.pose, rim) - [window.left, window.top]
    return np.asarray((coverage_image([outline], [1.0], window.size_wh) > 0.5) & (mean < SATURATED_GREY))
