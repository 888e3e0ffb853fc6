"""What the last images let expect of the next."""

from dataclasses import dataclass, field

import numpy as np

from tracker.appearance import KnownLight
from tracker.geometry import Camera, Marker, Rigid, vector_from_rotation
from tracker.geometry.kernels import turn_between, turn_by
from tracker.pose.planar import other_solution
from tracker.pose.rivals import Expected
from tracker.pose.sighting import Seen, Sighting

# A hand changes its mind within a tenth of a second: farther ahead a straight line is a guess.
LONGEST_AHEAD_S = 0.25
# A highlight or a hand may hide a marker for some images; where it was then is where it is.
LONGEST_UNSEEN_S = 0.07
# Two poses nearer in time than this say nothing about speed.
LEAST_INTERVAL_S = 1e-3
MOST_SPEED_MM_S = 1500.0
MOST_TURN_RAD = float(np.radians(15.0))
# What speaks for one of the planar solutions is not all new in each image: bent paper, light and blur stay.
# So images long past lose their say, and some that agree always suffice to turn the judgement.
KEPT_LEAD_RATIO, MOST_LEAD_SD2 = 0.9, 25.0


@dataclass(slots=True)
class Prior:
    """A marker's last pose, how sure it is, its light and its motion. Mutable: the tracker's window.

    `lead_before_sd2` is what the images before the last one spoke for. `at_s` is of the last image, and
    `again_at_s` of when it came last: later, where it came again.
    """

    pose: Rigid[Camera, Marker] | None = None
    lead_sd2: float = 0.0
    lead_before_sd2: float = 0.0
    light: KnownLight | None = None
    at_s: float = 0.0
    again_at_s: float = 0.0
    velocity_mm_s: np.ndarray = field(default_factory=lambda: np.zeros(3))
    turning_rad_s: np.ndarray = field(default_factory=lambda: np.zeros(3))

    def expected(self, at_s: float, *, is_again: bool = False) -> Expected | None:
        """Where the marker should be at this time; None when nobody can know.

        `is_again`: the image is the last one once more: it has no say in what to expect of itself, and
        nothing has moved.
        """
        if self.pose is None or not 0.0 < at_s - self.again_at_s <= LONGEST_AHEAD_S:
            return None
        ahead = 0.0 if is_again else min(at_s - self.at_s, LONGEST_AHEAD_S)
        translation = self.pose.translation_mm + self.velocity_mm_s * ahead
        rotation = self.pose.rotation.copy()
        turn_by(rotation, self.turning_rad_s * ahead)
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
        interval = at_s - self.at_s
        self.velocity_mm_s, self.turning_rad_s = np.zeros(3), np.zeros(3)
        if self.pose is not None and LEAST_INTERVAL_S < interval <= LONGEST_AHEAD_S:
            now = sighting.camera_from_marker
            velocity = (now.translation_mm - self.pose.translation_mm) / interval
            # Faster than any hand: it was somewhere else before, and that says nothing of the next image.
            if float(velocity @ velocity) < MOST_SPEED_MM_S**2:
                self.velocity_mm_s = velocity
            # From one planar solution to the other is no turn of the hand.
            before = (self.pose, other_solution(self.pose))
            turns = [float(turn_between(now.rotation, pose.rotation)) for pose in before]
            nearer = before[turns[1] < turns[0]]
            if min(turns) < MOST_TURN_RAD:
                turned = vector_from_rotation(now.rotation @ nearer.rotation.T)
                self.turning_rad_s = turned / interval
        self.pose, self.at_s, self.again_at_s = sighting.camera_from_marker, at_s, at_s
        self.light = sighting.light
        self.lead_before_sd2 = self.lead_sd2 if sighting.found_by == "track" else 0.0
        self.lead_sd2 = min(KEPT_LEAD_RATIO * sighting.lead_sd2, MOST_LEAD_SD2)
