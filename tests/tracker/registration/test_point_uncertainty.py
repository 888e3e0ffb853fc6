"""The stated uncertainty of point-based registration, against simulated landmarks."""

import numpy as np
import pytest
import scipy.stats

from tests.tracker.registration.constellations import VERTEBRA, random_landmarks, touched
from tests.tracker.registration.drawn_landmarks import BARE, KINDS, simulated
from tracker.geometry import (
    Anchor,
    Rigid,
    Vertebra,
    inverse_covariance,
    point_covariance_mm2,
    vector_from_rotation,
)
from tracker.registration.points import (
    CommonTip,
    PointPairs,
    PointSettings,
    expected_covariance,
    register_points,
)
from tracker.registration.points.uncertainty import expected_tre_mm, variance_ratio_with_more

# `python -m tests.benchmarks.drawn_coverage` has more, and shares with confidence bounds.
RUNS, TRE_RUNS = 30, 250


@pytest.mark.parametrize("name", KINDS)
def test_the_stated_uncertainty_contains_the_truth_about_as_often_as_stated(name: str) -> None:
    seen = simulated(*KINDS[name], runs=RUNS)
    for inside in (seen.target, seen.along, seen.pose):
        # Of a true 95 %, fewer than this are inside in one of a thousand samples.
        assert sum(inside) >= scipy.stats.binom.ppf(0.001, RUNS, 0.95)
    if KINDS[name][2] is not None:
        # Nor is it far too wide: the median of chi-square is 2.37. A noise that few residuals must tell has a
        # wide distribution, and a small median.
        assert np.median(seen.squared) > 1.2


def test_fitzpatricks_formula_is_what_targets_are_off() -> None:
    count = 4
    rng = np.random.default_rng(20 + count)
    fixed = random_landmarks(rng, count)
    target = fixed.mean(axis=0) + np.array([25.0, -30.0, 10.0])
    off, expected = [], []
    for _ in range(TRE_RUNS):
        truth = touched(fixed, rng, 0.4)
        found = register_points(PointPairs(fixed_mm=fixed, moving_mm=truth.moving_mm), settings=BARE)
        tip = truth.fixed_from_moving.inverse.move_points(target)
        off.append(float(((found.fixed_from_moving.move_points(tip) - target) ** 2).sum()))
        expected.append(found.tre_expected_mm(target) ** 2)
    by_truth = expected_tre_mm(fixed, 0.4 * np.sqrt(3.0), target)
    assert np.sqrt(np.mean(off)) == pytest.approx(by_truth, rel=0.08)
    assert np.sqrt(np.mean(expected)) == pytest.approx(by_truth, rel=0.08)


def test_the_formula_on_a_constellation_by_hand() -> None:
    # Six points at +-10 on each axis: f_k^2 = 4 * 100 / 6 on each; a target 20 off along x: d = (0, 20, 20).
    points = np.vstack([10.0 * np.eye(3), -10.0 * np.eye(3)])
    by_hand = np.sqrt(1.0 / 6.0 * (1.0 + 2.0 * 400.0 / (400.0 / 6.0) / 3.0))
    assert expected_tre_mm(points, 1.0, np.array([20.0, 0.0, 0.0])) == pytest.approx(by_hand)
    assert expected_tre_mm(points, 1.0, np.zeros(3)) == pytest.approx(np.sqrt(1.0 / 6.0))


def test_a_lucky_fit_is_not_surer_than_a_landmark_can_be_found() -> None:
    truth = touched(VERTEBRA, np.random.default_rng(1))
    found = register_points(
        PointPairs(fixed_mm=VERTEBRA, moving_mm=truth.moving_mm), settings=PointSettings(min_fle_mm=0.6)
    )
    middle = VERTEBRA.mean(axis=0)
    assert found.tre_expected_mm(middle) < 1e-9
    assert found.tre_stated_mm(middle) == pytest.approx(0.6 / np.sqrt(6.0), rel=1e-6)


def test_what_tips_state_is_nearly_a_floor_and_residuals_widen_it() -> None:
    rng = np.random.default_rng(2)
    stated = np.broadcast_to(0.01 * np.eye(3), (6, 3, 3))
    exact, rough = touched(VERTEBRA, rng), touched(VERTEBRA, rng, 0.8)
    at = VERTEBRA.mean(axis=0)
    found = [
        register_points(
            PointPairs(fixed_mm=VERTEBRA, moving_mm=one.moving_mm, moving_covariances_mm2=stated),
            settings=PointSettings(min_fle_mm=1e-6),
        ).tre_stated_mm(at)
        for one in (exact, rough)
    ]
    assert found[0] == pytest.approx(np.sqrt(0.8 * 3 * 0.01 / 6.0), rel=1e-3)
    assert found[1] > 4.0 * found[0]


