"""Correlation of vector signals in frames that are rotated against each other."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from tracker.geometry import Array
from tracker.pose.temporal_calibration.correlation import Moments, correlation_ratio

RANDOM = np.random.default_rng(5)
SIGNAL = RANDOM.normal(size=(200, 3))


def ratio(a: Array, b: Array) -> float:
    return float(correlation_ratio(Moments.of(a, b)))


def test_rotated_scaled_and_shifted_it_is_the_same_signal() -> None:
    other = 2.0 * Rotation.random(random_state=1).apply(SIGNAL) + np.array([5.0, -3.0, 8.0])
    assert ratio(SIGNAL, other) == pytest.approx(1.0, abs=1e-12)


def test_a_mirror_image_is_another_signal() -> None:
    assert ratio(SIGNAL, SIGNAL * [1.0, 1.0, -1.0]) < 0.5


def test_a_common_mean_is_no_correlation() -> None:
    mean = np.array([50.0, 0.0, 0.0])
    assert ratio(SIGNAL + mean, RANDOM.normal(size=(200, 3)) + mean) < 0.3


def test_equal_noise_leaves_the_share_of_the_signal() -> None:
    # Power 1 of signal and 0.25 of noise in each: 1 / 1.25.
    noise = RANDOM.normal(scale=0.5, size=(2, 200, 3))
    assert ratio(SIGNAL + noise[0], SIGNAL + noise[1]) == pytest.approx(0.8, abs=0.03)


def test_blocks_add_up_to_the_whole_and_leaving_one_out_is_the_rest() -> None:
    other = SIGNAL + RANDOM.normal(size=(200, 3))
    left_out = correlation_ratio(Moments.of_blocks(SIGNAL, other, 4).without_each())
    assert left_out[0] == pytest.approx(ratio(SIGNAL[50:], other[50:]), abs=1e-12)
    assert left_out[3] == pytest.approx(ratio(SIGNAL[:150], other[:150]), abs=1e-12)
