"""What is asked and answered about the latency from light to page."""

from typing import Annotated, TypeAlias

from pydantic import Field

from server.api.doing import MadeBy
from server.latency import (
    CELLS,
    ClockComparison,
    LatencyResult,
    PaintedCode,
    Screen,
    ShownImage,
    code_patterns,
)
from server.procedure.latency import LatencyMeasurement, PageTimes
from server.stream.messages import Message, ProblemMessage, problem_message

# Half a day of the page's clock, and years of the server's.
PageMs: TypeAlias = Annotated[float, Field(ge=0.0, le=1e12, allow_inf_nan=False)]
ServerS: TypeAlias = Annotated[float, Field(ge=0.0, le=1e12, allow_inf_nan=False)]
MAX_CODES = 1000
MAX_IMAGES = 8000
MAX_COMPARISONS = 1000


class LatencyCodesRequest(Message):
    """How many codes to show."""

    codes: Annotated[int, Field(ge=20, le=240)] = 160


class LatencyCodesMessage(Message):
    """What the page is to show, once the camera looks at the screen."""

    cells: int
    """Cells along a side, without the black border, which is one cell wide."""
    patterns: list[str]
    """The cells of each code, row by row from the top left: 1 is white. Shown in this order, again and
    again."""
    codes: int
    """How many to paint after the first has been read."""
    min_code_ms: float
    """Each stands for a random time between this ..."""
    max_code_ms: float
    """... and this."""
    min_timed: int
    """How many must be timed."""


class LatencyReadingMessage(Message):
    """How reading goes; a page that does not ask for 5 s has left."""

    running: bool
    looked_images: int
    read_images: int
    """In how many of them a code was read."""
    server_s: float
    """Monotonic clock of the server as it answers, to compare the page's with."""
    problem: ProblemMessage | None
    """Why reading ended."""


class PaintedCodeMessage(Message):
    """A code on the screen."""

    code: Annotated[int, Field(ge=0, le=249)]
    painted_at_ms: PageMs


class ShownImageMessage(Message):
    """An image on the page."""

    image_number: Annotated[int, Field(ge=0, le=2**53)]
    sent_at_s: ServerS
    """As its message says."""
    received_at_ms: PageMs
    shown_at_ms: PageMs


class ClockComparisonMessage(Message):
    """A question with the server's time in its answer."""

    asked_at_ms: PageMs
    answered_at_ms: PageMs
    server_s: ServerS


class LatencyScreenMessage(Message):
    """The screen that showed the codes."""

    width_px: Annotated[int, Field(ge=1, le=100_000)]
    height_px: Annotated[int, Field(ge=1, le=100_000)]
    period_ms: Annotated[float, Field(gt=0.0, le=1000.0, allow_inf_nan=False)]
    """From one screen image to the next."""


class LatencyConclusionRequest(Message):
    """What the page saw, by its own clock, in the order in which it did."""

    made_by: MadeBy
    painted: Annotated[list[PaintedCodeMessage], Field(max_length=MAX_CODES)]
    shown: Annotated[list[ShownImageMessage], Field(max_length=MAX_IMAGES)]
    comparisons: Annotated[list[ClockComparisonMessage], Field(min_length=1, max_length=MAX_COMPARISONS)]
    screen: LatencyScreenMessage


class LatencyReportMessage(Message):
    """Latency from light to page. The screen's own delay is in it once."""

    samples: int
    """How many codes were timed."""
    median_ms: float
    p99_ms: float
    stage_ms: dict[str, float]
    """Median of each stage; they need not add up to the median of the whole."""
    image_period_ms: float
    """The resolution of one sample."""
    late_on_average_ms: float
    """Half of it: so much later than it appeared a code is seen on average; that is in the latency."""
    clock_error_ms: float
    """By how much the clocks may be off: it moves time between the stages, and leaves their sum."""
    images: int
    read_images: int
    skipped_images: int


class LatencyResultMessage(Message):
    """A measured latency with what it belongs to."""

    at: str
    """UTC, ISO 8601."""
    made_by: str
    camera: str
    width_px: int
    height_px: int
    rate_hz: float
    screen: LatencyScreenMessage
    report: LatencyReportMessage


class LatencyMessage(Message):
    """What is known of the latency."""

    measuring: bool
    result: LatencyResultMessage | None
    """The newest of this camera; null where it was never measured."""


def codes_message(measurement: LatencyMeasurement) -> LatencyCodesMessage:
    """What the page is to show."""
    plan = measurement.plan
    return LatencyCodesMessage(
        cells=CELLS,
        patterns=list(code_patterns()),
        codes=plan.codes,
        min_code_ms=plan.min_code_ms,
        max_code_ms=plan.max_code_ms,
        min_timed=plan.min_timed,
    )


def reading_message(measurement: LatencyMeasurement, *, now_s: float) -> LatencyReadingMessage:
    """How reading goes, as answered at monotonic time `now_s`."""
    status = measurement.status()
    return LatencyReadingMessage(
        running=status.running,
        looked_images=status.looked_images,
        read_images=status.read_images,
        server_s=now_s,
        problem=problem_message(status.problem),
    )


def page_times(asked: LatencyConclusionRequest) -> PageTimes:
    """What the page saw."""
    return PageTimes(
        painted=[PaintedCode(**one.model_dump()) for one in asked.painted],
        shown=[ShownImage(**one.model_dump()) for one in asked.shown],
        comparisons=[ClockComparison(**one.model_dump()) for one in asked.comparisons],
        screen=Screen(**asked.screen.model_dump()),
    )


def result_message(result: LatencyResult) -> LatencyResultMessage:
    """A result as it is told."""
    return LatencyResultMessage.model_validate(result, from_attributes=True)
