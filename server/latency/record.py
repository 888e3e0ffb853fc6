"""Record of a measured latency, of one camera and one screen."""

from collections.abc import Mapping
from dataclasses import dataclass

from tracker.navigation import MeasuredLatency


@dataclass(frozen=True, slots=True, kw_only=True)
class LatencyReport:
    """Latency from exposure to display, with its basis.

    It includes the delay of the screen once, and half an image period, by which a code that appears between
    two images is captured late on average.

    Attributes:
        samples: Number of timed codes.
        median_ms, p99_ms: Time from the painting of a code to the first image on the page that shows it or a
            later code.
        stage_ms: Median of each stage; they need not add up to the median of the total.
        image_period_ms: Median time between two images, the resolution of one sample.
        late_on_average_ms: Half the image period.
        clock_error_ms: Bound of the clock error; it shifts time between the stages but not their sum.
        images: Number of images shown on the page.
        read_images: Number of these images with a code.
        skipped_images: Number of images in between that were not shown.
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
        width_px, height_px: Size in pixels of the page.
        period_ms: Refresh period.
    """

    width_px: int
    height_px: int
    period_ms: float


@dataclass(frozen=True, slots=True, kw_only=True)
class LatencyResult:
    """A report with its camera and screen.

    Attributes:
        at: UTC, ISO 8601.
        made_by: Person who measured.
        camera: Name of the image source.
        width_px, height_px: Size of its images.
        rate_hz: Images per second on the page during the measurement.
        screen: Screen that showed the codes.
        report: The measured latency.
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
        """Return the values from which the lag of a moving tip is computed."""
        return MeasuredLatency(
            p99_ms=self.report.p99_ms,
            size_wh_px=(self.width_px, self.height_px),
            image_period_ms=self.report.image_period_ms,
        )
