"""Mapping of a device clock with unknown origin. All times are given as numbers."""

import numpy as np
import pytest

from server.capture.device_clock import WINDOW_S, DeviceClock

ZERO_S = 5000.0  # what the device's clock reads when this machine's reads 0
PERIOD_S = 1 / 30


def stamped(clock: DeviceClock, taken_s: float, delay_s: float, *, zero_s: float = ZERO_S) -> float:
    """Error of the image time, for an image taken at this time that arrives this much later."""
    return clock.monotonic_s(zero_s + taken_s, arrived_s=taken_s + delay_s) - taken_s


def test_the_jitter_of_the_way_is_taken_out_and_its_least_delay_stays() -> None:
    clock, random = DeviceClock(), np.random.default_rng(1)
    delays_s = 0.02 + random.exponential(0.03, size=600)
    errors_s = [stamped(clock, n * PERIOD_S, float(delay_s)) for n, delay_s in enumerate(delays_s)]
    # By arrival, the delays of the images would differ by 30 ms.
    assert float(np.std(delays_s)) > 0.025
    assert float(np.std(errors_s[100:])) < 0.001
    assert errors_s[-1] == pytest.approx(0.02, abs=0.002)


def test_no_image_looks_older_than_it_is_nor_younger_than_by_its_arrival() -> None:
    clock, random = DeviceClock(), np.random.default_rng(2)
    for n, delay_s in enumerate(0.02 + random.exponential(0.03, size=600)):
        assert -1e-9 <= stamped(clock, n * PERIOD_S, float(delay_s)) <= delay_s + 1e-9


def test_a_crystal_that_is_off_is_followed() -> None:
    clock = DeviceClock()
    for n in range(9000):
        taken_s = n * PERIOD_S
        at_s = clock.monotonic_s(ZERO_S + taken_s * (1.0 - 1e-4), arrived_s=taken_s + 0.02)
    # 30 ms in five minutes; only the drift within the window remains.
    assert at_s - (taken_s + 0.02) == pytest.approx(-1e-4 * WINDOW_S, abs=2e-4)


@pytest.mark.parametrize("jump_s", [-3600.0, -0.5, 1.0, 3600.0])
def test_a_reset_clock_is_detected_and_mapped_again(jump_s: float) -> None:
    clock = DeviceClock()
    for n in range(60):
        stamped(clock, n * PERIOD_S, 0.02)
    assert clock.jumps == 0
    stamped(clock, 2.0, 0.05, zero_s=ZERO_S + jump_s)
    assert clock.jumps == 1
    # Never older than it is, and within the delay of the first image after it.
    assert 0.0 <= stamped(clock, 2.0 + PERIOD_S, 0.05, zero_s=ZERO_S + jump_s) <= 0.05 + 1e-9
    assert clock.jumps == 1


def test_images_that_were_held_back_are_no_jump_and_are_old() -> None:
    clock = DeviceClock()
    for n in range(30):
        stamped(clock, n * PERIOD_S, 0.02)
    errors_s = [stamped(clock, 1.0 + n * PERIOD_S, 0.8 - n * (PERIOD_S - 0.001)) for n in range(20)]
    assert errors_s == pytest.approx([0.02] * 20)
    assert clock.jumps == 0


def test_a_stopped_clock_is_ignored() -> None:
    clock = DeviceClock()
    clock.monotonic_s(7.0, arrived_s=100.0)
    assert clock.monotonic_s(7.0, arrived_s=100.1) == 0.0


@pytest.mark.parametrize("jump_s", [-100.0, 0.2, 100.0])
def test_a_reading_of_both_clocks_leaves_no_delay_and_ends_with_a_jump(jump_s: float) -> None:
    clock = DeviceClock()
    clock.latch(ZERO_S + 3.0, monotonic_s=3.0)
    assert stamped(clock, 4.0, 0.3) == pytest.approx(0.0)
    assert clock.is_latched
    stamped(clock, 4.1, 0.02, zero_s=ZERO_S + jump_s)
    assert not clock.is_latched
