"""Covariance of a pose in video whose images are predicted from earlier ones."""

import numpy as np
import pytest

from tests.tracker.scenes import STRAIGHT, camera_of, corners_px_of, facing, perfectly_seen
from tracker.pose import with_prediction_error

CAMERA = camera_of(focal_px=1000.0, distortion=STRAIGHT)


def test_the_variance_is_three_times_as_large_and_the_marker_may_be_displaced_by_a_twentieth_pixel() -> None:
    # 25 mm at 500 mm are 50 px; 0.05 px are 0.025 mm there, and turn a side of 50 px by a milliradian.
    pose = facing([0.0, 0.0, 500.0])
    covariance = 1e-5 * np.eye(6)
    sighting = perfectly_seen(pose, covariance=covariance, corners_px=corners_px_of(CAMERA, pose))

    stated = with_prediction_error(sighting, CAMERA).pose_covariance

    added = stated - 3.0 * covariance
    assert np.diag(added) == pytest.approx([0.025**2, 0.025**2, 0.0, 0.0, 0.0, 0.001**2], rel=0.01, abs=1e-12)
    assert np.count_nonzero(added - np.diag(np.diag(added))) == 0
    np.testing.assert_array_equal(sighting.pose_covariance, covariance)
