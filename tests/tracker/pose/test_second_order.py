"""Effect of rotational uncertainty on the end of a tool, against rotations drawn from its covariance."""

import numpy as np
import pytest

from tracker.geometry import Array, Camera, Rigid, Tool, point_covariance_mm2, rotation_from_vector
from tracker.pose.second_order import TOOL_REACH_MM, second_order_covariance

# Inside so many squared standard deviations are 95 % of three normally distributed numbers.
INSIDE_SD2 = 7.815
# The end of a tool in the marker's plane: what a tilt does to it across the line of sight is of second order.
END_MM = np.array([0.0, TOOL_REACH_MM, 0.0])
FACING: Rigid[Camera, Tool] = Rigid(
    rotation=np.diag([1.0, -1.0, -1.0]), translation_mm=np.array([0.0, 0.0, 500.0])
)


def _inside(covariance: Array, stated: Array) -> float:
    """Share of ends inside the stated (6, 6), for pose errors with a covariance (6, 6)."""
    around = np.random.default_rng(3).multivariate_normal(np.zeros(6), covariance, 2000)
    shape = point_covariance_mm2(FACING, stated, END_MM)
    arm = FACING.rotation @ END_MM
    off = np.array([one[:3] + rotation_from_vector(one[3:]) @ arm - arm for one in around])
    return float(np.mean(np.einsum("ni,ij,nj->n", off, np.linalg.inv(shape), off) < INSIDE_SD2))


@pytest.mark.parametrize("tilt_deg", [0.5, 1.0, 3.0])
def test_ends_lie_inside_what_is_stated_though_they_go_along_an_arc(tilt_deg: float) -> None:
    tilt, roll = np.radians(tilt_deg) ** 2, np.radians(0.01) ** 2
    covariance = np.diag([1e-4, 1e-4, 1e-2, tilt, tilt, roll])
    assert _inside(covariance, covariance) < 0.9
    assert _inside(covariance, covariance + second_order_covariance(covariance)) > 0.92


def test_a_sure_turn_adds_nothing_that_matters() -> None:
    sure = np.diag([1e-4, 1e-4, 1e-2, *[np.radians(0.02) ** 2] * 3])
    assert float(second_order_covariance(sure).max()) < 1e-8
