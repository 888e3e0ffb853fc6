"""By what a move of patient or camera would be noticed."""

from enum import StrEnum

from tracker.navigation.snapshot import Absent, NavigationSnapshot
from tracker.navigation.watch import SceneState
from tracker.registration import AnchoredTo

HOLDS_ON = frozenset({SceneState.STILL, SceneState.MOVED})


class MovesSeen(StrEnum):
    """By what a move of patient or camera is noticed."""

    REFERENCE = "reference"  # the marker on the patient: both
    FIXED_SCENE = "fixed-scene"  # the camera alone, by what stands still around it; the patient not
    NOT_AT_ALL = "not-at-all"  # neither: there is no reference, and nothing else to hold on to


def moves_seen_by(snapshot: NavigationSnapshot) -> MovesSeen:
    """By what a move is noticed at this instant; before a registration, as one would be made now."""
    setup = snapshot.setup
    if isinstance(setup.registration, Absent):
        by_reference = bool(setup.reference)
    else:
        by_reference = setup.registration.anchored_to is AnchoredTo.REFERENCE
    if by_reference:
        return MovesSeen.REFERENCE
    return MovesSeen.FIXED_SCENE if snapshot.watched.scene in HOLDS_ON else MovesSeen.NOT_AT_ALL
