"""Planar pose ambiguity over time: images are combined, and a wrong choice is corrected."""

import numpy as np
import pytest

from tests.tracker.pipeline.stepped import CAMERA, MODEL, pose_of
from tests.tracker.scenes import Image8, Print, code_image, rendered
from tracker.edges import gradient_of
from tracker.geometry import Camera, Marker, Rigid, rotation_from_vector, vector_from_rotation
from tracker.geometry.geometry_kernels import RIDGE, pose_rows, rotation_angle_between
from tracker.pose import Prior, Seen, flipped_pose, occurrence_near
from tracker.pose.pose_ambiguity import (
    PosePrediction,
    delta_chi2_to_next,
    flip_covariance,
    mahalanobis_squared,
)
from tracker.pose.prior import MAX_DELTA_CHI2
from tracker.pose.second_order import marker_point_covariance_mm2

TRUTH = pose_of(side_px=26.0, tilt_deg=11.0)


def _turned_deg(a: Rigid[Camera, Marker], b: Rigid[Camera, Marker]) -> float:
    return float(np.degrees(np.linalg.norm(vector_from_rotation(a.rotation @ b.rotation.T))))


def _expected(delta_chi2: float) -> PosePrediction:
    return PosePrediction(
        rotation=TRUTH.rotation,
        translation_mm=TRUTH.translation_mm,
        flipped=flipped_pose(TRUTH),
        delta_chi2=delta_chi2,
    )


def _noisy(seed: int) -> Image8:
    print_ = Print(picture=code_image(), pose=TRUTH)
    return rendered(CAMERA, [print_], noise_grey=8.0, seed=seed)


def _fitted(image: Image8, expected: PosePrediction | None) -> Seen:
    """By edges alone, which are the weaker evidence."""
    gradient = gradient_of(image)
    start = TRUTH if expected is None else expected
    found = occurrence_near(CAMERA, MODEL, gradient, start, first_reach_px=6.0, expected=expected)
    assert found is not None
    return Seen(
        camera_from_marker=found.fit.camera_from_marker,
        pose_covariance=found.fit.covariance,
        corners_px=found.corners_px,
        score_ratio=1.0,
        target_score_ratio=1.0,
        model_coverage_ratio=1.0,
        target_coverage_ratio=1.0,
        fit_error_px2=found.agreement.fit_error_px2,
        found_by="track",
        delta_chi2=found.fit.delta_chi2,
        # As if noise explained all residuals.
        systematic_residual_ratio=0.0,
    )


def test_the_other_solution_surprises_by_no_more_than_the_images_before_said_against_it() -> None:
    assert mahalanobis_squared(TRUTH, _expected(7.0)) == pytest.approx(0.0)
    assert mahalanobis_squared(flipped_pose(TRUTH), _expected(7.0)) == pytest.approx(7.0)
    assert mahalanobis_squared(flipped_pose(TRUTH), TRUTH) > 20.0
    assert mahalanobis_squared(TRUTH, None) == 0.0


def test_a_prior_that_took_the_wrong_solution_gives_it_up_within_a_few_images() -> None:
    wrong = flipped_pose(TRUTH)
    assert _turned_deg(wrong, TRUTH) > 20.0
    prior = Prior()
    first = _fitted(_noisy(0), None)
    prior.update(first, 0.0)
    prior.pose, prior.delta_chi2 = wrong, MAX_DELTA_CHI2
    off_deg, turning_deg_s = [], []
    for k in range(1, 12):
        seen = _fitted(_noisy(k), prior.predict(k / 30))
        prior.update(seen, k / 30)
        off_deg.append(_turned_deg(seen.camera_from_marker, TRUTH))
        assert prior.rates is not None
        turning_deg_s.append(float(np.degrees(np.linalg.norm(prior.rates[3:]))))
    assert off_deg[0] > 20.0, "one image alone does not speak loud enough"
    assert max(off_deg[4:]) < 5.0
    # A switch of solution is no rotation of the hand.
    assert max(turning_deg_s) < 300.0


