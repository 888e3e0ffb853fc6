"""The tip by pivoting: against known truth, with outliers, honest covariance, rejected where blind."""

import dataclasses

import numpy as np
import pytest

from tests.real_data import real_data_file
from tests.tracker.pose.tool.pivoted import HANDS, STATED, TIP_MM, Hand, pivoted, squared_errors
from tracker.errors import CalibrationError, InvalidInput
from tracker.geometry import Camera, Marker, Rigid, rotation_from_vector
from tracker.pose.tool import Poses, RejectedReason, ToolGate, pivot_calibration, rms_3d_mm

# `python -m tests.benchmarks.drawn_coverage` has more, and shares with confidence bounds.
RUNS = 12
EXACT = Hand(shift_sd_mm=0.0, turn_sd_deg=(0.0, 0.0, 0.0))


def test_without_noise_the_tip_is_exact() -> None:
    made = pivoted(EXACT)
    found = pivot_calibration(made.poses)
    np.testing.assert_allclose(found.tip_in_marker_mm, made.tip_mm, atol=1e-9)
    np.testing.assert_allclose(found.pivot_in_camera_mm, made.pivot_mm, atol=1e-9)
    assert found.used.all()
    assert found.rejected == ()
    assert found.failures(ToolGate()) == ()


def test_the_residual_is_the_distance_in_space_not_an_axis() -> None:
    tips = np.array([[3.0, 4.0, 0.0], [-3.0, -4.0, 0.0]])
    assert rms_3d_mm(tips, np.zeros(3)) == pytest.approx(5.0)
    made = pivoted()
    found = pivot_calibration(made.poses)
    off = made.poses.of(found.used).points_mm(found.tip_in_marker_mm) - found.pivot_in_camera_mm
    assert found.rms_3d_mm == pytest.approx(float(np.sqrt((off**2).sum() / found.used.sum())))


@pytest.mark.parametrize("name", HANDS)
def test_the_tip_is_off_as_much_as_its_covariance_states(name: str) -> None:
    squared = squared_errors(HANDS[name], runs=RUNS, states_covariance=name in STATED)
    # Chi-square of 3 degrees of freedom: its mean over the runs, within three standard errors.
    assert np.mean(squared) == pytest.approx(3.0, abs=3.0 * np.sqrt(6.0 / RUNS))


def test_outliers_are_named_with_their_distance_and_move_the_tip_no_farther_than_noise() -> None:
    made = pivoted(Hand(outlier_ratio=0.35), seed=3)
    found = pivot_calibration(made.poses)
    named = np.zeros(len(made.poses), dtype=bool)
    for pose in found.rejected:
        named[pose.index] = True
        assert pose.reason is RejectedReason.OFF_THE_PIVOT
        assert pose.off > 3.0 * found.rms_3d_mm / np.sqrt(3.0)
    assert (named == ~found.used).all()
    assert (named & made.is_outlier).sum() >= made.is_outlier.sum() - 2
    assert (named & ~made.is_outlier).sum() <= 1
    assert np.linalg.norm(found.tip_in_marker_mm - made.tip_mm) < 0.5
    assert found.rms_3d_of_all_mm > 5.0 * found.rms_3d_mm


def test_a_pose_reported_twice_counts_once() -> None:
    made = pivoted(Hand(count=30))
    again = np.concatenate([np.arange(30), np.full(200, 7)])
    found, once = pivot_calibration(made.poses.of(again)), pivot_calibration(made.poses)
    np.testing.assert_allclose(found.tip_covariance_mm2, once.tip_covariance_mm2)
    np.testing.assert_array_equal(found.tip_in_marker_mm, once.tip_in_marker_mm)
    assert [pose.reason for pose in found.rejected] == [RejectedReason.REPEATED] * 200


def test_images_in_a_row_that_err_alike_do_not_make_the_tip_surer() -> None:
    made = pivoted(Hand(count=40, shift_sd_mm=0.5))
    each_ten_times = np.repeat(np.arange(40), 10)
    poses = made.poses.of(each_ten_times)
    jitter = np.random.default_rng(0).normal(size=(400, 3)) * 1e-3
    shaken = dataclasses.replace(poses, translations_mm=poses.translations_mm + jitter)
    sure, single = pivot_calibration(shaken), pivot_calibration(made.poses)
    assert sure.tip_sd_mm > 0.8 * single.tip_sd_mm


