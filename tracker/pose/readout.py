"""A marker that moves while a camera reads its image row by row (a rolling shutter).

Rows that are read one after another shear what moves, and a small sheared marker looks like another pose:
the tip is off by a millimetre and more. The shift is undone on four points of the pose, with the motion
since the last image; the uncertainty of that motion, for a first image that of any hand, goes into the
covariance. Inside the fits it would cost a time for every pixel and change the result by a few hundredths.
The readout time must be given (`camera.readout_ms`); nothing measures it.
"""

from dataclasses import dataclass, replace

import numpy as np

from tracker.camera import CameraModel
from tracker.camera.kernels import square_seen
from tracker.geometry import Array, Camera, Marker, Rigid
from tracker.pose.planar import fitted_square, other_solution
from tracker.pose.prior import Prior
from tracker.pose.rivals import Expected, difference
from tracker.pose.sighting import Seen

# When a corner is read depends on where it is seen, and that on when it is read.
ROUNDS = 3
# A motion is the mean of an interval between images: at its end it differs by about half of what it changed,
# and never by less than a hand trembles (sd).
CHANGED_RATIO, MIN_SPEED_MM_S, MIN_TURNING_RAD_S = 0.5, 8.0, float(np.radians(6.0))
# Of a hand of which nothing is known but that it holds a drill (sd).
HAND_SPEED_MM_S, HAND_TURNING_RAD_S = 100.0, float(np.radians(40.0))
# The shift of four points stands for that of the whole shape, whose edges lie nearer to its centre than the
# corners do: about so much of the way. The rest moves the centre by about so much of the shift, and by more
# of what turning shifts: that bends.
POINTS_RATIO, STRETCHED_RATIO, BENT_RATIO = 0.8, 0.03, 0.2


@dataclass(frozen=True, slots=True, kw_only=True)
class Motion:
    """How a marker moves in the camera's frame.

    Attributes:
        rates: (6,) [mm/s, rad/s], of its centre, then of its turn.
        sd: (6,), of each of them.
    """

    rates: Array
    sd: Array

    @classmethod
    def of_a_hand(cls) -> "Motion":
        """One of which nothing is known."""
        return cls(rates=np.zeros(6), sd=np.repeat([HAND_SPEED_MM_S, HAND_TURNING_RAD_S], 3))

    @classmethod
    def after(cls, rates: Array, rates_before: Array | None) -> "Motion":
        """At the end of an interval with these mean rates (6,), after one with those, if they are known."""
        least = np.repeat([MIN_SPEED_MM_S, MIN_TURNING_RAD_S], 3)
        changed = CHANGED_RATIO * (rates if rates_before is None else rates - rates_before)
        return cls(rates=rates, sd=np.hypot(changed, least))


@dataclass(frozen=True, slots=True, kw_only=True)
class Readout:
    """Turns poses into what such a camera makes of them, and back. A pose is that of when its centre is read.

    A marker that moves meanwhile is sheared and stretched. Small as it is in the image, that is nearly what
    another pose would do to it: that pose is found, and is turned back here by the shift of four points.

    Attributes:
        camera: with a rolling shutter.
        seconds: from the first row of an image to the last one.
    """

    camera: CameraModel
    seconds: float

    def expected(self, true: Expected, rates: Array | None, *, side_mm: float) -> Expected:
        """The pose to expect in the image, of a marker that moves at these rates (6,), if they are known."""
        if rates is None:
            return true
        imaged: Rigid[Camera, Marker] = true
        for _ in range(ROUNDS):
            shift = self._shift(true, rates, self._delays_s(imaged, side_mm), side_mm)
            imaged = _shifted(true, shift, side_mm)
        rotation, translation = imaged.rotation, imaged.translation_mm
        return replace(true, rotation=rotation, translation_mm=translation, rival=other_solution(imaged))

    def undone(
        self, seen: Seen, prior: Prior | None, at_s: float, *, side_mm: float, is_again: bool = False
    ) -> Seen:
        """The same where the marker truly was. What is not known of its motion is in its covariance.

        Args:
            seen: in the image of this time, `at_s`.
            prior: what the images before tell of its motion; None where there are none.
            at_s: when.
            side_mm: of the marker.
            is_again: the image is the last one once more.
        """
        imaged = seen.camera_from_marker
        delays_s = self._delays_s(imaged, side_mm)

        def still(rates: Array) -> Rigid[Camera, Marker]:
            return _shifted(imaged, -self._shift(imaged, rates, delays_s, side_mm), side_mm)

        motion = Motion.of_a_hand()
        if prior is not None and is_again and prior.rates is not None:
            motion = Motion.after(prior.rates, prior.rates_before)
        elif prior is not None and not is_again:
            rates: Array | None = np.zeros(6) if prior.rates is None else prior.rates
            for _ in range(ROUNDS):
                rates = None if rates is None else prior.rates_to(still(rates), at_s)
            motion = motion if rates is None else Motion.after(rates, prior.rates)
        pose, covariance = still(motion.rates), seen.pose_covariance.copy()
        turning = np.where(np.arange(6) < 3, 0.0, motion.rates)
        for ratio, of in ((STRETCHED_RATIO, motion.rates), (BENT_RATIO, turning)):
            shift = self._shift(imaged, of, delays_s, side_mm)
            rest_mm = ratio * float(np.abs(shift).max() * imaged.translation_mm[2])
            covariance[:3, :3] += rest_mm**2 * np.eye(3)
        for one in np.diag(motion.sd):
            apart = difference(pose, still(motion.rates + one))
            covariance += np.outer(apart, apart)
        return replace(seen, camera_from_marker=pose, pose_covariance=covariance)

    def _delays_s(self, imaged: Rigid[Camera, Marker], side_mm: float) -> Array:
        """How long after the centre the four points (4,) are read."""
        pose, lens = (imaged.rotation, imaged.translation_mm), self.camera.lens
        rows = square_seen(*pose, lens, POINTS_RATIO * side_mm)[:, 1] - square_seen(*pose, lens, 0.0)[0, 1]
        return np.asarray(rows * (self.seconds / self.camera.size_wh_px[1]))

    def _shift(self, pose: Rigid[Camera, Marker], rates: Array, delays_s: Array, side_mm: float) -> Array:
        """By how much the four points (4, 2) of a marker that moves are shifted, on the plane at z = 1."""
        arms = _arms(pose, side_mm)
        points = arms + pose.translation_mm
        speeds = rates[:3] + np.cross(rates[3:], arms)
        depths = points[:, 2:]
        flow = (speeds[:, :2] - points[:, :2] / depths * speeds[:, 2:]) / depths
        return np.asarray(flow * delays_s[:, None])


def _arms(pose: Rigid[Camera, Marker], side_mm: float) -> Array:
    """From the marker's centre to the four points (4, 3), in the camera's frame."""
    h = 0.5 * POINTS_RATIO * side_mm
    flat = np.array([[-h, h, 0.0], [h, h, 0.0], [h, -h, 0.0], [-h, -h, 0.0]])
    return np.asarray(flat @ pose.rotation.T)


def _shifted(pose: Rigid[Camera, Marker], shift: Array, side_mm: float) -> Rigid[Camera, Marker]:
    """The pose whose four points are at those of this one, shifted (4, 2) on the plane at z = 1."""
    points = _arms(pose, side_mm) + pose.translation_mm
    target = np.ascontiguousarray(points[:, :2] / points[:, 2:] + shift)
    fitted = fitted_square(target, pose, side_mm=POINTS_RATIO * side_mm)
    return pose if fitted is None else fitted.pose
