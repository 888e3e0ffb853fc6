"""What sightings are worth beside each other: one marker for each place, and one way up for each marker."""

import numpy as np

from tracker.pose.occurrence import side_px_of
from tracker.pose.sighting import Seen, Sighting, Unseen, UnseenReason

# In sides: corners that are nearer are at one place.
ONE_PLACE_SIDES = 0.1


def are_turned(one: Sighting, other: Sighting) -> bool:
    """Whether both see the marker in one square, and each another way up."""
    if not (isinstance(one, Seen) and isinstance(other, Seen)):
        return False
    turned = (np.abs(np.roll(other.corners_px, quarters, axis=0) - one.corners_px) for quarters in (1, 2, 3))
    near = ONE_PLACE_SIDES * side_px_of(one.corners_px)
    return any(float(apart.max()) < near for apart in turned)


def one_for_each_place(sightings: dict[str, Sighting]) -> dict[str, Sighting]:
    """Where two markers are claimed on one square, the one that fits it better; the other is not there."""
    kept = dict(sightings)
    if sum(isinstance(sighting, Seen) for sighting in sightings.values()) < 2:
        return kept
    names = sorted(sightings, key=lambda name: worth_of(sightings[name]), reverse=True)
    places: list[Seen] = []
    for name in names:
        sighting = sightings[name]
        if not isinstance(sighting, Seen):
            continue
        centre, side = sighting.corners_px.mean(axis=0), side_px_of(sighting.corners_px)
        if any(np.linalg.norm(other.corners_px.mean(axis=0) - centre) < 0.5 * side for other in places):
            kept[name] = Unseen(reason=UnseenReason.SHAPE_DIFFERS, best_score_ratio=sighting.score_ratio)
        else:
            places.append(sighting)
    return kept


def worth_of(sighting: Sighting) -> float:
    """What is seen is worth more than what is not, in plain sight more than in noise; then by its scores."""
    if isinstance(sighting, Seen):
        scores = sighting.score_ratio + sighting.target_score_ratio
        return 1.0 + 0.5 * scores if sighting.is_in_noise else 2.0 + scores
    return sighting.best_score_ratio or 0.0