def test_stated_covariances_make_the_tip_better_where_poses_differ() -> None:
    errors = {False: 0.0, True: 0.0}
    hand = Hand(shift_sd_mm=0.03, depth_sd_mm=0.5, turn_sd_deg=(0.3, 0.3, 0.05))
    for seed in range(6):
        for states in errors:
            made = pivoted(hand, seed=seed, states_covariance=states)
            found = pivot_calibration(made.poses)
            errors[states] += float(np.linalg.norm(found.tip_in_marker_mm - made.tip_mm))
    assert errors[True] < 0.7 * errors[False]


def test_a_covariance_stated_four_times_too_large_changes_nothing() -> None:
    made = pivoted(Hand(shift_sd_mm=2.0, turn_sd_deg=(0.5, 0.5, 0.5)), states_covariance=True)
    assert made.poses.covariances is not None
    wide = dataclasses.replace(made.poses, covariances=4.0 * made.poses.covariances)
    own, other = pivot_calibration(made.poses), pivot_calibration(wide)
    np.testing.assert_allclose(other.tip_in_marker_mm, own.tip_in_marker_mm, atol=0.05)
    np.testing.assert_allclose(other.tip_sd_mm, own.tip_sd_mm, rtol=0.05)


def rejected(poses: Poses) -> CalibrationError:
    with pytest.raises(CalibrationError) as caught:
        pivot_calibration(poses)
    assert caught.value.context
    return caught.value


@pytest.mark.parametrize(
    ("hand", "code"),
    [
        pytest.param(Hand(tilts_deg=(40.0, 0.0), spin_deg=0.0), "PIVOT_TILT_TOO_SMALL", id="one-plane"),
        pytest.param(
            Hand(tilts_deg=(40.0, 3.0), spin_deg=3.0), "PIVOT_TILT_TOO_SMALL", id="nearly-one-plane"
        ),
        pytest.param(Hand(tilts_deg=(0.0, 0.0), spin_deg=180.0), "PIVOT_TILT_TOO_SMALL", id="spun-only"),
        pytest.param(Hand(tilts_deg=(5.0, 5.0), spin_deg=5.0), "PIVOT_TILT_TOO_SMALL", id="hardly-moved"),
        pytest.param(
            Hand(tilts_deg=(40.0, 0.0), spin_deg=0.0, turn_sd_deg=(0.8, 0.8, 0.8)),
            "PIVOT_TILT_TOO_SMALL",
            id="one-plane-in-noise",
        ),
        pytest.param(
            Hand(tilts_deg=(40.0, 0.0), spin_deg=0.0, outlier_ratio=0.15),
            "PIVOT_TILT_TOO_SMALL",
            id="one-plane-with-outliers",
        ),
        pytest.param(Hand(count=9), "TOOL_TOO_FEW_POSES", id="nine-poses"),
    ],
)
def test_a_motion_that_leaves_the_tip_open_is_rejected(hand: Hand, code: str) -> None:
    assert rejected(pivoted(hand).poses).code == code


def test_tilt_in_one_plane_is_enough_with_spin() -> None:
    found = pivot_calibration(pivoted(Hand(tilts_deg=(30.0, 1.0), spin_deg=30.0)).poses)
    assert np.linalg.norm(found.tip_in_marker_mm - TIP_MM) < 0.5
    assert found.motion_range.tilt_range_deg == pytest.approx(60.0, abs=6.0)
    assert found.motion_range.tilt_range_across_deg < 5.0
    assert found.motion_range.spin_range_deg == pytest.approx(60.0, abs=6.0)


@pytest.mark.parametrize("count", [0, 1, 2, 60])
def test_the_same_pose_again_and_again_is_rejected(count: int) -> None:
    poses = pivoted(Hand(count=60)).poses.of(np.zeros(count, dtype=np.int_))
    assert rejected_code(poses) == "TOOL_TOO_FEW_POSES"


def rejected_code(poses: Poses) -> str:
    return rejected(poses).code


def test_one_lone_tilted_pose_among_many_in_one_plane_does_not_pass() -> None:
    made = pivoted(Hand(count=40, tilts_deg=(40.0, 0.0), spin_deg=0.0))
    rotation = rotation_from_vector([0.0, 0.5, 0.3]) @ made.poses.rotations[0]
    lone = Poses(
        rotations=np.concatenate([made.poses.rotations, rotation[None]]),
        translations_mm=np.concatenate(
            [made.poses.translations_mm, [made.pivot_mm - rotation @ made.tip_mm]]
        ),
    )
    assert rejected(lone).code == "PIVOT_TILT_TOO_SMALL"


