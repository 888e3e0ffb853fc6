"""What the last images let expect of the next.

A repeated image adds no evidence: 25 copies from a frozen camera would make a doubtful pose certain, and a
capture card that repeats each image of a slower camera would show a marker at rest and then at twice its
speed. An image whose pixels around the marker equal the last ones is ignored. Two alternating images are
not noticed.

A residual that is no noise (`Seen.unexplained_ratio`), as of a drop on the marker or of doubled rows,
repeats in every image and would make the wrong tilt certain within a few. So images that agree count as
fewer by that share; tilts of small markers in poor video stay uncertain for longer.
"""

from dataclasses import dataclass

import numpy as np

from tracker.appearance import KnownLight
from tracker.geometry import Array, Camera, Marker, Rigid, vector_from_rotation
from tracker.geometry.kernels import turn_between, turn_by
from tracker.pose.planar import other_solution
from tracker.pose.rivals import Expected, is_nearer
from tracker.pose.sighting import Seen, Sighting

# A hand changes its mind within a tenth of a second: farther ahead a straight line is a guess.
LONGEST_AHEAD_S = 0.25
# A highlight or a hand may hide a marker for some images; where it was then is where it is.
LONGEST_UNSEEN_S = 0.07
# Two poses nearer in time than this say nothing about speed.
MIN_INTERVAL_S = 1e-3
MAX_SPEED_MM_S = 1500.0
MAX_TURN_RAD = float(np.radians(15.0))
# What speaks for one of the planar solutions is not all new in each image: bent paper, light and blur stay.
# So images long past lose their say, and some that agree always suffice to turn the judgement.
KEPT_LEAD_RATIO, MAX_LEAD_SD2 = 0.9, 25.0
# By as many images as ever have a say together, an image says more than alone.
IMAGES_KEPT = 1.0 / (1.0 - KEPT_LEAD_RATIO)


@dataclass(slots=True)
class Prior:
    """A marker's last pose, how sure it is, its light and its motion. Mutable: the tracker's window.

    `lead_before_sd2` is what the images before the last one spoke for. `at_s` is of the last image, and
    `again_at_s` of when it came last: later, where it came again. `rates` (6,) [mm/s, rad/s] are its motion,
    if that is known, and `rates_before` those an image earlier.
    """

    pose: Rigid[Camera, Marker] | None = None
    lead_sd2: float = 0.0
    lead_before_sd2: float = 0.0
    light: KnownLight | None = None
    at_s: float = 0.0
    again_at_s: float = 0.0
    rates: Array | None = None
    rates_before: Array | None = None

    def expected(self, at_s: float, *, is_again: bool = False) -> Expected | None:
        """Where the marker should be at this time; None when nobody can know.

        `is_again`: the image is the last one once more: it has no say in what to expect of itself, and
        nothing has moved.
        """
        if self.pose is None or not 0.0 < at_s - self.again_at_s <= LONGEST_AHEAD_S:
            return None
        ahead = 0.0 if is_again else min(at_s - self.at_s, LONGEST_AHEAD_S)
        moved = np.zeros(6) if self.rates is None else self.rates * ahead
        translation = self.pose.translation_mm + moved[:3]
        rotation = self.pose.rotation.copy()
        turn_by(rotation, moved[3:])
        if translation[2] <= 1.0 or float(rotation[:, 2] @ translation) >= 0.0:
            return None
        pose: Rigid[Camera, Marker] = Rigid(rotation=rotation, translation_mm=translation)
        return Expected(
            rotation=pose.rotation,
            translation_mm=pose.translation_mm,
            rival=other_solution(pose),
            lead_sd2=self.lead_before_sd2 if is_again else self.lead_sd2,
            light=self.light,
        )

    def learn(self, sighting: Sighting, at_s: float, *, is_again: bool = False) -> None:
        """Take in what an image said; a marker that is not seen for a while is forgotten.

        From an image that comes again (`is_again`), nothing is learnt of a marker that was seen in it.
        """
        if is_again and isinstance(sighting, Seen) and self.expected(at_s, is_again=True) is not None:
            self.again_at_s = at_s
            return
        if not isinstance(sighting, Seen):
            if not 0.0 < at_s - self.again_at_s <= LONGEST_UNSEEN_S:
                self.pose = None
            return
        self._weigh(sighting)
        self.rates_before, self.rates = self.rates, self.rates_to(sighting.camera_from_marker, at_s)
        self.pose, self.at_s, self.again_at_s = sighting.camera_from_marker, at_s, at_s
        self.light = sighting.light

    def rates_to(self, now: Rigid[Camera, Marker], at_s: float) -> Array | None:
        """The motion (6,) [mm/s, rad/s] since the last image; None where that is too long ago."""
        interval = at_s - self.at_s
        if self.pose is None or not MIN_INTERVAL_S < interval <= LONGEST_AHEAD_S:
            return None
        rates = np.zeros(6)
        velocity = (now.translation_mm - self.pose.translation_mm) / interval
        # Faster than any hand: it was somewhere else before, and that says nothing of the next image.
        if float(velocity @ velocity) < MAX_SPEED_MM_S**2:
            rates[:3] = velocity
        # From one planar solution to the other is no turn of the hand.
        before = other_solution(self.pose) if _is_turned_over(now, self.pose) else self.pose
        if float(turn_between(now.rotation, before.rotation)) < MAX_TURN_RAD:
            rates[3:] = vector_from_rotation(now.rotation @ before.rotation.T) / interval
        return rates

    def _weigh(self, seen: Seen) -> None:
        """Take in what an image says for one of both solutions, as far as the next ones do not repeat it.

        What no noise explains comes again in each image, as of a drop on the marker or of doubled rows: as a
        share of what is left it says in how many images that agree there is something new.
        """
        before = 0.0 if seen.found_by == "search" or self.pose is None else self.lead_sd2
        is_against = (
            before > 0.0 and self.pose is not None and _is_turned_over(seen.camera_from_marker, self.pose)
        )
        known = -before if is_against else before
        says = seen.lead_sd2 - known
        if says > 0.0:
            images = min(1.0 / max(seen.unexplained_ratio, 1e-9), IMAGES_KEPT)
            share = (images - 1.0) / (IMAGES_KEPT - 1.0)
            # An infinite lead, too, says nothing new where all that is left comes again.
            says = says * share if share > 0.0 else 0.0
        self.lead_before_sd2 = before
        self.lead_sd2 = min(KEPT_LEAD_RATIO * max(known + says, 0.0), MAX_LEAD_SD2)


def _is_turned_over(now: Rigid[Camera, Marker], before: Rigid[Camera, Marker]) -> bool:
    """Whether a pose is nearer to the other solution of the one before."""
    return is_nearer(now, other_solution(before), before)
