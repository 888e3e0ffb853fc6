"""The tip in one image, seen from what a registration is fixed to."""

from tracker.geometry import inverse_covariance, point_covariance_mm2
from tracker.pose import Seen, ToolModel
from tracker.registration.capture import TipSample


def tip_in_anchor(tool: ToolModel, seen: Seen, reference: Seen | None, *, at_s: float) -> TipSample:
    """Where the tip is in one image: before the camera, or beside the marker on the patient if given.

    Its covariance is of the marker's pose, of the tip behind the marker, and of the reference's pose.
    """
    pose, tip = seen.camera_from_marker, tool.marker_from_tool.translation_mm
    in_camera = pose.move_points(tip)
    covariance = point_covariance_mm2(pose, seen.pose_covariance, tip)
    covariance = covariance + pose.rotation @ tool.tip_covariance_mm2 @ pose.rotation.T
    if reference is None:
        return TipSample(at_s=at_s, tip_in_anchor_mm=in_camera, covariance_mm2=covariance)
    back = reference.camera_from_marker.inverse
    of_back = inverse_covariance(reference.camera_from_marker, reference.pose_covariance)
    return TipSample(
        at_s=at_s,
        tip_in_anchor_mm=back.move_points(in_camera),
        covariance_mm2=point_covariance_mm2(back, of_back, in_camera)
        + back.rotation @ covariance @ back.rotation.T,
    )
