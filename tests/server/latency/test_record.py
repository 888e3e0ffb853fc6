"""The lag of a moving tip that a stored latency states."""

from server.latency import LatencyReport, LatencyResult, Screen
from tracker.navigation import MeasuredLatency


def test_the_lag_depends_on_the_99th_percentile_and_on_the_images_that_it_was_measured_with() -> None:
    report = LatencyReport(
        samples=150,
        median_ms=84.0,
        p99_ms=131.0,
        stage_ms={},
        image_period_ms=33.3,
        late_on_average_ms=16.7,
        clock_error_ms=0.5,
        images=600,
        read_images=590,
        skipped_images=0,
    )
    result = LatencyResult(
        at="2026-11-24T11:05:00Z",
        made_by="ito",
        camera="camera 0",
        width_px=1920,
        height_px=1080,
        rate_hz=30.0,
        screen=Screen(width_px=1280, height_px=800, period_ms=16.7),
        report=report,
    )
    assert result.measured == MeasuredLatency(p99_ms=131.0, size_wh_px=(1920, 1080), image_period_ms=33.3)
