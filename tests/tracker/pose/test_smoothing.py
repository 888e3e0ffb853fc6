"""Smoothed poses: lag and noise as stated, and no averaging over a jump."""

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tracker.geometry import Array, Camera, Marker, Rigid, rotation_from_vector, vector_from_rotation
from tracker.pose import PoseSmoother, SmoothedPose
from tracker.pose.smoothing import MAX_MAHALANOBIS_SQUARED, STILL

SD = np.array([0.1, 0.1, 0.4, 0.01, 0.01, 0.003])
COVARIANCE = np.diag(SD**2)
FACING = np.diag([1.0, -1.0, -1.0])
PERIOD_S = 1.0 / 30.0

Pose = Rigid[Camera, Marker]


def pose_at(step: Array) -> Pose:
    """A marker half a metre away, displaced by (6,) in mm and rad."""
    return Rigid(
        rotation=rotation_from_vector(step[3:]) @ FACING,
        translation_mm=np.array([10.0, -20.0, 500.0]) + step[:3],
    )


def apart(a: Pose, b: Pose) -> Array:
    turn = vector_from_rotation(a.rotation @ b.rotation.T)
    return np.concatenate([a.translation_mm - b.translation_mm, turn])


def taken(steady: PoseSmoother, steps: Array, *, period_s: float = PERIOD_S) -> list[SmoothedPose]:
    return [steady.take(pose_at(step), COVARIANCE, at_s=k * period_s) for k, step in enumerate(steps)]


@pytest.mark.parametrize("rate_hz", [15.0, 30.0, 60.0])
@pytest.mark.parametrize("lag_ms", [40.0, 50.0, 100.0])
def test_on_a_ramp_the_pose_is_the_one_of_the_stated_time_before(rate_hz: float, lag_ms: float) -> None:
    speed = np.array([2.0, -1.0, 3.0, 0.0, 0.05, 0.0])  # mm/s, rad/s: slow enough to be taken for still
    times = np.arange(20) / rate_hz
    last = taken(PoseSmoother(lag_ms=lag_ms), times[:, None] * speed, period_s=1.0 / rate_hz)[-1]
    assert 0.0 < last.lag_ms <= lag_ms + 1e-6
    # The longest mean that meets the allowed lag.
    assert last.lag_ms > lag_ms - 1000.0 / rate_hz
    then = pose_at(speed * (times[-1] - last.lag_ms / 1000.0))
    assert apart(last.camera_from_marker, then) == pytest.approx(np.zeros(6), abs=1e-9)


def test_a_jump_is_shown_in_its_own_image_and_what_was_before_never_comes_back() -> None:
    jump = np.array([1.5, 0.0, 0.0, 0.0, 0.0, 0.0])
    shown = taken(PoseSmoother(lag_ms=50.0), np.vstack([np.zeros((6, 6)), np.tile(jump, (6, 1))]))
    assert shown[5].lag_ms == pytest.approx(50.0)
    assert apart(shown[6].camera_from_marker, pose_at(jump)) == pytest.approx(np.zeros(6), abs=1e-12)
    assert (shown[6].lag_ms, shown[6].images) == (0.0, 1)
    assert [one.images for one in shown[6:]] == [1, 2, 3, 4, 4, 4]
    for one in shown[6:]:
        assert apart(one.camera_from_marker, pose_at(jump)) == pytest.approx(np.zeros(6), abs=1e-12)


def test_a_turn_over_is_a_jump_even_where_the_covariance_spans_it() -> None:
    steady, wide = PoseSmoother(lag_ms=50.0), np.eye(6) * 100.0
    steady.take(pose_at(np.zeros(6)), wide, at_s=0.0)
    over = pose_at(np.array([0.0, 0.0, 0.0, 0.2, 0.0, 0.0]))
    assert steady.take(over, wide, at_s=PERIOD_S).camera_from_marker is over


def test_a_fast_hand_is_shown_without_lag() -> None:
    steps = np.outer(np.arange(8.0) * PERIOD_S, [100.0, 0, 0, 0, 0, 0]).astype(float)
    assert [one.lag_ms for one in taken(PoseSmoother(lag_ms=100.0), steps)] == [0.0] * 8


