"""Prometheus metrics, collected from the published instants.

The endpoint requires a session, also on loopback, because behind a proxy every client comes from loopback.
"""

import time
from collections.abc import Iterable

from fastapi import APIRouter, Response
from prometheus_client import CollectorRegistry, Counter, Histogram, generate_latest
from prometheus_client.core import CounterMetricFamily, GaugeMetricFamily, Metric
from prometheus_client.exposition import CONTENT_TYPE_PLAIN_0_0_4
from prometheus_client.registry import Collector

from server.live import Instant, LiveHub, ProcessState, SourceState
from server.stream.scaling.picture_cache import PictureCache
from server.stream.scaling.sizes import PictureSize
from server.stream.viewers import ViewerKind, Viewers
from tracker.pose import Seen

STAGE_BUCKETS_S = (0.0005, 0.001, 0.002, 0.004, 0.006, 0.01, 0.015, 0.025, 0.05, 0.1, 0.25, 1.0)


class Metrics:
    """Metrics of one application in their own registry.

    Counters of source and process are exported as reported, so that skipped instants lose nothing. Stages and
    markers are counted once per received image.
    """

    def __init__(self, *, hub: LiveHub, viewers: Viewers, pictures: PictureCache) -> None:
        self.registry = CollectorRegistry()
        self._hub = hub
        self._captured_at_s: float | None = None
        self._stages = Histogram(
            "coaxial_stage_seconds",
            "Time of each stage for one image, by its name in the code.",
            ["stage"],
            buckets=STAGE_BUCKETS_S,
            registry=self.registry,
        )
        self._seen = Counter(
            "coaxial_marker_seen",
            "Images in which the marker was found.",
            ["marker"],
            registry=self.registry,
        )
        self._unseen = Counter(
            "coaxial_marker_unseen",
            "Images in which the marker was not found, by reason.",
            ["marker", "reason"],
            registry=self.registry,
        )
        self.registry.register(_Now(hub, viewers, pictures))
        pictures.observe_stage = self._observe_stage

    def _observe_stage(self, stage: str, spent_s: float) -> None:
        self._stages.labels(stage).observe(spent_s)

    async def follow(self) -> None:
        """Count instants until cancelled."""
        sequence = -1
        while True:
            instant = await self._hub.next_after(sequence)
            sequence = instant.sequence
            self.count(instant)

    def count(self, instant: Instant) -> None:
        """Count the image of this instant, unless an earlier instant contained it."""
        snapshot = instant.snapshot
        if snapshot is None or snapshot.captured_at_s == self._captured_at_s:
            return
        self._captured_at_s = snapshot.captured_at_s
        for stage, spent_ms in snapshot.stage_ms.items():
            self._observe_stage(stage, spent_ms / 1000.0)
        for marker, sighting in snapshot.sightings.items():
            if isinstance(sighting, Seen):
                self._seen.labels(marker).inc()
            else:
                self._unseen.labels(marker, sighting.reason.value).inc()


class _Now(Collector):
    """Collector of values that are read at scrape time."""

    def __init__(self, hub: LiveHub, viewers: Viewers, pictures: PictureCache) -> None:
        self._hub = hub
        self._viewers = viewers
        self._pictures = pictures

    def collect(self) -> Iterable[Metric]:
        yield from _viewer_metrics(self._viewers)
        encoded = CounterMetricFamily(
            "coaxial_pictures_encoded",
            "Images encoded for viewers, by size.",
            labels=["size"],
        )
        for size in PictureSize:
            encoded.add_metric([size.value], self._pictures.encoded[size])
        yield encoded
        instant = self._hub.newest
        if instant is not None:
            yield from _instant_metrics(instant, now_s=time.monotonic())


def _viewer_metrics(viewers: Viewers) -> Iterable[Metric]:
    watching = GaugeMetricFamily("coaxial_viewers", "Viewers connected now, by kind.", labels=["kind"])
    dropped = CounterMetricFamily(
        "coaxial_viewer_dropped", "Instants skipped by slow viewers.", labels=["kind"]
    )
    let_go = CounterMetricFamily(
        "coaxial_viewer_let_go", "Viewers disconnected because sending to them timed out.", labels=["kind"]
    )
    for kind in ViewerKind:
        watching.add_metric([kind.value], viewers.count(kind))
        dropped.add_metric([kind.value], viewers.dropped(kind))
        let_go.add_metric([kind.value], viewers.disconnected(kind))
    return watching, dropped, let_go


def _instant_metrics(instant: Instant, *, now_s: float) -> Iterable[Metric]:
    source, process = instant.source, instant.process
    yield CounterMetricFamily("coaxial_images", "Images delivered by the source.", value=source.images)
    yield CounterMetricFamily(
        "coaxial_images_skipped",
        "Images not tracked because a newer one was available.",
        value=source.skipped_images,
    )
    yield CounterMetricFamily(
        "coaxial_images_dropped",
        "Tracked images that the server was too slow to publish.",
        value=process.dropped_images,
    )
    yield GaugeMetricFamily(
        "coaxial_image_rate_hertz", "Images per second, averaged over about one second.", value=source.rate_hz
    )
    if instant.snapshot is not None:
        # Omitted without an image, because an age of 0 or of an old image would look healthy.
        age_s = now_s - instant.snapshot.captured_at_s
        yield GaugeMetricFamily("coaxial_image_age_seconds", "Age of the newest image.", value=age_s)
    yield CounterMetricFamily(
        "coaxial_tracking_restarts", "Restarts of the tracking process.", value=process.restarts
    )
    yield _one_of(
        "coaxial_tracking_process_state",
        "1 for the state of the tracking process.",
        ProcessState,
        process.state,
    )
    yield _one_of("coaxial_source_state", "1 for the state of the image source.", SourceState, source.state)


def _one_of(
    name: str, sentence: str, states: Iterable[ProcessState | SourceState], now: ProcessState | SourceState
) -> Metric:
    family = GaugeMetricFamily(name, sentence, labels=["state"])
    for state in states:
        family.add_metric([state.value], float(state is now))
    return family


def metrics_router(metrics: Metrics) -> APIRouter:
    """Return the router of `GET /metrics`."""
    router = APIRouter(tags=["health"])

    @router.get(
        "/metrics",
        response_class=Response,
        responses={200: {"content": {"text/plain": {}}, "description": "Prometheus text format."}},
    )
    async def prometheus() -> Response:
        """Return rates, stage durations, drops and viewers in the Prometheus text format."""
        return Response(
            generate_latest(metrics.registry),
            media_type=CONTENT_TYPE_PLAIN_0_0_4,
            headers={"Cache-Control": "no-store"},
        )

    return router