def test_the_covariance_of_the_inverse_is_that_of_inverted_samples() -> None:
    rng = np.random.default_rng(3)
    root = rng.normal(size=(6, 6)) * np.array([[0.1, 0.1, 0.1, 1e-3, 1e-3, 1e-3]]).T
    covariance = root @ root.T
    there: Rigid[Anchor, Vertebra] = Rigid.from_vector([0.4, -0.7, 1.1], [30.0, -20.0, 50.0])
    samples = []
    for shift_and_turn in rng.multivariate_normal(np.zeros(6), covariance, 4000):
        moved = there.displaced(shift_and_turn)
        back, was = moved.inverse, there.inverse
        turn = vector_from_rotation(back.rotation @ was.rotation.T)
        samples.append(np.concatenate([back.translation_mm - was.translation_mm, turn]))
    stated = inverse_covariance(there, covariance)
    scale = np.sqrt(np.diag(stated))
    assert np.allclose(
        np.cov(np.array(samples).T) / np.outer(scale, scale), stated / np.outer(scale, scale), atol=0.08
    )
    assert np.allclose(inverse_covariance(there.inverse, stated), covariance)
    # A point at the far end has the same uncertainty from either side.
    at = np.array([5.0, 6.0, 7.0])
    one = point_covariance_mm2(there, covariance, at)
    other = point_covariance_mm2(there.inverse, stated, there.move_points(at))
    assert np.trace(one) == pytest.approx(np.trace(other))


def test_the_error_with_more_landmarks_is_the_one_that_they_give() -> None:
    rng = np.random.default_rng(11)
    expected, found = [], []
    twice = np.vstack([VERTEBRA, VERTEBRA * [1.0, -1.0, 1.0] + [0.0, 6.0, 0.0]])
    twice[6:] += VERTEBRA.mean(axis=0) - twice[6:].mean(axis=0)
    target = np.array([15.0, -20.0, 5.0])
    for _ in range(40):
        truth = touched(twice, rng, 0.4)
        few, many = (
            register_points(
                PointPairs(fixed_mm=truth.fixed_mm[:count], moving_mm=truth.moving_mm[:count]), settings=BARE
            )
            for count in (6, 12)
        )
        ratio = variance_ratio_with_more(few.fre_rms_mm, 6, 6, min_fle_mm=1e-3)
        expected.append(ratio * np.trace(few.target_covariance_mm2(target)))
        found.append(np.trace(many.target_covariance_mm2(target)))
    assert np.sqrt(np.mean(expected) / np.mean(found)) == pytest.approx(1.0, abs=0.15)


def test_more_landmarks_do_not_make_one_better_than_the_minimum_fle() -> None:
    assert variance_ratio_with_more(0.01, 6, 6, min_fle_mm=0.5) == pytest.approx(0.5)


def test_stated_and_common_errors_have_their_own_shares_with_more_landmarks() -> None:
    rng = np.random.default_rng(12)
    twice = np.vstack([VERTEBRA, VERTEBRA * [1.0, -1.0, 1.0] + [0.0, 6.0, 0.0]])
    twice[6:] += VERTEBRA.mean(axis=0) - twice[6:].mean(axis=0)
    target = np.array([15.0, -20.0, 5.0])
    # All captured with one orientation of the marker: a common shift of 0.3 mm that no landmark reduces.
    tip = CommonTip(
        tool="drill", covariance_mm2=0.3**2 * np.eye(3), anchor_from_marker=np.tile(np.eye(3), (12, 1, 1))
    )
    expected, found = [], []
    for _ in range(20):
        truth = touched(twice, rng, 0.4)
        whole = PointPairs(
            fixed_mm=truth.fixed_mm,
            moving_mm=truth.moving_mm,
            moving_covariances_mm2=np.tile(0.4**2 * np.eye(3), (12, 1, 1)),
            common=tip,
        )
        few = register_points(whole.of(range(6)), settings=BARE)
        many = register_points(whole, settings=BARE)
        at = few.fixed_from_moving.inverse.move_points(target)
        expected.append(
            np.trace(point_covariance_mm2(few.fixed_from_moving, few.covariance_with_more(6), at))
        )
        found.append(np.trace(many.target_covariance_mm2(target)))
    assert np.sqrt(np.mean(expected) / np.mean(found)) == pytest.approx(1.0, abs=0.1)
    of_very_many = point_covariance_mm2(few.fixed_from_moving, few.covariance_with_more(10**6), at)
    assert of_very_many == pytest.approx(0.3**2 * np.eye(3), abs=1e-3)


def test_planned_landmarks_are_expected_to_give_what_their_fit_states() -> None:
    rng = np.random.default_rng(13)
    target = np.array([15.0, -20.0, 5.0])
    identity: Rigid[Vertebra, Anchor] = Rigid(rotation=np.eye(3), translation_mm=np.zeros(3))
    stated = []
    for _ in range(40):
        truth = touched(VERTEBRA, rng, 0.7)
        pairs = PointPairs(fixed_mm=truth.fixed_mm, moving_mm=truth.moving_mm)
        stated.append(np.trace(register_points(pairs, settings=BARE).target_covariance_mm2(target)))
    planned = np.trace(point_covariance_mm2(identity, expected_covariance(VERTEBRA, 0.7), target))
    assert np.sqrt(planned / np.mean(stated)) == pytest.approx(1.0, abs=0.1)
    # More landmarks of the same spread are equivalent to repetitions.
    twice = expected_covariance(np.vstack([VERTEBRA, VERTEBRA]), 0.7)
    assert expected_covariance(VERTEBRA, 0.7, more=len(VERTEBRA)) == pytest.approx(twice)
