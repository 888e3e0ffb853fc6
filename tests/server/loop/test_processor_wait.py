"""Waiting for a processor is told from sleeping and from computing."""

import os
from pathlib import Path

import pytest

from server.loop.processor_wait import ProcessorWait, ThreadTimes, Times, thread_times


def times(run_s: float, waited_s: float, *, is_runnable: bool = True) -> ThreadTimes:
    return ThreadTimes(run_s=run_s, waited_s=waited_s, is_runnable=is_runnable)


@pytest.mark.parametrize(
    ("before", "now", "waited_s"),
    [
        pytest.param({1: times(2, 3)}, {1: times(2.1, 3.9)}, 0.9, id="it got a processor for a tenth"),
        pytest.param({1: times(2, 3)}, {1: times(2, 3)}, 1, id="it got none at all"),
        pytest.param({1: times(2, 3)}, {1: times(3, 3)}, 0, id="it computed all the time"),
        pytest.param(
            {1: times(2, 3, is_runnable=False)}, {1: times(2, 3, is_runnable=False)}, 0, id="it slept"
        ),
        pytest.param({1: times(2, 3)}, {1: times(2, 3, is_runnable=False)}, 0, id="it fell asleep"),
        pytest.param(
            {1: times(2, 3, is_runnable=False), 2: times(0, 0)},
            {1: times(2, 3, is_runnable=False), 2: times(0.25, 0.75)},
            0.75,
            id="it slept while another thread waited",
        ),
        pytest.param({1: times(2, 3)}, {7: times(2, 9)}, 0, id="a new thread"),
        pytest.param({1: times(2, 3)}, {1: times(2, 9)}, 1, id="never more than has passed"),
        pytest.param({}, {}, 0, id="the system does not provide it"),
    ],
)
def test_the_time_waited_in_a_second(before: Times, now: Times, waited_s: float) -> None:
    readings = [before, now]
    wait = ProcessorWait(1, read=lambda _pid: readings.pop(0))
    assert wait.since_last(1.0) == pytest.approx(waited_s)


@pytest.mark.skipif(not Path("/proc/self/schedstat").exists(), reason="needs the scheduler's statistics")
def test_the_times_of_this_process_are_read() -> None:
    before = thread_times(os.getpid())
    sum(range(1_000_000))
    after = thread_times(os.getpid())
    main = os.getpid()
    assert after[main].is_runnable
    assert after[main].run_s > before[main].run_s > 0


def test_a_process_that_is_gone_has_no_times() -> None:
    assert thread_times(2**22 + 1) == {}
