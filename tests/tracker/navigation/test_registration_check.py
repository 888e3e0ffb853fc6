"""Whether a registration suffices for one screw."""

import numpy as np
import pytest

from tracker.geometry import Anchor, Rigid, Vertebra, rotation_from_vector
from tracker.navigation import check_registration
from tracker.navigation.uncertainty import PedicleTolerance, UncertainPose
from tracker.plan import Channel

CHANNEL = Channel(
    name="L3 left",
    entry_in_vertebra_mm=np.array([20.0, 0.0, 0.0]),
    target_in_vertebra_mm=np.array([20.0, -40.0, 0.0]),
    radius_mm=3.0,
)
POSE: Rigid[Vertebra, Anchor] = Rigid(
    rotation=rotation_from_vector(np.array([0.4, -0.2, 0.9])), translation_mm=np.array([5.0, -60.0, 300.0])
)


def registered(sd_mm: float) -> UncertainPose[Vertebra, Anchor]:
    return UncertainPose(pose=POSE, covariance=np.diag([sd_mm**2] * 3 + [0.0] * 3))


def tolerance(mm: float) -> PedicleTolerance:
    return PedicleTolerance(tolerance_mm=mm, lever_mm=18.0)


def test_a_shift_moves_entry_and_isthmus_alike() -> None:
    # 95 % of a round normal distribution lie within 2.44775 standard deviations.
    check = check_registration(registered(0.2), CHANNEL, tolerance(0.5))
    assert (check.entry_95_mm, check.isthmus_95_mm) == (0.49, 0.49)
    assert check.suffices
    assert check.diameter_excess_mm == 0.0


def test_a_rotation_moves_the_isthmus_more_than_the_entry_by_its_lever() -> None:
    # The anchor's origin is that of the plan: rotations are about it.
    pose: Rigid[Vertebra, Anchor] = Rigid(rotation=POSE.rotation, translation_mm=np.zeros(3))
    registration = UncertainPose(pose=pose, covariance=np.diag([0.0, 0.0, 0.0, 1e-4, 1e-4, 1e-4]))
    check = check_registration(registration, CHANNEL, tolerance(5.0))
    # At (20, 0, 0) mm only the rotation about y, 0.01 rad, moves the drill across: 0.2 mm along z.
    assert check.entry_95_mm == pytest.approx(1.96 * 0.2, abs=0.01)
    # At (20, -18, 0) mm: 0.01 * 26.9 mm along z and 0.01 * 18 mm along x; 2.13 by the ratio of both.
    assert check.isthmus_95_mm == pytest.approx(2.13 * 0.269, abs=0.02)


def test_a_screw_that_fills_the_pedicle_is_too_thick_by_twice_what_is_missing() -> None:
    check = check_registration(registered(0.4), CHANNEL, tolerance(0.5))
    assert check.error_95_mm == 0.98
    assert not check.suffices
    assert check.diameter_excess_mm == 1.0
    thinner = check_registration(registered(0.4), CHANNEL, tolerance(0.5 + 0.5 * check.diameter_excess_mm))
    assert thinner.suffices


def test_a_screw_that_leaves_nothing_gets_no_figure() -> None:
    assert check_registration(registered(0.4), CHANNEL, tolerance(0.0)).diameter_excess_mm is None
