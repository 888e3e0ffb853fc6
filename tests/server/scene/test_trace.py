"""The tip's trace: the last ten seconds, and nothing from before a gap."""

import numpy as np

from server.scene.trace import EVERY_S, SPAN_S, Trace


def filled(seconds: float, rate_hz: float = 30.0) -> Trace:
    trace = Trace()
    for number in range(round(seconds * rate_hz)):
        trace.take(np.array([number / rate_hz, 0.0, 0.0]), at_s=number / rate_hz)
    return trace


def test_the_last_ten_seconds_are_kept_and_no_more() -> None:
    segments = filled(25.0).segments_mm
    assert segments[-1, 1, 0] - segments[0, 0, 0] <= SPAN_S
    assert len(segments) <= SPAN_S / EVERY_S
    assert len(segments) > 0.7 * SPAN_S / EVERY_S


def test_segments_hang_together() -> None:
    segments = filled(3.0).segments_mm
    np.testing.assert_array_equal(segments[1:, 0], segments[:-1, 1])


def test_the_trace_restarts_after_a_gap() -> None:
    trace = filled(5.0)
    assert trace.take(np.array([99.0, 0.0, 0.0]), at_s=6.5)
    assert len(trace.segments_mm) == 0


def test_the_trace_restarts_when_time_runs_backwards() -> None:
    trace = filled(5.0)
    trace.take(np.zeros(3), at_s=1.0)
    assert len(trace.segments_mm) == 0
