"""Poses of the rigid bodies of an external tracker, in place of those of markers in an image."""

from collections.abc import Mapping
from dataclasses import dataclass
from math import nan

import numpy as np

from tracker.geometry import Camera, Marker, Rigid
from tracker.pose.sighting import Seen, Sighting, Unseen, UnseenReason


@dataclass(frozen=True, slots=True, kw_only=True)
class ExternalTracker:
    """A tracker, optical or electromagnetic, that reports poses. Its frame takes the place of the camera's.

    Attributes:
        bodies: names of its rigid bodies, which take the place of markers.
        sd_mm: standard deviation of the position of a body along each axis.
        sd_deg: standard deviation of its rotation about each axis.
    """

    bodies: tuple[str, ...]
    sd_mm: float
    sd_deg: float

    def sightings(self, poses: Mapping[str, Rigid[Camera, Marker]]) -> dict[str, Sighting]:
        """Return a sighting of each body; `poses` has those of one moment that are valid.

        Scores and corners are of images, and therefore NaN and empty. The error counts as the same in
        consecutive poses, because a tracker's is mainly that of its calibration: averaging does not reduce
        it.
        """
        variances = [self.sd_mm**2] * 3 + [np.radians(self.sd_deg) ** 2] * 3
        return {
            name: Unseen(reason=UnseenReason.NOT_REPORTED, best_score_ratio=None)
            if name not in poses
            else Seen(
                camera_from_marker=poses[name],
                pose_covariance=np.diag(variances),
                corners_px=np.empty((0, 2)),
                score_ratio=nan,
                target_score_ratio=nan,
                model_coverage_ratio=nan,
                target_coverage_ratio=nan,
                fit_error_px2=nan,
                found_by="external",
            )
            for name in self.bodies
        }
