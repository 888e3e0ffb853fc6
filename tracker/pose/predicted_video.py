"""Pose error in video whose images are predicted from earlier ones (MPEG-4, H.264, H.265, VP9).

Such a codec moves blocks of the image before by quarters of a pixel, and codes what then still differs only
above its quantiser. What it leaves out lies along the very changes that a moving marker makes: a fit takes it
for a pose, and the residuals do not show it. Images that are coded one by one (JPEG) have no such error.

Both figures below were measured on rendered sequences with known truth (`tests.benchmarks.compressed_video`):
markers of 22 to 50 px, at rest to 100 mm/s, three rates of each codec. The errors of neighbouring images are
independent while the marker moves; of a marker at rest they repeat, and no average reduces them.
"""

from dataclasses import replace

import numpy as np

from tracker.camera import CameraModel
from tracker.pose.occurrence import side_px_of
from tracker.pose.sighting import Seen

# Variance of a pose over that which its residuals show.
VARIANCE_FACTOR = 3.0
# Displacement of the whole marker in the image, in each direction (sd).
DISPLACEMENT_SD_PX = 0.05


def with_prediction_error(seen: Seen, camera: CameraModel) -> Seen:
    """Return a sighting in predicted video, with the error of prediction in its covariance.

    The covariance is scaled, and a displacement in the image by `DISPLACEMENT_SD_PX` in x and y is added, and
    that rotation about the optical axis which moves the ends of a side against each other as far.
    """
    pose = seen.camera_from_marker
    covariance = VARIANCE_FACTOR * seen.pose_covariance
    depth_mm = float(pose.translation_mm[2])
    for axis in (0, 1):
        covariance[axis, axis] += (DISPLACEMENT_SD_PX * depth_mm / float(camera.matrix[axis, axis])) ** 2
    covariance[5, 5] += (DISPLACEMENT_SD_PX / side_px_of(np.asarray(seen.corners_px))) ** 2
    return replace(seen, pose_covariance=covariance)
