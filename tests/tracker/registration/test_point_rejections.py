"""Points that determine no transform, or are in the wrong order, are rejected with the reason."""

import numpy as np
import pytest

from tests.tracker.registration.constellations import VERTEBRA, random_landmarks, touched
from tracker.errors import RegistrationError
from tracker.registration.points import PointPairs, register_points


def rejected(fixed: np.ndarray, moving: np.ndarray) -> RegistrationError:
    with pytest.raises(RegistrationError) as caught:
        register_points(PointPairs(fixed_mm=fixed, moving_mm=moving))
    assert caught.value.remedy.endswith(".")
    return caught.value


def line(count: int, beside_mm: float, seed: int = 0) -> np.ndarray:
    rng = np.random.default_rng(seed)
    points = np.outer(np.linspace(-40.0, 40.0, count), [0.6, 0.0, 0.8])
    return np.asarray(points + rng.uniform(-beside_mm, beside_mm, (count, 3)))


@pytest.mark.parametrize("count", [0, 1, 2])
def test_too_few_points_are_rejected(count: int) -> None:
    assert rejected(VERTEBRA[:count], VERTEBRA[:count]).code == "POINTS_TOO_FEW"


def test_excluding_too_many_is_rejected_too() -> None:
    with pytest.raises(RegistrationError, match="needed 3"):
        register_points(PointPairs(fixed_mm=VERTEBRA[:4], moving_mm=VERTEBRA[:4]), excluded=[0, 2])


@pytest.mark.parametrize(
    ("fixed", "moving", "code"),
    [
        pytest.param(VERTEBRA, VERTEBRA[:5], "POINTS_COUNTS_DIFFER", id="one-was-not-touched"),
        pytest.param(VERTEBRA * np.nan, VERTEBRA, "POINTS_INVALID", id="not-a-number"),
        pytest.param(VERTEBRA[:, :2], VERTEBRA[:, :2], "POINTS_INVALID", id="flat"),
        pytest.param(VERTEBRA / 1000.0, VERTEBRA, "POINTS_UNIT_SUSPECT", id="the-plan-in-metres"),
        pytest.param(VERTEBRA, VERTEBRA / 10.0, "POINTS_UNIT_SUSPECT", id="tips-in-centimetres"),
        pytest.param(VERTEBRA / 1000.0, VERTEBRA / 1000.0, "POINTS_COINCIDENT", id="both-in-metres"),
        pytest.param(VERTEBRA[[0, 1, 1, 3]], VERTEBRA[[0, 1, 1, 3]], "POINTS_COINCIDENT", id="one-twice"),
        pytest.param(VERTEBRA[[1, 1, 1]], VERTEBRA[[1, 1, 1]], "POINTS_COINCIDENT", id="one-thrice"),
        pytest.param(line(3, 0.0), line(3, 0.0), "POINTS_COLLINEAR", id="a-line"),
        pytest.param(line(6, 0.8), line(6, 0.8), "POINTS_COLLINEAR", id="nearly-a-line"),
        pytest.param(VERTEBRA, line(6, 0.5), "POINTS_COLLINEAR", id="touched-along-a-line"),
    ],
)
def test_points_that_say_no_motion_are_rejected(fixed: np.ndarray, moving: np.ndarray, code: str) -> None:
    assert rejected(fixed, moving).code == code


def test_a_line_is_reported_with_its_numbers_and_the_unit_with_its_name() -> None:
    error = rejected(line(5, 0.5), line(5, 0.5))
    assert "ambiguous" in error.message
    assert error.context["along_mm"] == pytest.approx(28.3, abs=1.0)
    assert "metres" in rejected(VERTEBRA / 1000.0, VERTEBRA).message
    assert "metres" in rejected(VERTEBRA / 1000.0, VERTEBRA / 1000.0).message


@pytest.mark.parametrize("count", [3, 4, 5, 6, 9])
def test_a_swapped_pair_is_named(count: int) -> None:
    rng = np.random.default_rng(count)
    fixed = np.vstack([VERTEBRA, [[0.0, 0.0, 40.0], [25.0, 20.0, -20.0], [-14.0, 30.0, 22.0]]])
    fixed = fixed[[0, 3, 4, 5, 2, 1, 6, 7, 8][:count]]
    truth = touched(fixed, rng, 0.3)
    order = np.arange(count)
    order[[1, 2]] = 2, 1
    error = rejected(fixed, truth.moving_mm[order])
    assert error.code == "POINTS_SWAPPED"
    assert "points 2 and 3 seem to be swapped" in error.message


