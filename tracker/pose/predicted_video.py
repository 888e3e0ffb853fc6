"""Pose error in video whose images are predicted from earlier ones (MPEG-4, H.264, H.265, VP9).

Such a codec uses motion compensation at quarter-pixel resolution, and quantises the prediction residual. The
quantised-out residual looks like a small motion of the marker: the fit absorbs it into the pose, and the
photometric residuals do not contain it. Intra-coded images (JPEG) do not have this error.

Both constants were measured on rendered sequences with ground truth (`tests.benchmarks.compressed_video`):
markers of 22 to 50 px, at rest to 100 mm/s, three bit rates of each codec. The errors of neighbouring images
are independent while the marker moves. For a marker at rest they repeat, and averaging does not reduce them.
"""

from dataclasses import replace

import numpy as np

from tracker.camera import CameraModel
from tracker.pose.occurrence import side_px_of
from tracker.pose.sighting import Seen

# Ratio of a pose's variance to the variance estimated from its residuals.
VARIANCE_FACTOR = 3.0
# Displacement of the whole marker in the image, in each direction (sd).
DISPLACEMENT_SD_PX = 0.05


def with_prediction_error(seen: Seen, camera: CameraModel) -> Seen:
    """Return a sighting in predicted video, with the codec's prediction error in its covariance.

    The covariance is scaled by `VARIANCE_FACTOR`. Added are a displacement in the image by
    `DISPLACEMENT_SD_PX` in x and y, and the rotation about the optical axis that displaces the ends of a side
    by the same amount.
    """
    pose = seen.camera_from_marker
    covariance = VARIANCE_FACTOR * seen.pose_covariance
    depth_mm = float(pose.translation_mm[2])
    for axis in (0, 1):
        covariance[axis, axis] += (DISPLACEMENT_SD_PX * depth_mm / float(camera.matrix[axis, axis])) ** 2
    covariance[5, 5] += (DISPLACEMENT_SD_PX / side_px_of(np.asarray(seen.corners_px))) ** 2
    return replace(seen, pose_covariance=covariance)
