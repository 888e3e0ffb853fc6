"""Check with the tip on an unused landmark: the distance decides."""

import numpy as np
import pytest

from tests.tracker.registration.constellations import VERTEBRA, any_pose
from tracker.errors import RegistrationError
from tracker.registration import AnchoredTo, Method, Registration
from tracker.registration.check import LandmarkCheck, check_landmark

REGISTRATION = Registration(
    method=Method.POINTS,
    anchored_to=AnchoredTo.CAMERA,
    anchor_from_vertebra=any_pose(np.random.default_rng(1)).inverse,
    covariance=np.diag([0.04, 0.04, 0.04, 0.0, 0.0, 0.0]),
)
USED = {"left facet": VERTEBRA[0], "right facet": VERTEBRA[1], "spine": VERTEBRA[4]}


def checked(off_mm: list[float], name: str = "transverse", at: np.ndarray = VERTEBRA[2]) -> LandmarkCheck:
    tip = REGISTRATION.anchor_from_vertebra.move_points(at + off_mm)
    return check_landmark(REGISTRATION, name, at, tip, used_mm=USED, tip_covariance_mm2=0.05 * np.eye(3))


def test_the_distance_is_reported_on_the_patients_axes() -> None:
    check = checked([0.6, -0.8, 0.0])
    assert check.distance_mm == pytest.approx(1.0)
    assert check.off_mm == pytest.approx([0.6, -0.8, 0.0])
    assert check.sd_mm == pytest.approx(np.sqrt(3 * 0.09))
    assert check.passed
    assert check.failures() == ()


@pytest.mark.parametrize(("off", "passed"), [(1.99, True), (2.01, False)])
def test_the_gate_is_where_it_is_said(off: float, passed: bool) -> None:
    check = checked([0.0, 0.0, off])
    assert check.passed is passed
    assert [error.code for error in check.failures()] == ([] if passed else ["LANDMARK_CHECK_FAILED"])


def test_a_landmark_that_was_used_checks_nothing() -> None:
    for name, at in (("spine", VERTEBRA[4]), ("spine", VERTEBRA[2]), ("renamed", VERTEBRA[4] + 1.0)):
        with pytest.raises(RegistrationError) as caught:
            checked([0.0, 0.0, 0.0], name, at)
        assert caught.value.code == "LANDMARK_WAS_USED"


def test_a_tip_that_is_no_place_is_rejected() -> None:
    with pytest.raises(RegistrationError, match="finite"):
        checked([np.nan, 0.0, 0.0])