def test_two_swapped_pairs_and_a_ring_of_three_are_named() -> None:
    fixed = VERTEBRA
    assert "points 1 and 4; 2 and 5 seem" in rejected(fixed, fixed[[3, 4, 2, 0, 1, 5]]).message
    assert rejected(fixed, fixed[[4, 0, 2, 3, 1, 5]]).code == "POINTS_SWAPPED"


def test_thousands_of_points_are_fitted_too() -> None:
    rng = np.random.default_rng(6)
    fixed = np.asarray(np.stack(np.meshgrid(*[np.arange(18.0) * 5.0] * 3), axis=-1).reshape(-1, 3))
    truth = touched(fixed, rng, 0.2)
    found = register_points(PointPairs(fixed_mm=fixed, moving_mm=truth.moving_mm))
    assert found.fre_rms_mm == pytest.approx(0.2 * np.sqrt(3.0), rel=0.05)
    assert rejected(fixed, np.roll(truth.moving_mm, 1, axis=0)).code == "POINTS_SWAPPED"


@pytest.mark.parametrize("axis", [0, 1, 2])
def test_mirrored_points_are_reported(axis: int) -> None:
    rng = np.random.default_rng(axis)
    fixed = random_landmarks(rng, 6)
    mirrored = touched(fixed, rng, 0.3).moving_mm
    mirrored[:, axis] *= -1.0
    error = rejected(fixed, mirrored)
    assert error.code == "POINTS_MIRRORED"
    assert "their mirror image to 0." in error.message


def test_two_signs_are_a_turn_and_no_mirror() -> None:
    ras = VERTEBRA * [-1.0, -1.0, 1.0]
    assert register_points(PointPairs(fixed_mm=VERTEBRA, moving_mm=ras)).fre_rms_mm < 1e-9


def test_sides_that_look_alike_are_a_warning_and_no_rejection() -> None:
    fixed = np.array([[20.0, 0.0, 10.0], [-20.0, 0.0, 10.0], [0.0, 30.0, -5.0]])
    truth = touched(fixed, np.random.default_rng(3), 0.3)
    found = register_points(PointPairs(fixed_mm=fixed, moving_mm=truth.moving_mm))
    assert [one.code for one in found.remarks] == ["POINTS_SWAP_UNDETECTABLE", "POINTS_OUTLIER_NOT_EXCLUDED"]
    assert "points 1 and 2" in found.remarks[0].message


def test_points_that_differ_raise_no_warning() -> None:
    fixed = np.array([[20.0, 0.0, 10.0], [-35.0, 0.0, 10.0], [0.0, 30.0, -5.0], [8.0, 12.0, 30.0]])
    truth = touched(fixed, np.random.default_rng(4), 0.2)
    assert register_points(PointPairs(fixed_mm=fixed, moving_mm=truth.moving_mm)).remarks == ()


def test_a_bad_fit_that_no_order_mends_is_ambiguous_where_another_order_is_better() -> None:
    fixed = np.array([[22.0, 0.0, 0.0], [-18.0, 0.0, 0.0], [0.0, 30.0, 0.0]])
    # The legs as if the first two were exchanged, and the base 6 mm too long.
    moving = np.array([[21.0, 0.0, 0.0], [-25.0, 0.0, 0.0], [0.0, 30.0, 0.0]])
    error = rejected(fixed, moving)
    assert error.code == "POINTS_AMBIGUOUS"
    assert "points 1 and 2" in error.message


def test_noise_of_a_bad_hand_is_never_called_a_swap() -> None:
    rng = np.random.default_rng(5)
    for _ in range(150):
        truth = touched(VERTEBRA, rng, 0.8)
        fit = register_points(PointPairs(fixed_mm=VERTEBRA, moving_mm=truth.moving_mm))
        assert fit.used.all()


@pytest.mark.parametrize(
    "covariances",
    [
        pytest.param(np.zeros((5, 3, 3)), id="too-few"),
        pytest.param(np.broadcast_to(-np.eye(3), (6, 3, 3)), id="negative"),
        pytest.param(np.full((6, 3, 3), np.nan), id="not-numbers"),
    ],
)
def test_covariances_that_are_none_are_rejected(covariances: np.ndarray) -> None:
    with pytest.raises(RegistrationError, match="covariances"):
        PointPairs(fixed_mm=VERTEBRA, moving_mm=VERTEBRA, moving_covariances_mm2=covariances)


def test_names_that_occur_twice_are_rejected() -> None:
    with pytest.raises(RegistrationError, match="different names"):
        PointPairs(fixed_mm=VERTEBRA[:3], moving_mm=VERTEBRA[:3], labels=("a", "b", "a"))
