"""Record of a measured latency, of one camera and one screen."""

from collections.abc import Mapping
from dataclasses import dataclass

from tracker.navigation import MeasuredLatency


@dataclass(frozen=True, slots=True, kw_only=True)
class LatencyReport:
    """Latency from light to page, with what it rests on.

    The screen's own delay is in it once. A code that appears between two images is seen half an image period
    late on average; that is in it, too.

    Attributes:
        samples: how many codes were timed.
        median_ms, p99_ms: from the painting of a code to the first image on the page that shows it, or a
            later one.
        stage_ms: median of each stage; medians of parts need not add up to the median of the whole.
        image_period_ms: median time between two images, the resolution of one sample.
        late_on_average_ms: half of that.
        clock_error_ms: by how much page and server clock may be off; it moves time between the stages, and
            leaves their sum as it is.
        images: how many were shown on the page.
        read_images: how many of them showed a code.
        skipped_images: how many were not shown in between.
    """

    samples: int
    median_ms: float
    p99_ms: float
    stage_ms: Mapping[str, float]
    image_period_ms: float
    late_on_average_ms: float
    clock_error_ms: float
    images: int
    read_images: int
    skipped_images: int


@dataclass(frozen=True, slots=True, kw_only=True)
class Screen:
    """The screen that showed the codes.

    Attributes:
        width_px, height_px: in pixels of the page.
        period_ms: from one screen image to the next.
    """

    width_px: int
    height_px: int
    period_ms: float


@dataclass(frozen=True, slots=True, kw_only=True)
class LatencyResult:
    """A report with what it belongs to.

    Attributes:
        at: UTC, ISO 8601.
        made_by: who measured.
        camera: the source of the images, in words.
        width_px, height_px: of its images.
        rate_hz: images a second on the page while it was measured.
        screen: that showed the codes.
        report: what was measured.
    """

    at: str
    made_by: str
    camera: str
    width_px: int
    height_px: int
    rate_hz: float
    screen: Screen
    report: LatencyReport

    @property
    def measured(self) -> MeasuredLatency:
        """What the lag of a moving tip depends on."""
        return MeasuredLatency(
            p99_ms=self.report.p99_ms,
            size_wh_px=(self.width_px, self.height_px),
            image_period_ms=self.report.image_period_ms,
        )
