"""Rolling shutter correction of poses.

A rolling shutter reads the rows sequentially, which shears a moving marker. The image of a small sheared
marker is nearly that of another pose, with a tip error of a millimetre and more. The displacement is
corrected on four points of the pose with the velocity since the last image. The uncertainty of that velocity,
in a first image that of any hand, is added to the covariance. A correction inside the fits would need a time
per pixel and change the result by a few hundredths of a millimetre. The readout time comes from the
configuration (`camera.readout_ms`).
"""

from dataclasses import dataclass, replace

import numpy as np

from tracker.camera import CameraModel
from tracker.camera.projection_kernels import project_square
from tracker.geometry import Array, Camera, Marker, Rigid
from tracker.pose.planar import fit_square_pose, flipped_pose
from tracker.pose.pose_ambiguity import PosePrediction, pose_difference
from tracker.pose.prior import Prior
from tracker.pose.sighting import Seen

# Fixed-point iterations: the readout time of a point depends on its row, and the row on the readout time.
ROUNDS = 3
# A measured velocity is the mean over the interval between two images. The velocity at its end differs by
# about half of the change since the previous interval, and at least by a hand's tremor (sd).
CHANGED_RATIO, MIN_SPEED_MM_S, MIN_TURNING_RAD_S = 0.5, 8.0, float(np.radians(6.0))
# Unknown motion of a hand that holds a drill (sd).
HAND_SPEED_MM_S, HAND_TURNING_RAD_S = 100.0, float(np.radians(40.0))
# The edges of the whole shape lie nearer to the centre than the corners; four points at this ratio of the
# half side represent them. The remaining stretch moves the centre by the second ratio of the displacement,
# and the nonlinear deformation under rotation by the third.
POINTS_RATIO, STRETCHED_RATIO, BENT_RATIO = 0.8, 0.03, 0.2


@dataclass(frozen=True, slots=True, kw_only=True)
class MarkerMotion:
    """Velocity of a marker in the camera frame.

    Attributes:
        rates: (6,) [mm/s, rad/s], velocity of the marker's centre, then angular velocity.
        sd: (6,), standard deviations of `rates`.
    """

    rates: Array
    sd: Array

    @classmethod
    def unknown_hand(cls) -> "MarkerMotion":
        """Return zero mean motion with the standard deviation of any hand."""
        return cls(rates=np.zeros(6), sd=np.repeat([HAND_SPEED_MM_S, HAND_TURNING_RAD_S], 3))

    @classmethod
    def after(cls, rates: Array, rates_before: Array | None) -> "MarkerMotion":
        """Return the motion at the end of an interval with mean `rates`, after one with `rates_before`."""
        minimum = np.repeat([MIN_SPEED_MM_S, MIN_TURNING_RAD_S], 3)
        changed = CHANGED_RATIO * (rates if rates_before is None else rates - rates_before)
        return cls(rates=rates, sd=np.hypot(changed, minimum))


