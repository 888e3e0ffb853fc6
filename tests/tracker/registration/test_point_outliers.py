"""One mistaken landmark: found, named, or covered by the stated error."""

import numpy as np
import pytest

from tests.tracker.registration.constellations import VERTEBRA, touched
from tests.tracker.registration.outlier_study import GATE, OUTLIER_MM, TARGETS, study
from tracker.geometry import vector_from_rotation
from tracker.registration.points import PointPairs, PointRegistration, PointSettings, register_points
from tracker.registration.points.fit import fit_rigid, jacobians
from tracker.registration.points.outliers import covariance_spanning, covariance_with_outlier
from tracker.registration.points.uncertainty import normal_matrix

# Left and right facet, left transverse process, spinous process: what a surgeon takes first.
FOUR = VERTEBRA[[0, 1, 2, 4]]


def registered(
    fixed: np.ndarray, *, wrong: int, off_mm: np.ndarray, seed: int = 1, sd_mm: float = 0.3
) -> tuple[PointRegistration, np.ndarray]:
    """Return the registration with one landmark off by this on the CT's axes, and its errors at TARGETS."""
    truth = touched(fixed, np.random.default_rng(seed), sd_mm)
    moving = truth.moving_mm.copy()
    moving[wrong] += truth.fixed_from_moving.rotation.T @ off_mm
    found = register_points(PointPairs(fixed_mm=fixed, moving_mm=moving))
    at = found.fixed_from_moving.move_points(truth.fixed_from_moving.inverse.move_points(TARGETS))
    return found, np.linalg.norm(at - TARGETS, axis=1)


def hidden_way(fixed: np.ndarray, wrong: int) -> np.ndarray:
    """Return the direction in which an error of this landmark leaves the smallest residuals."""
    arms = fixed - fixed.mean(axis=0)
    normal = normal_matrix(arms, np.tile(np.eye(3), (len(fixed), 1, 1)))
    row = jacobians(arms)[wrong]
    return np.linalg.eigh(np.eye(3) - row @ np.linalg.solve(normal, row.T))[1][:, 0]


# `python -m tests.tracker.registration.outlier_study` has each number of landmarks, and more draws.
@pytest.mark.parametrize(
    ("count", "stated"), [(4, True), (6, False)], ids=["tips-state-noise", "residuals-only"]
)
def test_a_landmark_6_mm_off_is_rejected_and_named_and_good_ones_pass(count: int, stated: bool) -> None:
    good = study(count, 40, outlier_mm=0.0, stated=stated)
    bad = study(count, 40, outlier_mm=OUTLIER_MM, stated=stated)
    # Of four landmarks, one may lie so far from the others that noise alone makes it stray.
    assert np.mean(good.rejected) <= (0.10 if count == 4 else 0.05)
    assert np.mean(bad.rejected) >= 0.90
    assert np.mean(bad.first) >= 0.85
    assert np.mean(bad.named) >= 0.95
    assert np.mean(good.inside) >= 0.90


def test_three_landmarks_cannot_show_a_mistaken_one_and_say_so() -> None:
    bad = study(3, 50, outlier_mm=OUTLIER_MM, stated=True)
    assert np.mean(bad.rejected) < 0.8
    assert np.mean(bad.inside_alone) < 0.6
    assert np.mean(bad.inside) >= 0.85
    found, _ = registered(VERTEBRA[[0, 1, 4]], wrong=0, off_mm=np.zeros(3))
    (remark,) = (one for one in found.remarks if one.code == "POINTS_OUTLIER_NOT_EXCLUDED")
    assert "3 landmarks do not exclude an error of any size in each of them" in remark.message
    assert set(found.undetected_mm.values()) == {np.inf}


@pytest.mark.parametrize("wrong", range(4))
def test_what_hides_from_four_landmarks_is_in_the_stated_error(wrong: int) -> None:
    way = hidden_way(FOUR, wrong)
    for seed, sign in ((1, 1.0), (2, -1.0), (3, 1.0)):
        found, off_mm = registered(FOUR, wrong=wrong, off_mm=sign * OUTLIER_MM * way, seed=seed)
        stated = np.array([found.tre_stated_mm(at) for at in TARGETS])
        # Twice the 3-D RMS is beyond 95 % of a normal distribution, however it is shaped.
        assert (off_mm < 2.0 * stated).all()
        assert found.failures(GATE, []) or found.undetected_mm[wrong] > OUTLIER_MM


def test_an_outlier_that_all_gates_accept_is_covered_only_because_it_is_considered() -> None:
    found, off_mm = registered(FOUR, wrong=1, off_mm=OUTLIER_MM * hidden_way(FOUR, 1), seed=3)
    assert found.failures(GATE, list(TARGETS)) == ()
    assert off_mm[1] > 2.0 * found.tre_without_outlier_mm(TARGETS[1])
    assert off_mm[1] < 2.0 * found.tre_stated_mm(TARGETS[1])


def test_the_likeliest_outlier_is_the_one_without_which_the_others_fit() -> None:
    found, _ = registered(FOUR, wrong=0, off_mm=np.array([6.0, 0.0, 0.0]))
    worst = max(found.leave_one_out_mm, key=lambda index: found.leave_one_out_mm[index])
    assert worst != 0
    assert found.outliers(GATE) == (0,)
    assert "without point 1 to 0." in found.failures(GATE, [])[0].message
    assert found.failures(GATE, [])[0].context["landmark"] == "1"


def test_eight_good_landmarks_exclude_every_gross_error_and_nothing_is_added() -> None:
    fixed = np.vstack([VERTEBRA, [[-9.0, 9.0, -3.0], [0.0, 15.0, 2.0]]])
    found, _ = registered(fixed, wrong=0, off_mm=np.zeros(3))
    assert max(found.undetected_mm.values()) < PointSettings().max_left_out_mm
    assert np.array_equal(found.covariance, found.covariance_without_outlier)
    assert found.outliers(GATE) == ()


def test_the_covariance_with_an_outlier_has_the_distance_by_which_it_moved_the_fit() -> None:
    exact = np.array(VERTEBRA)
    moving = exact.copy()
    moving[2] += [0.0, 6.0, 0.0]
    fit = fit_rigid(exact, moving)
    # Landmarks known to 0.01 mm: without the outlier the fit is exact, and all its error the separation.
    noise = np.tile(1e-4 * np.eye(3), (len(exact), 1, 1))
    moment = covariance_with_outlier(fit, exact, moving, noise, 2, 5.0)
    shift = fit.move_points(moving.mean(axis=0)) - moving.mean(axis=0)
    turn = vector_from_rotation(fit.rotation)
    error = np.concatenate([shift, turn])
    assert np.linalg.norm(shift) > 0.5
    assert np.allclose(moment, np.outer(error, error), atol=2e-2)


def test_the_spanning_covariance_is_nowhere_smaller_than_any() -> None:
    rng = np.random.default_rng(5)
    roots = rng.normal(size=(4, 6, 6))
    given = [root @ root.T for root in roots]
    spanning = covariance_spanning(given)
    for one in given:
        assert np.linalg.eigvalsh(spanning - one).min() > -1e-9
    assert np.allclose(covariance_spanning([given[0], 0.5 * given[0]]), given[0])
    # By hand: the larger variance on each axis.
    assert np.allclose(covariance_spanning([np.diag([1.0, 4.0]), np.diag([9.0, 2.0])]), np.diag([9.0, 4.0]))
