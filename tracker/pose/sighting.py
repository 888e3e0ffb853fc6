"""What one image says of one marker: seen with its pose, or not seen with the reason."""

from dataclasses import dataclass
from enum import StrEnum
from typing import Literal, TypeAlias

from tracker.appearance import KnownLight
from tracker.geometry import Array, Camera, Marker, Rigid

FoundBy: TypeAlias = Literal["search", "track"]


class UnseenReason(StrEnum):
    """Why a marker is not claimed in an image.

    Two poses that explain it equally well are no such reason: the likelier one is claimed, with a covariance
    that reaches over both (`POSE_UNCERTAIN` is what navigation makes of it), and the next images decide. So
    the marker stays in sight, and its place in the image is as good as ever.
    """

    NO_CANDIDATE = "NO_CANDIDATE"  # nothing in the image has the outline of the marker
    SCORE_TOO_LOW = "SCORE_TOO_LOW"  # something has, but too few of the marker's edges are there
    TARGET_SCORE_TOO_LOW = "TARGET_SCORE_TOO_LOW"  # ... or edges are there that the marker has not
    SHAPE_DIFFERS = "SHAPE_DIFFERS"  # its edges fit, but a part inside is dark for bright: a look-alike


@dataclass(frozen=True, slots=True, kw_only=True)
class Seen:
    """A marker found in an image.

    Attributes:
        camera_from_marker: the pose.
        pose_covariance: (6, 6) [mm, rad]; translation first, then rotation as a small left-multiplied
            rotation vector in the camera frame.
        corners_px: (4, 2), top-left, top-right, bottom-right, bottom-left of the printed face, as the sides
            next to each show them; where those are hidden, as the pose has them.
        score_ratio: model coverage x (1 - weight x normalised fit error), 0..1.
        target_score_ratio: target coverage x the same, 0..1.
        model_coverage_ratio: length of the model's active edges found in the image, 0..1.
        target_coverage_ratio: length found, by the length of all edges inside the occurrence, 0..1.
        fit_error_px2: mean squared distance of the common edgels to the model's edges.
        found_by: "search" (whole image, no prior) or "track" (where it was expected).
        lead_sd2: by how much this image and those before speak for this pose against the other planar
            solution, in squared residuals by their variance; infinite where no other fits.
        unexplained_ratio: of what its fit leaves of the pixels, the share (of the variance) that is not the
            image's noise, 0..1: it comes again in the next image. 1 where edges told alone.
        light: the uneven light that its pixels were explained in; None where it is even, or edges told alone.
        is_in_noise: whether it is like the model only where noise, shadow and highlights do not hide it.
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
    lead_sd2: float = float("inf")
    unexplained_ratio: float = 1.0
    light: KnownLight | None = None
    is_in_noise: bool = False


@dataclass(frozen=True, slots=True, kw_only=True)
class Unseen:
    """A marker that is not claimed in an image.

    Attributes:
        reason: why not.
        best_score_ratio: the best score that anything in the image reached, 0 if nothing was scored. None
            where only a part of it was searched: then the reason is that of the last whole search.
    """

    reason: UnseenReason
    best_score_ratio: float | None = 0.0


Sighting: TypeAlias = Seen | Unseen
