"""The result of tracking one marker in one image: `Seen` with a pose, or `Unseen` with a reason."""

from dataclasses import dataclass
from enum import StrEnum
from typing import Literal, TypeAlias

from tracker.geometry import Array, Camera, Marker, Rigid
from tracker.photometric import KnownIllumination

FoundBy: TypeAlias = Literal["search", "track"]


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
        found_by: "search" (whole image, no prior) or "track" (where it was expected).
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