def test_what_the_images_say_adds_up_and_is_bounded() -> None:
    prior = Prior()
    leads = []
    for k in range(10):
        seen = _fitted(_noisy(k), prior.predict(k / 30) if k else None)
        prior.update(seen, k / 30)
        leads.append(prior.delta_chi2)
    assert leads[0] < 0.6 * MAX_DELTA_CHI2
    assert leads[0] < leads[1]
    assert max(leads) == MAX_DELTA_CHI2


def test_the_lead_is_that_over_another_solution_not_over_the_same_one() -> None:
    near: Rigid[Camera, Marker] = Rigid.from_matrix(TRUTH.matrix)
    assert delta_chi2_to_next([1.0, 1.5, 9.0], [TRUTH, near, flipped_pose(TRUTH)], 0) == pytest.approx(8.0)
    assert delta_chi2_to_next([1.0], [TRUTH], 0) == float("inf")
    assert delta_chi2_to_next([1.0, 1.5], [TRUTH, near], 0) == float("inf")


def test_an_even_race_leaves_even_doubt_and_a_covariance_that_reaches_the_other() -> None:
    spread = flip_covariance(TRUTH, flipped_pose(TRUTH), delta_chi2=0.0, expected=None)
    reach_deg = np.degrees(np.sqrt(np.trace(spread[3:, 3:])))
    turn = np.radians(_turned_deg(TRUTH, flipped_pose(TRUTH)))
    # Along the tangent by the whole rotation, and across it by the arc's deviation.
    assert reach_deg == pytest.approx(np.degrees(np.sqrt(0.5 * (turn**2 + 3.0 * (1.0 - np.cos(turn)) ** 2))))
    assert not flip_covariance(TRUTH, flipped_pose(TRUTH), delta_chi2=19.0, expected=None).any()


@pytest.mark.parametrize("tip_mm", [(0.0, 120.0, 0.0), (120.0, 0.0, 0.0), (60.0, -100.0, 0.0)])
def test_what_is_stated_reaches_the_tip_of_the_other_solution(tip_mm: tuple[float, float, float]) -> None:
    """A tip moves along an arc from one solution to the other; its covariance is linear."""
    other = flipped_pose(TRUTH)
    spread = flip_covariance(TRUTH, other, delta_chi2=0.0, expected=None) + np.eye(6) * 1e-6
    stated = marker_point_covariance_mm2(TRUTH, spread, tip_mm)
    apart = other.move_points(np.array([tip_mm]))[0] - TRUTH.move_points(np.array([tip_mm]))[0]
    # Its 95 % ellipsoid.
    assert float(apart @ np.linalg.solve(stated, apart)) < 7.815


@pytest.mark.parametrize("angle_deg", [0.0, 1e-4, 30.0, 179.0, 180.0])
def test_the_turn_between_rotations_is_exact_from_nothing_to_half_a_turn(angle_deg: float) -> None:
    axis = np.array([0.36, -0.48, 0.8])
    turned = rotation_from_vector(axis * np.radians(angle_deg)) @ TRUTH.rotation
    assert np.degrees(rotation_angle_between(turned, TRUTH.rotation)) == pytest.approx(angle_deg, abs=1e-5)


def test_the_pose_s_rows_of_an_inverse_are_those_of_the_whole_inverse() -> None:
    rows = np.random.default_rng(3).normal(size=(20, 7)) * [1.0, 1.0, 0.1, 90.0, 80.0, 70.0, 1.0]
    matrix = rows.T @ rows
    rows_of_pose, is_solved = pose_rows(matrix, np.arange(7), (0, 0), RIDGE)
    assert is_solved
    np.testing.assert_allclose(rows_of_pose, np.linalg.inv(matrix)[:6], rtol=1e-6, atol=1e-12)
    assert not pose_rows(np.zeros((7, 7)), np.arange(7), (0, 0), RIDGE)[1]
