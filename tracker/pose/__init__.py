"""Pose estimation of a marker from its edges and pixels, and the tool attached to it."""

from tracker.pose.acceptance import OccurrenceContext, verify_occurrence
from tracker.pose.external_tracker import ExternalTracker
from tracker.pose.occurrence import (
    Occurrence,
    Window,
    corners_px_at,
    occurrence_near,
    side_px_of,
    window_around,
    with_target_coverage,
)
from tracker.pose.photometric_refinement import ImageContext
from tracker.pose.planar import flipped_pose, pose_from_corners
from tracker.pose.pose_ambiguity import DECIDED_COST
from tracker.pose.predicted_video import with_prediction_error
from tracker.pose.prior import Prior
from tracker.pose.refinement import EdgeFit, fit_pose_to_edges
from tracker.pose.rolling_shutter import RollingShutter
from tracker.pose.second_order import covariance_at_lever, marker_point_covariance_mm2
from tracker.pose.sighting import (
    FoundBy,
    Seen,
    Sighting,
    Unseen,
    UnseenReason,
    differ_by_rotation,
    is_same_square,
    is_twice_in_view,
    rank_score,
    suppress_overlaps,
)
from tracker.pose.smoothing import PoseSmoother, SmoothedPose, SmoothingSettings
from tracker.pose.tool import ToolModel

__all__ = [
    "DECIDED_COST",
    "EdgeFit",
    "ExternalTracker",
    "FoundBy",
    "ImageContext",
    "Occurrence",
    "OccurrenceContext",
    "PoseSmoother",
    "Prior",
    "RollingShutter",
    "Seen",
    "Sighting",
    "SmoothedPose",
    "SmoothingSettings",
    "ToolModel",
    "Unseen",
    "UnseenReason",
    "Window",
    "corners_px_at",
    "covariance_at_lever",
    "differ_by_rotation",
    "fit_pose_to_edges",
    "flipped_pose",
    "is_same_square",
    "is_twice_in_view",
    "marker_point_covariance_mm2",
    "occurrence_near",
    "pose_from_corners",
    "rank_score",
    "side_px_of",
    "suppress_overlaps",
    "verify_occurrence",
    "window_around",
    "with_prediction_error",
    "with_target_coverage",
]
