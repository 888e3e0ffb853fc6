"""Manual adjustments: effect, bounds and undo."""

import numpy as np
import pytest

from tests.tracker.registration.constellations import any_pose
from tracker.errors import RegistrationError
from tracker.geometry import Array, angle_between_deg
from tracker.registration import AnchoredTo, Method, Registration
from tracker.registration.nudge import Nudge, NudgeAxis, NudgedRegistration, NudgeKind, NudgeLimits

PIVOT = np.array([15.0, -90.0, -800.0])


def made() -> Registration:
    return Registration(
        method=Method.POINTS,
        anchored_to=AnchoredTo.REFERENCE,
        anchor_from_vertebra=any_pose(np.random.default_rng(1)).inverse,
        covariance=np.diag([0.1, 0.1, 0.1, 1e-6, 1e-6, 1e-6]),
    )


def shift(axis: NudgeAxis, amount: float) -> Nudge:
    return Nudge(kind=NudgeKind.SHIFT, axis=axis, amount=amount)


def turn(axis: NudgeAxis, amount: float) -> Nudge:
    return Nudge(kind=NudgeKind.TURN, axis=axis, amount=amount)


def moved_mm(nudged: NudgedRegistration, at: Array) -> Array:
    """Motion of a plan point along the patient's axes."""
    before, after = nudged.made.anchor_from_vertebra, nudged.registration.anchor_from_vertebra
    return before.inverse.rotate_directions(after.move_points(at) - before.move_points(at))


@pytest.mark.parametrize(
    ("axis", "way"),
    [(NudgeAxis.LEFT, [1, 0, 0]), (NudgeAxis.BACK, [0, 1, 0]), (NudgeAxis.HEAD, [0, 0, 1])],
)
def test_a_shift_moves_every_point_along_the_patients_axis(axis: NudgeAxis, way: list[int]) -> None:
    nudged = NudgedRegistration(made=made(), pivot_mm=PIVOT).nudged(shift(axis, -0.5))
    assert np.allclose(moved_mm(nudged, PIVOT), -0.5 * np.array(way))
    assert np.allclose(moved_mm(nudged, PIVOT + 40.0), -0.5 * np.array(way))


def test_a_turn_leaves_the_pivot_and_turns_the_rest() -> None:
    nudged = NudgedRegistration(made=made(), pivot_mm=PIVOT).nudged(turn(NudgeAxis.HEAD, 1.0))
    assert np.allclose(moved_mm(nudged, PIVOT), 0.0, atol=1e-9)
    # Right-handed about the direction to the head: points left of the pivot move backwards.
    expected = 30.0 * np.array([np.cos(np.radians(1.0)) - 1.0, np.sin(np.radians(1.0)), 0.0])
    assert np.allclose(moved_mm(nudged, PIVOT + np.array([30.0, 0.0, 0.0])), expected)


def test_undone_nudges_leave_nothing_behind() -> None:
    start = NudgedRegistration(made=made(), pivot_mm=PIVOT)
    there = start.nudged(shift(NudgeAxis.LEFT, 1.0)).nudged(turn(NudgeAxis.BACK, 0.5))
    back = there.undone().undone()
    assert back.registration is back.made
    assert there.nudges[0] == shift(NudgeAxis.LEFT, 1.0)
    with pytest.raises(RegistrationError) as caught:
        back.undone()
    assert caught.value.code == "NUDGE_NONE"


def test_nudges_there_and_back_cancel() -> None:
    nudged = NudgedRegistration(made=made(), pivot_mm=PIVOT)
    for amount in (0.5, -0.5):
        nudged = nudged.nudged(turn(NudgeAxis.LEFT, amount)).nudged(shift(NudgeAxis.HEAD, amount))
    assert nudged.shift_mm < 0.01
    assert nudged.rotation_deg < 0.01


def test_all_together_are_bounded_and_leading_back_is_not() -> None:
    nudged = NudgedRegistration(made=made(), pivot_mm=PIVOT, limits=NudgeLimits(max_mm=3.0, max_deg=2.0))
    for _ in range(3):
        nudged = nudged.nudged(shift(NudgeAxis.LEFT, 1.0))
    with pytest.raises(RegistrationError) as caught:
        nudged.nudged(shift(NudgeAxis.LEFT, 0.1))
    assert caught.value.code == "NUDGE_TOO_FAR"
    assert "3.1 mm" in caught.value.message
    assert nudged.nudged(shift(NudgeAxis.LEFT, -0.1)).shift_mm == pytest.approx(2.9)
    for _ in range(2):
        nudged = nudged.nudged(turn(NudgeAxis.HEAD, -1.0))
    with pytest.raises(RegistrationError, match="allowed 3 mm and 2 deg"):
        nudged.nudged(turn(NudgeAxis.HEAD, -0.5))


@pytest.mark.parametrize("amount", [0.0, 0.2, -2.0, float("nan"), float("inf")])
def test_other_steps_are_rejected(amount: float) -> None:
    with pytest.raises(RegistrationError, match="is not allowed"):
        shift(NudgeAxis.LEFT, amount)


def test_what_is_nudged_is_stated_as_less_sure_along_the_nudge() -> None:
    start = NudgedRegistration(made=made(), pivot_mm=PIVOT)
    nudged = start
    for _ in range(3):
        nudged = nudged.nudged(shift(NudgeAxis.BACK, 1.0))
    before, after = start.registration, nudged.registration
    grown = after.point_covariance_mm2(PIVOT) - before.point_covariance_mm2(PIVOT)
    values, ways = np.linalg.eigh(grown)
    assert values == pytest.approx([0.0, 0.0, 3.0], abs=1e-6)
    along = after.anchor_from_vertebra.rotate_directions([0.0, 1.0, 0.0])
    assert abs(ways[:, -1] @ along) == pytest.approx(1.0)


def test_a_turn_widens_the_far_end_and_not_the_pivot() -> None:
    start = NudgedRegistration(made=made(), pivot_mm=PIVOT)
    nudged = start
    for _ in range(4):
        nudged = nudged.nudged(turn(NudgeAxis.HEAD, 1.0))
    before, after = start.registration, nudged.registration
    near = after.point_covariance_mm2(PIVOT) - before.point_covariance_mm2(PIVOT)
    far = after.point_covariance_mm2(PIVOT - [0.0, 40.0, 0.0])
    # 40 mm by 4 degrees is 2.8 mm, whose third of a square is 2.6.
    assert np.allclose(near, 0.0, atol=1e-9)
    assert np.trace(far) - np.trace(before.point_covariance_mm2(PIVOT)) == pytest.approx(2.6, abs=0.2)
    axis = before.anchor_from_vertebra.rotate_directions([0.0, 1.0, 0.0])
    turned = after.anchor_from_vertebra.rotate_directions([0.0, 1.0, 0.0])
    assert angle_between_deg(axis, turned) == pytest.approx(4.0)


def test_a_pivot_that_is_none_is_rejected() -> None:
    with pytest.raises(RegistrationError, match="finite"):
        NudgedRegistration(made=made(), pivot_mm=np.array([0.0, np.nan, 0.0]))