@dataclass(frozen=True, slots=True, kw_only=True)
class RollingShutter:
    """Converts between true and imaged poses. A pose refers to the time at which the marker's centre is read.

    The image of a moving marker is sheared and stretched, and at a small size nearly equals that of another
    pose. The tracker estimates this imaged pose, and the displacement of four points converts it to the true
    one.

    Attributes:
        camera: model of a camera with a rolling shutter.
        seconds: readout time from the first row of an image to the last one.
    """

    camera: CameraModel
    seconds: float

    def imaged_pose(self, true: PosePrediction, rates: Array | None, *, side_mm: float) -> PosePrediction:
        """Return the imaged pose of a marker moving at `rates` (6,); `true` itself while they are unknown."""
        if rates is None:
            return true
        imaged: Rigid[Camera, Marker] = true
        for _ in range(ROUNDS):
            shift = self._shift(true, rates, self._delays_s(imaged, side_mm), side_mm)
            imaged = _shifted(true, shift, side_mm)
        rotation, translation = imaged.rotation, imaged.translation_mm
        return replace(true, rotation=rotation, translation_mm=translation, flipped=flipped_pose(imaged))

    def corrected(
        self, seen: Seen, prior: Prior | None, at_s: float, *, side_mm: float, is_repeated: bool = False
    ) -> Seen:
        """Return the sighting with the true pose. The uncertainty of the motion is added to its covariance.

        Args:
            seen: sighting in the image captured at `at_s`.
            prior: state from previous images; None for a first image.
            at_s: capture time.
            side_mm: side of the marker.
            is_repeated: whether the image is a copy of the last one.
        """
        imaged = seen.camera_from_marker
        delays_s = self._delays_s(imaged, side_mm)

        def still(rates: Array) -> Rigid[Camera, Marker]:
            return _shifted(imaged, -self._shift(imaged, rates, delays_s, side_mm), side_mm)

        motion = MarkerMotion.unknown_hand()
        if prior is not None and is_repeated and prior.rates is not None:
            motion = MarkerMotion.after(prior.rates, prior.rates_before)
        elif prior is not None and not is_repeated:
            rates: Array | None = np.zeros(6) if prior.rates is None else prior.rates
            for _ in range(ROUNDS):
                rates = None if rates is None else prior.rates_to(still(rates), at_s)
            motion = motion if rates is None else MarkerMotion.after(rates, prior.rates)
        pose, covariance = still(motion.rates), seen.pose_covariance.copy()
        turning = np.where(np.arange(6) < 3, 0.0, motion.rates)
        for ratio, of in ((STRETCHED_RATIO, motion.rates), (BENT_RATIO, turning)):
            shift = self._shift(imaged, of, delays_s, side_mm)
            rest_mm = ratio * float(np.abs(shift).max() * imaged.translation_mm[2])
            covariance[:3, :3] += rest_mm**2 * np.eye(3)
        for one in np.diag(motion.sd):
            difference = pose_difference(pose, still(motion.rates + one))
            covariance += np.outer(difference, difference)
        return replace(seen, camera_from_marker=pose, pose_covariance=covariance)

    def _delays_s(self, imaged: Rigid[Camera, Marker], side_mm: float) -> Array:
        """Return the readout times (4,) of the four points relative to the centre [s]."""
        pose, lens = (imaged.rotation, imaged.translation_mm), self.camera.lens
        rows = (
            project_square(*pose, lens, POINTS_RATIO * side_mm)[:, 1] - project_square(*pose, lens, 0.0)[0, 1]
        )
        return np.asarray(rows * (self.seconds / self.camera.size_wh_px[1]))

    def _shift(self, pose: Rigid[Camera, Marker], rates: Array, delays_s: Array, side_mm: float) -> Array:
        """Return the shifts (4, 2) of the four points of a moving marker, on the plane z = 1."""
        arms = _arms(pose, side_mm)
        points = arms + pose.translation_mm
        speeds = rates[:3] + np.cross(rates[3:], arms)
        depths = points[:, 2:]
        flow = (speeds[:, :2] - points[:, :2] / depths * speeds[:, 2:]) / depths
        return np.asarray(flow * delays_s[:, None])


def _arms(pose: Rigid[Camera, Marker], side_mm: float) -> Array:
    """Return the vectors (4, 3) from the marker's centre to the four points, in the camera frame."""
    h = 0.5 * POINTS_RATIO * side_mm
    flat = np.array([[-h, h, 0.0], [h, h, 0.0], [h, -h, 0.0], [-h, -h, 0.0]])
    return np.asarray(flat @ pose.rotation.T)


def _shifted(pose: Rigid[Camera, Marker], shift: Array, side_mm: float) -> Rigid[Camera, Marker]:
    """Return the pose whose four points are those of `pose` plus `shift` (4, 2) on the plane z = 1."""
    points = _arms(pose, side_mm) + pose.translation_mm
    target = np.ascontiguousarray(points[:, :2] / points[:, 2:] + shift)
    fitted = fit_square_pose(target, pose, side_mm=POINTS_RATIO * side_mm)
    return pose if fitted is None else fitted.pose
