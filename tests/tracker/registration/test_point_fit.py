"""Point-based registration: transform, residuals, and invariants."""

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.tracker.registration.constellations import VERTEBRA, random_landmarks, touched
from tracker.geometry import angle_between_deg
from tracker.registration import AnchoredTo, Method
from tracker.registration.points import PointGate, PointPairs, PointSettings, register_points


def pairs(fixed: np.ndarray, moving: np.ndarray, covariances: np.ndarray | None = None) -> PointPairs:
    return PointPairs(fixed_mm=fixed, moving_mm=moving, moving_covariances_mm2=covariances)


@settings(max_examples=25, deadline=None)
@given(seed=st.integers(0, 10_000), count=st.integers(3, 8))
def test_exact_points_give_the_exact_motion(seed: int, count: int) -> None:
    rng = np.random.default_rng(seed)
    truth = touched(random_landmarks(rng, count), rng)
    found = register_points(pairs(truth.fixed_mm, truth.moving_mm))
    assert np.allclose(found.fixed_from_moving.matrix, truth.fixed_from_moving.matrix, atol=1e-9)
    assert found.fre_rms_mm < 1e-9


def test_a_motion_by_hand_is_found() -> None:
    fixed = np.array([[0.0, 0.0, 0.0], [10.0, 0.0, 0.0], [0.0, 20.0, 0.0]])
    # A quarter turn about z, then 5 mm along x.
    moving = np.array([[0.0, 5.0, 0.0], [0.0, -5.0, 0.0], [20.0, 5.0, 0.0]])
    found = register_points(pairs(fixed, moving)).fixed_from_moving
    assert np.allclose(found.rotation, [[0, -1, 0], [1, 0, 0], [0, 0, 1]], atol=1e-12)
    assert np.allclose(found.translation_mm, [5, 0, 0], atol=1e-12)


def test_fixed_and_moving_exchanged_give_the_inverse() -> None:
    rng = np.random.default_rng(1)
    truth = touched(VERTEBRA, rng, 0.5)
    there = register_points(pairs(truth.fixed_mm, truth.moving_mm))
    back = register_points(pairs(truth.moving_mm, truth.fixed_mm))
    assert np.allclose(back.fixed_from_moving.matrix, there.fixed_from_moving.inverse.matrix, atol=1e-9)
    assert back.fre_rms_mm == pytest.approx(there.fre_rms_mm)


def test_the_order_of_the_pairs_does_not_matter() -> None:
    rng = np.random.default_rng(2)
    truth = touched(VERTEBRA, rng, 0.5)
    noise = np.array([np.diag(rng.uniform(0.05, 0.5, 3)) for _ in VERTEBRA])
    order = rng.permutation(len(VERTEBRA))
    one = register_points(pairs(truth.fixed_mm, truth.moving_mm, noise))
    other = register_points(pairs(truth.fixed_mm[order], truth.moving_mm[order], noise[order]))
    assert np.allclose(one.fixed_from_moving.matrix, other.fixed_from_moving.matrix, atol=1e-9)
    assert np.allclose(one.covariance, other.covariance, rtol=1e-6, atol=1e-12)
    assert np.allclose(one.distances_mm[order], other.distances_mm, atol=1e-9)


def test_residuals_and_fre_are_what_the_motion_leaves() -> None:
    truth = touched(VERTEBRA, np.random.default_rng(3), 0.7)
    found = register_points(pairs(truth.fixed_mm, truth.moving_mm))
    moved = truth.moving_mm @ found.fixed_from_moving.rotation.T + found.fixed_from_moving.translation_mm
    assert np.allclose(found.residuals_mm, moved - truth.fixed_mm)
    assert found.fre_rms_mm == pytest.approx(np.sqrt((found.distances_mm**2).mean()))
    assert found.fle_mm == pytest.approx(found.fre_rms_mm * np.sqrt(6.0 / 4.0))


def test_a_sure_tip_counts_for_more_than_an_unsure_one() -> None:
    truth = touched(VERTEBRA, np.random.default_rng(4))
    moving = truth.moving_mm.copy()
    moving[2] += [0.0, 0.0, 3.0]
    noise = np.broadcast_to(0.01 * np.eye(3), (6, 3, 3)).copy()
    noise[2] = np.diag([0.01, 0.01, 25.0])
    limits = PointSettings(min_fle_mm=0.05)
    weighed = register_points(pairs(truth.fixed_mm, moving, noise), settings=limits)
    plain = register_points(pairs(truth.fixed_mm, moving), settings=limits)
    at = VERTEBRA[4]
    tip = truth.fixed_from_moving.inverse.move_points(at)
    off = [np.linalg.norm(one.fixed_from_moving.move_points(tip) - at) for one in (weighed, plain)]
    assert off[0] < 0.02
    assert off[1] > 0.2


