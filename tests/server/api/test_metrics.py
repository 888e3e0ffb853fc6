"""The counters count each thing once."""

from collections.abc import Callable

import pytest

from server.api.metrics import Metrics
from server.live import Instant, LiveHub, ProcessState, ProcessStatus, SourceState, SourceStatus
from server.stream.scaling.picture_cache import PictureCache
from server.stream.viewers import ViewerKind, Viewers
from tracker.navigation import NavigationSnapshot

SnapshotOf = Callable[..., NavigationSnapshot]
InstantOf = Callable[..., Instant]


@pytest.fixture
def hub() -> LiveHub:
    return LiveHub()


@pytest.fixture
def viewers() -> Viewers:
    return Viewers()


@pytest.fixture
def metrics(hub: LiveHub, viewers: Viewers) -> Metrics:
    return Metrics(hub=hub, viewers=viewers, pictures=PictureCache(quality=80))


def value(metrics: Metrics, name: str, **labels: str) -> float | None:
    return metrics.registry.get_sample_value(name, labels)


def test_an_image_is_counted_once_however_often_it_is_published(
    metrics: Metrics, snapshot_of: SnapshotOf, instant_of: InstantOf
) -> None:
    first = snapshot_of(image_number=0, captured_at_s=1.0)
    metrics.count(instant_of(0, snapshot=first))
    metrics.count(instant_of(1, snapshot=first))
    metrics.count(instant_of(2))
    metrics.count(instant_of(3, snapshot=snapshot_of(image_number=1, captured_at_s=2.0, seen=False)))
    assert value(metrics, "coaxial_stage_seconds_count", stage="edges") == 2.0
    assert value(metrics, "coaxial_stage_seconds_sum", stage="edges") == pytest.approx(0.006)
    assert value(metrics, "coaxial_marker_seen_total", marker="drill") == 1.0
    assert value(metrics, "coaxial_marker_unseen_total", marker="drill", reason="SCORE_TOO_LOW") == 1.0


def test_what_the_source_and_the_process_count_is_passed_on(
    metrics: Metrics, hub: LiveHub, instant_of: InstantOf
) -> None:
    source = SourceStatus(
        name="0", state=SourceState.RECONNECTING, images=120, skipped_images=7, rate_hz=29.5
    )
    process = ProcessStatus(state=ProcessState.RESTARTING, restarts=3, dropped_images=2)
    hub.publish(instant_of(5, source=source, process=process))
    assert value(metrics, "coaxial_images_total") == 120.0
    assert value(metrics, "coaxial_images_skipped_total") == 7.0
    assert value(metrics, "coaxial_images_dropped_total") == 2.0
    assert value(metrics, "coaxial_image_rate_hertz") == 29.5
    assert value(metrics, "coaxial_tracking_restarts_total") == 3.0
    assert value(metrics, "coaxial_source_state", state="reconnecting") == 1.0
    assert value(metrics, "coaxial_source_state", state="running") == 0.0
    assert value(metrics, "coaxial_tracking_process_state", state="restarting") == 1.0
    # Without an image there is no age: neither 0 nor the last one.
    assert value(metrics, "coaxial_image_age_seconds") is None


def test_drops_stay_counted_when_the_viewer_is_gone(metrics: Metrics, viewers: Viewers) -> None:
    with viewers.register(ViewerKind.VIEW) as viewer:
        for sequence in (10, 11, 15):
            viewer.mark_taken(sequence)
        assert viewer.dropped == 3
        assert value(metrics, "coaxial_viewers", kind="view") == 1.0
    assert value(metrics, "coaxial_viewers", kind="view") == 0.0
    assert value(metrics, "coaxial_viewer_dropped_total", kind="view") == 3.0
    assert value(metrics, "coaxial_viewer_dropped_total", kind="mjpeg") == 0.0


def test_two_applications_do_not_share_counters(
    metrics: Metrics, snapshot_of: SnapshotOf, instant_of: InstantOf
) -> None:
    metrics.count(instant_of(0, snapshot=snapshot_of(captured_at_s=1.0)))
    other = Metrics(hub=LiveHub(), viewers=Viewers(), pictures=PictureCache(quality=80))
    assert value(other, "coaxial_marker_seen_total", marker="drill") is None
