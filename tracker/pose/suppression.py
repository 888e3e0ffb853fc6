"""Non-maximum suppression of sightings: one marker per position, one rotation per marker."""

import numpy as np

from tracker.pose.occurrence import side_px_of
from tracker.pose.sighting import Seen, Sighting, Unseen, UnseenReason

# Corners nearer than this, in side lengths, are at the same position.
SAME_PLACE_SIDES = 0.1


def differ_by_rotation(one: Sighting, other: Sighting) -> bool:
    """Return whether both sightings lie on the same square and differ by multiples of 90 degrees."""
    if not (isinstance(one, Seen) and isinstance(other, Seen)):
        return False
    turned = (np.abs(np.roll(other.corners_px, quarters, axis=0) - one.corners_px) for quarters in (1, 2, 3))
    near = SAME_PLACE_SIDES * side_px_of(one.corners_px)
    return any(float(distances.max()) < near for distances in turned)


def is_same_square(one: Seen, other: Seen) -> bool:
    """Return whether the centre of the other square is nearer than half a side of this one."""
    apart_px = np.linalg.norm(other.corners_px.mean(axis=0) - one.corners_px.mean(axis=0))
    return bool(apart_px < 0.5 * side_px_of(one.corners_px))


def suppress_overlaps(sightings: dict[str, Sighting]) -> dict[str, Sighting]:
    """Return the sightings by name; of two markers on one square, only the higher ranked remains `Seen`."""
    remaining = dict(sightings)
    if sum(isinstance(sighting, Seen) for sighting in sightings.values()) < 2:
        return remaining
    names = sorted(sightings, key=lambda name: rank_score(sightings[name]), reverse=True)
    places: list[Seen] = []
    for name in names:
        sighting = sightings[name]
        if not isinstance(sighting, Seen):
            continue
        if any(is_same_square(sighting, other) for other in places):
            remaining[name] = Unseen(reason=UnseenReason.SHAPE_DIFFERS, best_score_ratio=sighting.score_ratio)
        else:
            places.append(sighting)
    return remaining


def rank_score(sighting: Sighting) -> float:
    """Return a score to rank sightings: `Seen` above noise-corrected above `Unseen`, then by the scores."""
    if isinstance(sighting, Seen):
        scores = sighting.score_ratio + sighting.target_score_ratio
        return 1.0 + 0.5 * scores if sighting.is_noise_corrected else 2.0 + scores
    return sighting.best_score_ratio or 0.0
