"""Means by which a motion of patient or camera can be detected."""

from enum import StrEnum

from tracker.navigation.monitoring import SceneState
from tracker.navigation.snapshot import Absent, NavigationSnapshot
from tracker.registration import AnchoredTo

HOLDS_ON = frozenset({SceneState.STILL, SceneState.MOVED})


class MotionDetection(StrEnum):
    """Means by which a motion of patient or camera can be detected."""

    REFERENCE = "reference"  # motion of both, from the marker on the patient
    FIXED_SCENE = "fixed-scene"  # motion of the camera only, from the static scene; not of the patient
    NONE = "not-at-all"  # neither: no reference, and too little static texture


def motion_detected_by(snapshot: NavigationSnapshot) -> MotionDetection:
    """Return the means at this instant; before a registration, for one made now."""
    setup = snapshot.setup
    if isinstance(setup.registration, Absent):
        by_reference = bool(setup.reference)
    else:
        by_reference = setup.registration.anchored_to is AnchoredTo.REFERENCE
    if by_reference:
        return MotionDetection.REFERENCE
    return MotionDetection.FIXED_SCENE if snapshot.motion.scene in HOLDS_ON else MotionDetection.NONE
