"""Position of the tip in one image, in the anchor frame of a registration."""

from collections.abc import Sequence

import numpy as np
import numpy.typing as npt

from tracker.pose import Seen, ToolModel, marker_point_covariance_mm2
from tracker.registration.capture import CapturedLandmark, TipSample
from tracker.registration.points import CommonTip, PointPairs


def tip_in_anchor(tool: ToolModel, seen: Seen, reference: Seen | None, *, at_s: float) -> TipSample:
    """Return the tip position in one image, in the camera frame, or relative to the reference if given.

    The covariance includes the marker's pose, the calibration of the tip, and the reference's pose.
    """
    pose, tip = seen.camera_from_marker, tool.marker_from_tool.translation_mm
    in_camera = pose.move_points(tip)
    covariance = marker_point_covariance_mm2(pose, seen.pose_covariance, tip)
    covariance = covariance + pose.rotation @ tool.tip_covariance_mm2 @ pose.rotation.T
    if reference is None:
        return TipSample(
            at_s=at_s,
            tip_in_anchor_mm=in_camera,
            covariance_mm2=covariance,
            anchor_from_marker=pose.rotation,
            tip_covariance_mm2=tool.tip_covariance_mm2,
        )
    back = reference.camera_from_marker.inverse
    in_reference = back.move_points(in_camera)
    # An error of the reference displaces the tip by as much as it would displace a point fixed to it there.
    covariance = covariance + marker_point_covariance_mm2(
        reference.camera_from_marker, reference.pose_covariance, in_reference
    )
    return TipSample(
        at_s=at_s,
        tip_in_anchor_mm=in_reference,
        covariance_mm2=back.rotation @ covariance @ back.rotation.T,
        anchor_from_marker=back.rotation @ pose.rotation,
        tip_covariance_mm2=tool.tip_covariance_mm2,
    )


def pairs_of_touches(
    fixed_mm: npt.ArrayLike, touched: Sequence[CapturedLandmark], *, labels: Sequence[str], tool: str
) -> PointPairs:
    """Return landmarks (n, 3) on the CT paired with captures by one tool; separate the common tip error.

    If it was treated as independent noise, that error would be underestimated for the registration, and
    counted twice for the drill.
    """
    return PointPairs(
        fixed_mm=np.asarray(fixed_mm, dtype=np.float64).reshape(-1, 3),
        moving_mm=np.array([one.tip_in_anchor_mm for one in touched]).reshape(-1, 3),
        moving_covariances_mm2=np.array([one.own_covariance_mm2 for one in touched]).reshape(-1, 3, 3),
        labels=tuple(labels),
        common=None
        if not touched
        else CommonTip(
            tool=tool,
            covariance_mm2=touched[-1].tip_covariance_mm2,
            anchor_from_marker=np.array([one.anchor_from_marker for one in touched]),
        ),
    )
