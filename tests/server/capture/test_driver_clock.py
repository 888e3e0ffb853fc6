"""The driver's capture time is used while it is plausible."""

import pytest

from server.capture.driver_clock import GIVEN_UP_AFTER, MAX_AGE_S, DriverClock
from server.live import ImageClock

PERIOD_S = 1 / 30


def warm(clock: DriverClock, *, images: int = 60, latency_s: float = 0.04) -> float:
    """Feed this many plausible images; return the arrival of the last one."""
    for number in range(images):
        arrived_s = 100.0 + number * PERIOD_S
        assert clock.captured_at_s(arrived_s - latency_s, arrived_s=arrived_s) == pytest.approx(
            arrived_s - latency_s
        )
        assert clock.clock is ImageClock.DRIVER
    return arrived_s


@pytest.mark.parametrize(
    ("driver_s", "why"),
    [
        (0.0, "says nothing"),
        (-3.0, "before all time"),
        (100.5, "in the future"),
        (100.0 - MAX_AGE_S - 0.1, "too old for a camera that nothing is known of"),
        (1.7e9, "the wall clock's"),
    ],
)
def test_an_implausible_time_is_replaced_by_the_arrival(driver_s: float, why: str) -> None:
    clock = DriverClock()
    assert clock.captured_at_s(driver_s, arrived_s=100.0) == 100.0, why
    assert clock.clock is ImageClock.ARRIVAL


def test_a_time_not_after_the_last_one_is_replaced() -> None:
    clock = DriverClock()
    last_s = warm(clock)
    again_s = last_s - 0.04
    assert clock.captured_at_s(again_s, arrived_s=last_s + PERIOD_S) == last_s + PERIOD_S
    clocks = [clock.clock]
    # The next one has the driver's time again, and is still later than the one before.
    after_s = clock.captured_at_s(last_s + 0.02, arrived_s=last_s + 2 * PERIOD_S)
    clocks.append(clock.clock)
    assert clocks == [ImageClock.ARRIVAL, ImageClock.DRIVER]
    assert after_s > last_s + PERIOD_S
    assert not clock.gave_up


def test_a_little_ahead_is_the_arrival_itself() -> None:
    clock = DriverClock()
    assert clock.captured_at_s(100.003, arrived_s=100.0) == 100.0
    assert clock.clock is ImageClock.DRIVER


def test_an_image_that_waited_in_a_buffer_is_old_and_not_new() -> None:
    clock = DriverClock()
    last_s = warm(clock)
    taken_s = last_s + 0.01
    # The machine was suspended for five seconds; the buffer still contains earlier images.
    assert clock.captured_at_s(taken_s, arrived_s=last_s + 5.0) == taken_s
    assert clock.clock is ImageClock.DRIVER
    assert not clock.gave_up


def test_a_clock_that_is_often_implausible_is_given_up_for_good() -> None:
    clock = DriverClock()
    warm(clock)
    for number in range(GIVEN_UP_AFTER):
        assert not clock.gave_up
        arrived_s = 200.0 + number * PERIOD_S
        clock.captured_at_s(50.0 - number, arrived_s=arrived_s)
    assert clock.gave_up
    for number in range(100):
        arrived_s = 300.0 + number * PERIOD_S
        assert clock.captured_at_s(arrived_s - 0.04, arrived_s=arrived_s) == arrived_s
    assert clock.gave_up
    assert clock.clock is ImageClock.ARRIVAL


def test_a_clock_that_drifts_into_the_past_is_given_up() -> None:
    clock = DriverClock()
    last_s = warm(clock)
    for number in range(GIVEN_UP_AFTER):
        clock.captured_at_s(last_s + 0.001 * (number + 1), arrived_s=last_s + 10.0 + number)
    assert clock.gave_up


def test_a_few_implausible_times_are_forgotten() -> None:
    clock = DriverClock()
    for number in range(40 * GIVEN_UP_AFTER):
        arrived_s = 100.0 + number * PERIOD_S
        clock.captured_at_s(0.0 if number % 4 == 0 else arrived_s - 0.04, arrived_s=arrived_s)
    assert not clock.gave_up


def test_a_device_that_was_opened_again_may_begin_at_another_time() -> None:
    clock = DriverClock()
    last_s = warm(clock)
    clock.restart()
    assert clock.captured_at_s(last_s - 0.05, arrived_s=last_s) > last_s - 0.04
    assert clock.clock is ImageClock.DRIVER