def test_a_point_that_is_left_out_shows_its_whole_error() -> None:
    truth = touched(VERTEBRA, np.random.default_rng(5))
    moving = truth.moving_mm.copy()
    moving[1] += [0.0, 2.0, 0.0]
    found = register_points(pairs(truth.fixed_mm, moving))
    assert found.leave_one_out_mm[1] == pytest.approx(2.0, abs=1e-9)
    assert max(found.leave_one_out_mm, key=lambda index: found.leave_one_out_mm[index]) == 1
    assert found.distances_mm[1] < 1.9


def test_an_excluded_point_has_no_say_and_still_shows_its_distance() -> None:
    truth = touched(VERTEBRA, np.random.default_rng(6))
    moving = truth.moving_mm.copy()
    moving[3] += [4.0, 0.0, 0.0]
    found = register_points(pairs(truth.fixed_mm, moving), excluded=[3])
    assert found.fre_rms_mm < 1e-9
    assert found.distances_mm[3] == pytest.approx(4.0)
    assert found.used.tolist() == [True, True, True, False, True, True]
    assert 3 not in found.leave_one_out_mm


def test_three_points_leave_none_out() -> None:
    truth = touched(VERTEBRA[[0, 3, 4]], np.random.default_rng(7), 0.3)
    assert dict(register_points(pairs(truth.fixed_mm, truth.moving_mm)).leave_one_out_mm) == {}


def test_the_gate_names_the_worst_point_and_the_target() -> None:
    truth = touched(VERTEBRA, np.random.default_rng(8))
    moving = truth.moving_mm.copy()
    moving[4] += [0.0, 6.0, 0.0]
    found = register_points(pairs(truth.fixed_mm, moving))
    gate = PointGate(max_fre_mm=1.0, max_tre_mm=1.0)
    codes = [error.code for error in found.failures(gate, [VERTEBRA[0] - [0, 60, 0]])]
    assert codes == ["POINTS_FIT_TOO_LARGE", "POINT_STRAYS", "POINTS_TARGET_UNCERTAIN"]
    assert "point 5" in found.failures(gate, [])[0].message
    assert found.failures(gate, [])[1].context["landmark"] == "5"
    lenient = register_points(pairs(truth.fixed_mm, moving), settings=PointSettings(max_left_out_mm=9.0))
    assert lenient.failures(PointGate(max_fre_mm=9.0, max_tre_mm=9.0), [VERTEBRA[0]]) == ()


def test_navigation_gets_the_inverse_with_its_own_covariance() -> None:
    truth = touched(VERTEBRA, np.random.default_rng(9), 0.5)
    found = register_points(pairs(truth.fixed_mm, truth.moving_mm))
    used = found.registration(AnchoredTo.REFERENCE)
    assert (used.method, used.anchored_to) == (Method.POINTS, AnchoredTo.REFERENCE)
    assert np.allclose((used.anchor_from_vertebra @ found.fixed_from_moving).matrix, np.eye(4), atol=1e-9)
    assert not used.covariance.flags.writeable


def test_a_marker_printed_at_another_size_is_reported() -> None:
    truth = touched(VERTEBRA, np.random.default_rng(10), 0.1)
    small = truth.moving_mm * 0.96
    remarks = register_points(pairs(truth.fixed_mm, small)).remarks
    assert [one.code for one in remarks if "SCALE" in one.code] == ["POINTS_SCALE_DIFFERS"]
    assert "% smaller" in next(one.message for one in remarks if "SCALE" in one.code)
    true = register_points(pairs(truth.fixed_mm, truth.moving_mm)).remarks
    assert [one for one in true if "SCALE" in one.code] == []


def test_far_from_both_origins_nothing_is_lost() -> None:
    truth = touched(VERTEBRA + np.array([0.0, -120.0, -1400.0]), np.random.default_rng(11))
    found = register_points(pairs(truth.fixed_mm, truth.moving_mm + 5000.0))
    rotation = truth.fixed_from_moving.rotation
    assert angle_between_deg(rotation[0], found.fixed_from_moving.rotation[0]) < 1e-9
    assert found.fre_rms_mm < 1e-9
