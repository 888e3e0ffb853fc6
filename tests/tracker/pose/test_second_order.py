"""Second-order term of a rotation error on a point at a lever."""

import numpy as np
import pytest

from tracker.geometry import Camera, Marker, Rigid, point_covariance_mm2
from tracker.pose.second_order import (
    covariance_at_lever,
    marker_point_covariance_mm2,
    second_order_variance_mm2,
)

TILT_2_DEG = np.diag([0.0, 0.0, 0.0, np.radians(2.0) ** 2, np.radians(2.0) ** 2, 0.0])


@pytest.mark.parametrize(
    ("lever_mm", "sd_mm"), [(0.0, 0.0), (60.0, 0.1034), (120.0, 0.2068), (250.0, 0.4308)]
)
def test_the_term_is_what_a_hand_computes(lever_mm: float, sd_mm: float) -> None:
    # Two angles of 2 deg: E[(a^2 + b^2)^2] = 8 sd^4, so the sd is half the lever times sqrt(8) sd^2.
    assert np.sqrt(second_order_variance_mm2(TILT_2_DEG, lever_mm)) == pytest.approx(sd_mm, abs=1e-4)
    np.testing.assert_array_equal(
        second_order_variance_mm2(np.array([TILT_2_DEG, 0.0 * TILT_2_DEG]), lever_mm)[1], 0.0
    )


def test_only_the_point_s_own_variance_grows() -> None:
    raised = covariance_at_lever(TILT_2_DEG, 120.0) - TILT_2_DEG
    np.testing.assert_allclose(raised, np.diag([0.2068**2] * 3 + [0.0] * 3), atol=1e-4)
    pose: Rigid[Camera, Marker] = Rigid.from_vector([0.3, 2.6, -0.4], [20.0, -30.0, 450.0])
    at = [0.0, -72.0, 96.0]
    grown = marker_point_covariance_mm2(pose, TILT_2_DEG, at) - point_covariance_mm2(pose, TILT_2_DEG, at)
    np.testing.assert_allclose(grown, 0.2068**2 * np.eye(3), atol=1e-4)
