"""Prediction of a marker's pose from the last images.

A repeated image adds no evidence: 25 copies from a frozen camera would seem to resolve an ambiguous pose, and
with a capture card that repeats each image of a slower camera a marker would alternate between rest and twice
its speed. An image whose pixels around the marker equal those of the last image is ignored. Two alternating
images are not detected.

A systematic residual (`Seen.systematic_residual_ratio`), for example from a drop on the marker or from
doubled rows, repeats in every image and would favour the wrong tilt within a few images. Images that agree
therefore count as fewer by that ratio, and tilts of small markers in poor video remain uncertain for longer.
"""

from dataclasses import dataclass

import numpy as np

from tracker.geometry import Array, Camera, Marker, Rigid, vector_from_rotation
from tracker.geometry.geometry_kernels import rotate_by, rotation_angle_between
from tracker.photometric import KnownIllumination
from tracker.pose.planar import flipped_pose
from tracker.pose.pose_ambiguity import PosePrediction, is_nearer_in_rotation
from tracker.pose.sighting import Seen, Sighting

# Maximum extrapolation time of the linear motion model.
MAX_PREDICTION_S = 0.25
# Maximum time without a sighting, as under a highlight or a hand, after which the last pose is discarded.
MAX_UNSEEN_S = 0.07
# Two poses nearer in time than this do not determine a speed.
MIN_INTERVAL_S = 1e-3
MAX_SPEED_MM_S = 1500.0
MAX_ROTATION_RAD = float(np.radians(15.0))
# Evidence for one planar solution is correlated between images, because bent paper, illumination and blur
# persist. The sum is therefore exponentially weighted and bounded, so that a few images can reverse the
# choice.
FORGETTING_RATIO, MAX_DELTA_CHI2 = 0.9, 25.0
# The effective number of images in the exponential sum.
EFFECTIVE_IMAGES = 1.0 / (1.0 - FORGETTING_RATIO)


@dataclass(slots=True)
class Prior:
    """A marker's last pose with its `delta_chi2`, illumination and motion. Mutable.

    `delta_chi2_before` is the value before the last image. `at_s` is the time of the last new image,
    `repeated_at_s` that of its last repetition. `rates` (6,) [mm/s, rad/s] is the velocity, None while it is
    unknown, and `rates_before` that of one image earlier.
    """

    pose: Rigid[Camera, Marker] | None = None
    delta_chi2: float = 0.0
    delta_chi2_before: float = 0.0
    illumination: KnownIllumination | None = None
    at_s: float = 0.0
    repeated_at_s: float = 0.0
    rates: Array | None = None
    rates_before: Array | None = None

    def predict(self, at_s: float, *, is_repeated: bool = False) -> PosePrediction | None:
        """Return the predicted pose at this time; None when the last pose is too old.

        `is_repeated`: the image is a copy of the last one. Its own evidence is excluded, and no motion is
        extrapolated.
        """
        if self.pose is None or not 0.0 < at_s - self.repeated_at_s <= MAX_PREDICTION_S:
            return None
        ahead = 0.0 if is_repeated else min(at_s - self.at_s, MAX_PREDICTION_S)
        moved = np.zeros(6) if self.rates is None else self.rates * ahead
        translation = self.pose.translation_mm + moved[:3]
        rotation = self.pose.rotation.copy()
        rotate_by(rotation, moved[3:], 1.0)
        if translation[2] <= 1.0 or float(rotation[:, 2] @ translation) >= 0.0:
            return None
        pose: Rigid[Camera, Marker] = Rigid(rotation=rotation, translation_mm=translation)
        return PosePrediction(
            rotation=pose.rotation,
            translation_mm=pose.translation_mm,
            flipped=flipped_pose(pose),
            delta_chi2=self.delta_chi2_before if is_repeated else self.delta_chi2,
            illumination=self.illumination,
        )

    def update(self, sighting: Sighting, at_s: float, *, is_repeated: bool = False) -> None:
        """Update the prior with a sighting; discard the pose of a marker that was unseen for too long.

        A repeated image (`is_repeated`) does not change the prior of a marker that was seen in it.
        """
        if is_repeated and isinstance(sighting, Seen) and self.predict(at_s, is_repeated=True) is not None:
            self.repeated_at_s = at_s
            return
        if not isinstance(sighting, Seen):
            if not 0.0 < at_s - self.repeated_at_s <= MAX_UNSEEN_S:
                self.pose = None
            return
        self._update_delta_chi2(sighting)
        self.rates_before, self.rates = self.rates, self.rates_to(sighting.camera_from_marker, at_s)
        self.pose, self.at_s, self.repeated_at_s = sighting.camera_from_marker, at_s, at_s
        self.illumination = sighting.illumination

    def rates_to(self, now: Rigid[Camera, Marker], at_s: float) -> Array | None:
        """Return the motion (6,) [mm/s, rad/s] since the last image; None where that is too long ago."""
        interval = at_s - self.at_s
        if self.pose is None or not MIN_INTERVAL_S < interval <= MAX_PREDICTION_S:
            return None
        rates = np.zeros(6)
        velocity = (now.translation_mm - self.pose.translation_mm) / interval
        # Faster than any hand means that one of the poses was wrong; the velocity must not be extrapolated.
        if float(velocity @ velocity) < MAX_SPEED_MM_S**2:
            rates[:3] = velocity
        # A flip between the planar solutions is not a rotation of the hand.
        before = flipped_pose(self.pose) if _is_flipped(now, self.pose) else self.pose
        if float(rotation_angle_between(now.rotation, before.rotation)) < MAX_ROTATION_RAD:
            rates[3:] = vector_from_rotation(now.rotation @ before.rotation.T) / interval
        return rates

    def _update_delta_chi2(self, seen: Seen) -> None:
        """Add the evidence of an image for one of the two solutions, without the part that repeats.

        Systematic residuals repeat in each image. Their share of the residual variance limits the number of
        agreeing images that count as independent.
        """
        before = 0.0 if seen.found_by == "search" or self.pose is None else self.delta_chi2
        is_against = (
            before > 0.0 and self.pose is not None and _is_flipped(seen.camera_from_marker, self.pose)
        )
        known = -before if is_against else before
        gain = seen.delta_chi2 - known
        if gain > 0.0:
            images = min(1.0 / max(seen.systematic_residual_ratio, 1e-9), EFFECTIVE_IMAGES)
            share = (images - 1.0) / (EFFECTIVE_IMAGES - 1.0)
            # Without independent residuals even an infinite delta chi-square adds no evidence.
            gain = gain * share if share > 0.0 else 0.0
        self.delta_chi2_before = before
        self.delta_chi2 = min(FORGETTING_RATIO * max(known + gain, 0.0), MAX_DELTA_CHI2)


def _is_flipped(now: Rigid[Camera, Marker], before: Rigid[Camera, Marker]) -> bool:
    """Return whether a pose is nearer to the flipped solution of the previous pose than to that pose."""
    return is_nearer_in_rotation(now, flipped_pose(before), before)
