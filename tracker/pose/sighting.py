"""The result of tracking one marker in one image: `Seen` with a pose, or `Unseen` with a reason.

With the non-maximum suppression of results: one marker per position, one rotation per marker.
"""

from dataclasses import dataclass
from enum import StrEnum
from typing import Literal, TypeAlias

import numpy as np

from tracker.geometry import Array, Camera, Marker, Rigid
from tracker.photometric import KnownIllumination
from tracker.pose.occurrence import side_px_of

FoundBy: TypeAlias = Literal["search", "track", "external"]
# Corners nearer than this, in side lengths, are at the same position.
SAME_PLACE_SIDES = 0.1


class UnseenReason(StrEnum):
    """Reason why a marker was not detected in an image.

    Pose ambiguity is not a reason: the more probable of two poses is returned with the covariance of the
    mixture (navigation then reports `POSE_UNCERTAIN`), and the next images resolve it. The ambiguity does not
    affect the position of the marker in the image.
    """

    NO_CANDIDATE = "NO_CANDIDATE"  # no quadrilateral in the image is a candidate
    SCORE_TOO_LOW = "SCORE_TOO_LOW"  # the best candidate has too few of the model's edges
    TARGET_SCORE_TOO_LOW = "TARGET_SCORE_TOO_LOW"  # the best candidate has edges that the model lacks
    SHAPE_DIFFERS = "SHAPE_DIFFERS"  # its edges fit, but a part inside has inverted contrast: another shape
    NOT_REPORTED = "NOT_REPORTED"  # an external tracker reports no valid pose of it
    MARKER_TWICE = "MARKER_TWICE"  # two prints of its shape are in view, and cannot be distinguished


@dataclass(frozen=True, slots=True, kw_only=True)
class Seen:
    """A marker found in an image.

    Attributes:
        camera_from_marker: the pose.
        pose_covariance: (6, 6) [mm, rad]; translation first, then rotation as a small left-multiplied
            rotation vector in the camera frame. Without the second-order term of a lever, which
            `marker_point_covariance_mm2` adds.
        corners_px: (4, 2), top-left, top-right, bottom-right, bottom-left of the printed face, measured on
            the sides next to each corner; projected from the pose where those sides are occluded.
        score_ratio: model coverage x (1 - weight x normalised fit error), 0..1.
        target_score_ratio: target coverage x (1 - weight x normalised fit error), 0..1.
        model_coverage_ratio: length of the model's active edges found in the image, 0..1.
        target_coverage_ratio: length found, by the length of all edges inside the occurrence, 0..1.
        fit_error_px2: mean squared distance of the common edgels to the model's edges.
        found_by: "search" (whole image, no prior), "track" (where it was expected), or "external" (by an
            external tracker: scores are NaN, and corners are missing).
        delta_chi2: chi-square of the flipped planar solution minus that of this pose, over this and previous
            images; infinite where no other solution fits.
        systematic_residual_ratio: share of the variance of the photometric residuals that is not image
            noise, 0..1. This part repeats in the next image. 1 where the pose is fitted to edges only.
        illumination: the estimated uneven illumination; None where it is even or unknown.
        is_noise_corrected: whether the correlation passes only after correction for noise, shadow and
            highlights.
    """

    camera_from_marker: Rigid[Camera, Marker]
    pose_covariance: Array
    corners_px: Array
    score_ratio: float
    target_score_ratio: float
    model_coverage_ratio: float
    target_coverage_ratio: float
    fit_error_px2: float
    found_by: FoundBy
    delta_chi2: float = float("inf")
    systematic_residual_ratio: float = 1.0
    illumination: KnownIllumination | None = None
    is_noise_corrected: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class Unseen:
    """A marker that was not detected in an image.

    Attributes:
        reason: reason of the rejection.
        best_score_ratio: the best score of any candidate, 0 if none was scored. None where only a part of
            the image was searched; the reason is then that of the last complete search.
    """

    reason: UnseenReason
    best_score_ratio: float | None = 0.0


Sighting: TypeAlias = Seen | Unseen


def is_twice_in_view(sighting: Sighting | None) -> bool:
    """Return whether two prints of this marker are in view."""
    return isinstance(sighting, Unseen) and sighting.reason is UnseenReason.MARKER_TWICE


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