def test_metres_are_recognised_and_nothing_is_scaled() -> None:
    made = pivoted()
    metres: list[Rigid[Camera, Marker]] = [
        Rigid(rotation=rotation, translation_mm=translation / 1000.0)
        for rotation, translation in zip(made.poses.rotations, made.poses.translations_mm, strict=True)
    ]
    mixed: list[Rigid[Camera, Marker]] = [
        Rigid(rotation=rotation, translation_mm=translation / (1000.0 if index % 7 == 0 else 1.0))
        for index, (rotation, translation) in enumerate(
            zip(made.poses.rotations, made.poses.translations_mm, strict=True)
        )
    ]
    for poses, words in ((metres, "all poses"), (mixed, "9 of 60")):
        with pytest.raises(InvalidInput, match=words) as caught:
            Poses.from_rigids(poses)
        assert caught.value.code == "POSE_UNIT_SUSPECT"


@pytest.mark.parametrize(
    "covariance",
    [
        pytest.param(np.full((6, 6), np.nan), id="not-a-number"),
        pytest.param(-np.eye(6), id="negative-or-not-it-has-no-root"),
        pytest.param(np.eye(3), id="three-by-three"),
        pytest.param(np.zeros((6, 6)), id="zero"),
    ],
)
def test_a_covariance_that_is_none_is_rejected(covariance: np.ndarray) -> None:
    pose: Rigid[Camera, Marker] = Rigid(rotation=np.eye(3), translation_mm=np.array([0.0, 0.0, 500.0]))
    with pytest.raises(InvalidInput) as caught:
        Poses.from_rigids([pose, pose], [covariance, covariance])
    assert caught.value.code == "POSE_COVARIANCE_INVALID"


@pytest.mark.parametrize(
    ("hand", "code"),
    [
        pytest.param(Hand(shift_sd_mm=0.7), "PIVOT_RESIDUAL_TOO_LARGE", id="noisy"),
        pytest.param(
            Hand(count=12, shift_sd_mm=0.4, tilts_deg=(12.0, 12.0)), "PIVOT_TIP_UNCERTAIN", id="few-and-steep"
        ),
    ],
)
def test_the_gate_states_failures_with_both_numbers(hand: Hand, code: str) -> None:
    failures = pivot_calibration(pivoted(hand).poses).failures(ToolGate())
    assert code in [failure.code for failure in failures]
    assert all("0.80" in failure.message and failure.remedy for failure in failures)


def test_inverted_poses_fit_and_are_rejected_by_the_distance_of_their_tip() -> None:
    poses = pivoted(Hand(pivot_mm=(100.0, 50.0, 1000.0))).poses
    rotations = poses.rotations.transpose(0, 2, 1)
    moved = -np.einsum("nij,nj->ni", rotations, poses.translations_mm)
    found = pivot_calibration(Poses(rotations=rotations, translations_mm=moved))
    (failure,) = found.failures(ToolGate(max_tip_sd_mm=100.0, max_rms_3d_mm=100.0))
    assert failure.code == "PIVOT_TIP_FAR"
    # The tip of an inverted pose is the pivot as the tracker has it.
    np.testing.assert_allclose(found.tip_in_marker_mm, [100.0, 50.0, 1000.0], atol=5.0)


def test_two_divots_are_distinguished_from_one() -> None:
    here, there = pivoted(Hand(count=33)), pivoted(Hand(count=27, pivot_mm=(50.0, -20.0, 500.0)), seed=1)
    both = Poses(
        rotations=np.concatenate([here.poses.rotations, there.poses.rotations]),
        translations_mm=np.concatenate([here.poses.translations_mm, there.poses.translations_mm]),
    )
    codes = [failure.code for failure in pivot_calibration(both).failures(ToolGate())]
    assert codes


def test_a_real_pointer_is_at_least_as_still_as_its_makers_found_it() -> None:
    folder = real_data_file("tracking", "pivot")
    poses = Poses.from_rigids([Rigid.from_matrix(np.loadtxt(file)) for file in sorted(folder.glob("*.txt"))])
    found = pivot_calibration(poses)
    assert len(poses) == 57
    assert int(found.used.sum()) >= 50
    assert 24 in [pose.index for pose in found.rejected]
    assert found.rms_3d_mm < 2.5
    # The least that all poses allow is 3.05; the robust tip is worse for outliers, and hardly.
    assert found.rms_3d_of_all_mm < 1.03 * 3.0496
    assert np.linalg.norm(found.tip_in_marker_mm - [-14.473, 394.634, -7.407]) < 2.5
    assert found.failures(ToolGate())[0].code == "PIVOT_RESIDUAL_TOO_LARGE"