def test_a_hand_that_holds_still_is_steadied_although_it_trembles() -> None:
    sure = COVARIANCE / 100.0
    steady, shown = PoseSmoother(lag_ms=50.0), []
    for k in range(60):
        tremble = np.array([0.2, 0.1, 0, 0, 0.001, 0]) * np.sin(2 * np.pi * 8.0 * k * PERIOD_S)
        shown.append(steady.take(pose_at(tremble), sure, at_s=k * PERIOD_S))
    off = np.array([apart(one.camera_from_marker, pose_at(np.zeros(6)))[0] for one in shown[10:]])
    assert shown[-1].lag_ms == pytest.approx(50.0)
    assert off.std() < 0.5 * 0.2 / np.sqrt(2.0)


def test_a_missing_image_leaves_nothing_behind() -> None:
    steady = PoseSmoother(lag_ms=50.0)
    taken(steady, np.zeros((5, 6)))
    steady.forget()
    assert steady.take(pose_at(np.zeros(6)), COVARIANCE, at_s=6 * PERIOD_S).images == 1


@pytest.mark.parametrize("at_s", [10.0, 0.01], ids=["after-a-pause", "time-runs-backwards"])
def test_poses_of_another_time_take_no_part(at_s: float) -> None:
    steady = PoseSmoother(lag_ms=50.0)
    taken(steady, np.zeros((5, 6)))
    assert steady.take(pose_at(np.zeros(6)), COVARIANCE, at_s=at_s).images == 1


def test_the_pose_itself_comes_back_where_no_lag_is_allowed() -> None:
    steady = PoseSmoother(lag_ms=0.0)
    for k in range(4):
        pose = pose_at(np.zeros(6))
        out = steady.take(pose, COVARIANCE, at_s=k * PERIOD_S)
        assert out.camera_from_marker is pose
        assert out.pose_covariance is COVARIANCE


def test_noise_of_a_marker_at_rest_is_reduced_by_the_stated_ratio() -> None:
    noise = np.random.default_rng(5).normal(0.0, 1.0, (1500, 6)) * SD
    shown = taken(PoseSmoother(lag_ms=50.0), noise)
    assert shown[-1].noise_ratio == pytest.approx(0.5)
    off = np.array([apart(one.camera_from_marker, pose_at(np.zeros(6))) for one in shown[10:]])
    stated = np.sqrt(np.mean([one.noise_ratio**2 for one in shown[10:]]))
    assert off.std(axis=0) / SD == pytest.approx(np.full(6, stated), rel=0.08)
    assert stated < 0.56


@pytest.mark.parametrize("speed_mm_s", [0.0, 3.0, 8.0, 30.0, 200.0])
@pytest.mark.parametrize("common", [0.0, 0.9], ids=["independent-errors", "errors-in-common"])
def test_where_the_marker_is_now_lies_within_the_stated_covariance(speed_mm_s: float, common: float) -> None:
    random = np.random.default_rng(8)
    inside = 0
    for _ in range(60):
        shared = random.normal(0.0, 1.0, 6) * np.sqrt(common)
        steps = (random.normal(0.0, 1.0, (8, 6)) * np.sqrt(1.0 - common) + shared) * SD
        steps[:, 0] += np.arange(8) * PERIOD_S * speed_mm_s
        last = taken(PoseSmoother(lag_ms=50.0), steps)[-1]
        truth = np.array([7 * PERIOD_S * speed_mm_s, 0, 0, 0, 0, 0])
        off = apart(last.camera_from_marker, pose_at(truth))
        inside += (
            float(off @ np.linalg.solve(last.pose_covariance, off)) < 12.59
        )  # 95 %, 6 degrees of freedom
    assert inside / 60 >= 0.9


@given(
    st.lists(
        st.tuples(st.sampled_from([0.2, 1.0, 5.0, 40.0]), st.integers(0, 2**31)), min_size=2, max_size=12
    )
)
def test_what_is_shown_is_never_farther_from_its_image_than_noise_admits(
    moves: list[tuple[float, int]],
) -> None:
    steady, at = PoseSmoother(lag_ms=100.0), np.zeros(6)
    for k, (size, seed) in enumerate(moves):
        at = at + size * SD * np.random.default_rng(seed).normal(0.0, 1.0, 6)
        out = steady.take(pose_at(at), COVARIANCE, at_s=k * PERIOD_S)
        off = apart(out.camera_from_marker, pose_at(at))
        assert float(off @ np.linalg.solve(2.0 * COVARIANCE + STILL, off)) <= MAX_MAHALANOBIS_SQUARED * (
            1.0 + 1e-6
        )
