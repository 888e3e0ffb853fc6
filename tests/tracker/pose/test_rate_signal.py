"""The rates of a recorded series: low-passed without delay, the same for every frame, absent in gaps."""

from dataclasses import replace

import numpy as np
import pytest
from scipy.interpolate import make_smoothing_spline

from tests.tracker.pose.shared_motion import HandMotion, Source, steady, waving
from tracker.pose.temporal_calibration import Motion, TimeOffsetLimits
from tracker.pose.temporal_calibration.series import rate_signal, smoothing_spline_values

LIMITS = TimeOffsetLimits()
EXACT = Source(seed=1, shift_sd_mm=0.0, turn_sd_deg=0.0)


@pytest.mark.parametrize("count", [5, 6, 60])
def test_the_smoothing_spline_is_that_of_scipy(count: int) -> None:
    random = np.random.default_rng(count)
    x = np.cumsum(random.uniform(0.02, 0.05, count))
    y, weights = random.normal(size=(count, 2)), random.uniform(0.02, 0.05, count)
    penalty = (2.0 * np.pi * 4.0) ** -4
    values = smoothing_spline_values(x, y, weights=weights, penalty=penalty)
    peers = [make_smoothing_spline(x, column, w=weights, lam=penalty)(x) for column in y.T]
    np.testing.assert_allclose(values, np.column_stack(peers), atol=1e-10)


@pytest.mark.parametrize(
    ("motion", "speed"),
    [
        # By hand: 30 deg and 80 mm a second along (1, 0.1).
        pytest.param(Motion.ROTATION, 30.0 * np.hypot(1.0, 0.1), id="deg-s"),
        pytest.param(Motion.TRANSLATION, 80.0 * np.hypot(1.0, 0.1), id="mm-s"),
    ],
)
def test_one_velocity_has_its_speed(motion: Motion, speed: float) -> None:
    rates = rate_signal(EXACT.record(steady), motion, LIMITS).at(np.array([1.0, 5.0, 9.0]))
    np.testing.assert_allclose(np.linalg.norm(rates, axis=1), speed, rtol=1e-6)


def test_the_low_pass_halves_the_amplitude_at_its_cut_off_at_any_rate_and_does_not_delay() -> None:
    times_s = np.arange(4.0, 8.0, 0.01)
    signals = []
    for rate_hz in (60.0, 120.0):
        source = replace(EXACT, rate_hz=rate_hz)
        signals.append(rate_signal(source.record(waving(0.25)), Motion.TRANSLATION, LIMITS).at(times_s))
    # Where the tool passes the middle, its speed is largest: the sine's derivative times 80 mm.
    largest = 80.0 * np.hypot(0.6, 0.4) * 2.0 * np.pi / 0.25
    for signal in signals:
        speeds = np.linalg.norm(signal, axis=1)
        assert speeds[0] == pytest.approx(0.5 * largest, rel=0.03)
        assert speeds.max() == pytest.approx(0.5 * largest, rel=0.03)


def test_angular_velocity_is_the_same_for_every_marker_on_the_tool_but_for_the_frame() -> None:
    times_s = np.linspace(1.0, 11.0, 50)
    first, second = (
        rate_signal(
            replace(EXACT, seed=seed, arm_mm=arm_mm).record(HandMotion(seed=7)), Motion.ROTATION, LIMITS
        )
        for seed, arm_mm in ((1, (0.0, 0.0, 0.0)), (5, (0.0, -120.0, 30.0)))
    )
    lengths = [np.linalg.norm(signal.at(times_s), axis=1) for signal in (first, second)]
    np.testing.assert_allclose(lengths[0], lengths[1], rtol=1e-9)


def test_a_gap_has_no_rate_and_one_missed_image_has() -> None:
    source = replace(EXACT, gaps_s=((3.0, 3.3), (6.01, 6.04)))
    signal = rate_signal(source.record(HandMotion(seed=7)), Motion.ROTATION, LIMITS)
    assert signal.segments == 2
    assert np.isnan(signal.at(np.array([-0.1, 3.0, 3.15, 3.3, 12.1]))).all()
    assert np.isfinite(signal.at(np.array([0.1, 2.9, 3.4, 6.02, 11.8]))).all()


def test_a_stretch_of_five_poses_is_too_short_and_one_of_six_is_not() -> None:
    for poses, segments in ((5, 1), (6, 2)):
        end_s = 3.0 + (poses - 0.5) / 30.0
        source = replace(EXACT, gaps_s=((2.0, 2.99), (end_s, 4.0)))
        signal = rate_signal(source.record(HandMotion(seed=7), seconds=3.5), Motion.ROTATION, LIMITS)
        assert signal.segments == segments
