"""From the marker's edges to its pose, and to the tool behind it."""

from tracker.pose.judgement import Scene, judged
from tracker.pose.occurrence import Occurrence, corners_px_at, occurrence_near, side_px_of, with_target
from tracker.pose.places import are_turned, one_for_each_place, worth_of
from tracker.pose.planar import other_solution, pose_from_corners
from tracker.pose.prior import Prior
from tracker.pose.readout import Readout
from tracker.pose.refinement import Fit, refined_pose
from tracker.pose.sighting import FoundBy, Seen, Sighting, Unseen, UnseenReason
from tracker.pose.steady import Steady, SteadyPose, SteadySettings
from tracker.pose.tool import ToolModel
from tracker.pose.whole import Pixels
from tracker.pose.window import window_around

__all__ = [
    "Fit",
    "FoundBy",
    "Occurrence",
    "Pixels",
    "Prior",
    "Readout",
    "Scene",
    "Seen",
    "Sighting",
    "Steady",
    "SteadyPose",
    "SteadySettings",
    "ToolModel",
    "Unseen",
    "UnseenReason",
    "are_turned",
    "corners_px_at",
    "judged",
    "occurrence_near",
    "one_for_each_place",
    "other_solution",
    "pose_from_corners",
    "refined_pose",
    "side_px_of",
    "window_around",
    "with_target",
    "worth_of",
]
