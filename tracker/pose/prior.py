"""Prediction of a marker's pose from the last images.

A repeated image adds no evidence: 25 copies from a frozen camera would make an ambiguous pose certain, and a
capture card that repeats each image of a slower camera would show a marker at rest and then at twice its
speed. An image whose pixels around the marker equal the last ones is ignored. Two alternating images are
not noticed.

A systematic residual (`Seen.systematic_residual_ratio`), as from a drop on the marker or from doubled rows,
repeats in every image and would make the wrong tilt certain within a few. So images that agree count as
fewer by that share; tilts of small markers in poor video stay uncertain for longer.
"""

from dataclasses import dataclass

import numpy as np

from tracker.geometry import Array, Camera, Marker, Rigid, vector_from_rotation
from tracker.geometry.geometry_kernels import rotate_by, rotation_angle_between
from tracker.photometric import KnownIllumination
from tracker.pose.planar import flipped_pose
from tracker.pose.pose_ambiguity import PosePrediction, is_nearer_in_rotation
from tracker.pose.sighting import Seen, Sighting

# A hand changes direction within a tenth of a second, so linear extrapolation does not hold for longer.
MAX_PREDICTION_S = 0.25
# A highlight or a hand may occlude a marker for some images; its last pose is kept for so long.
MAX_UNSEEN_S = 0.07
# Two poses nearer in time than this do not determine a speed.
MIN_INTERVAL_S = 1e-3
MAX_SPEED_MM_S = 1500.0
MAX_ROTATION_RAD = float(np.radians(15.0))
# Evidence for one planar solution is correlated between images: bent paper, illumination and blur stay. So
# old images are forgotten exponentially and the sum is bounded; a few images can always reverse the choice.
FORGETTING_RATIO, MAX_DELTA_CHI2 = 0.9, 25.0
# The effective number of images in the exponential sum.
EFFECTIVE_IMAGES = 1.0 / (1.0 - FORGETTING_RATIO)


@dataclass(slots=True)
class Prior:
    """A marker's last pose with its `delta_chi2`, illumination and motion. Mutable.

    `delta_chi2_before` is the value before the last image. `at_s` is the time of the last new image,
    `repeated_at_s` that of its last repetition. `rates` (6,) [mm/s, rad/s] are the motion, None while it is
    unknown, and `rates_before` those one image earlier.
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

        `is_repeated`: the image is a copy of the last one. Its own evidence is left out, and nothing has
        moved.
        """
        if self.pose is None or not 0.0 < at_s - self.repeated_at_s <= MAX_PREDICTION_S:
            return None
        ahead = 0.0 if is_repeated else min(at_s - self.at_s, MAX_PREDICTION_S)
        moved = np.zeros(6) if self.rates is None else self.rates * ahead
        translation = self.pose.translation_mm + moved[:3]
        rotation = self.pose.rotation.copy()
        rotate_by(rotation, moved[3:])
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
        """Update the prior with a sighting; forget a marker that was not seen for a while.

        A repeated image (`is_repeated`) adds nothing for a marker that was seen in it.
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
        # Faster than any hand: one of the poses was wrong, so the speed does not predict the next image.
        if float(velocity @ velocity) < MAX_SPEED_MM_S**2:
            rates[:3] = velocity
        # A flip between the planar solutions is not a rotation of the hand.
        before = flipped_pose(self.pose) if _is_flipped(now, self.pose) else self.pose
        if float(rotation_angle_between(now.rotation, before.rotation)) < MAX_ROTATION_RAD:
            rates[3:] = vector_from_rotation(now.rotation @ before.rotation.T) / interval
        return rates

    def _update_delta_chi2(self, seen: Seen) -> None:
        """Add the evidence of an image for one of the two solutions, less the part that repeats.

        Systematic residuals repeat in each image, as from a drop on the marker or from doubled rows. Their
        share of the residuals limits how many agreeing images count as independent.
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
            # Without independent residuals even an infinite difference adds nothing.
            gain = gain * share if share > 0.0 else 0.0
        self.delta_chi2_before = before
        self.delta_chi2 = min(FORGETTING_RATIO * max(known + gain, 0.0), MAX_DELTA_CHI2)


def _is_flipped(now: Rigid[Camera, Marker], before: Rigid[Camera, Marker]) -> bool:
    """Whether a pose is nearer to the flipped solution of the one before than to that pose."""
    return is_nearer_in_rotation(now, flipped_pose(before), before)
