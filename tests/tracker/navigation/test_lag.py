"""Lag of a displayed tip: speed times latency, zero at rest."""

from math import isnan

import numpy as np
import pytest

from tracker.navigation import Lag
from tracker.navigation.lag import MIN_IMAGES, TipSpeedEstimator

RATE_HZ = 30.0


def speeds(
    *, mm_s: float, noise_mm: float, rate_hz: float = RATE_HZ, images: int = 60, seed: int = 1
) -> list[float]:
    """Results for a tip in uniform motion, seen with this noise."""
    random, tip = np.random.default_rng(seed), TipSpeedEstimator()
    direction = np.array([0.6, 0.0, 0.8])
    said = []
    for number in range(images):
        at_s = number / rate_hz
        place_mm = direction * mm_s * at_s + noise_mm * random.standard_normal(3)
        said.append(tip.take(place_mm, at_s=at_s))
    return said


@pytest.mark.parametrize(("mm_s", "noise_mm"), [(5.0, 0.02), (40.0, 0.05), (300.0, 0.3)])
@pytest.mark.parametrize("rate_hz", [10.0, 30.0, 60.0])
def test_a_moving_tip_has_at_least_its_speed_and_hardly_more(
    mm_s: float, noise_mm: float, rate_hz: float
) -> None:
    said = speeds(mm_s=mm_s, noise_mm=noise_mm, rate_hz=rate_hz)[MIN_IMAGES:]
    assert float(np.mean(np.array(said) >= mm_s)) > 0.9
    assert float(np.median(said)) < 1.2 * mm_s + 0.5


@pytest.mark.parametrize("noise_mm", [0.0, 0.02, 0.3])
def test_a_tip_at_rest_has_no_speed(noise_mm: float) -> None:
    said = [one for seed in range(20) for one in speeds(mm_s=0.0, noise_mm=noise_mm, seed=seed)]
    assert np.mean([one > 0.0 for one in said]) < 0.002


def test_until_five_images_are_known_there_is_no_speed_and_none_across_a_gap() -> None:
    said = speeds(mm_s=40.0, noise_mm=0.02)
    assert [isnan(one) for one in said[: MIN_IMAGES + 1]] == [True] * (MIN_IMAGES - 1) + [False] * 2
    tip = TipSpeedEstimator()
    for number in range(8):
        tip.take(np.array([number * 1.0, 0.0, 0.0]), at_s=number / RATE_HZ)
    assert isnan(tip.take(np.array([200.0, 0.0, 0.0]), at_s=3.0))
    # A repeated image, and a clock that was set back, also reset it.
    assert isnan(tip.take(np.array([201.0, 0.0, 0.0]), at_s=3.0))


def test_a_camera_that_is_too_slow_for_a_speed_has_none() -> None:
    assert all(isnan(one) for one in speeds(mm_s=40.0, noise_mm=0.02, rate_hz=4.0))


@pytest.mark.parametrize(
    ("speed_mm_s", "latency_ms", "margin_mm"),
    [(40.0, 95.0, 3.8), (41.0, 95.0, 3.9), (0.0, 95.0, 0.0), (0.0, None, 0.0), (1.2, 50.0, 0.1)],
)
def test_the_margin_is_speed_times_latency_rounded_up(
    speed_mm_s: float, latency_ms: float | None, margin_mm: float
) -> None:
    assert Lag.of(speed_mm_s, latency_ms).margin_mm == margin_mm


def test_of_a_moving_tip_without_a_measured_latency_no_margin_is_claimed() -> None:
    for lag in (Lag.of(40.0, None), Lag.of(float("nan"), 95.0)):
        assert isnan(lag.margin_mm)
