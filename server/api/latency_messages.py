"""Messages of the latency measurement."""

from typing import Annotated, TypeAlias

from pydantic import Field

from server.api.requester import MadeBy
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
    """Codes that the page has to show."""

    cells: int
    """Cells per side, without the black border of one cell."""
    patterns: list[str]
    """The cells of each code, row by row from the top left: 1 is white. Shown cyclically in this order."""
    codes: int
    """Number of codes to show after the first one was read."""
    min_code_ms: float
    """Minimum random duration of a code."""
    max_code_ms: float
    """Maximum random duration of a code."""
    min_timed: int
    """Minimum number of timed codes."""


class LatencyReadingMessage(Message):
    """Progress of the reading; it ends after 5 s without a request."""

    running: bool
    examined_images: int
    read_images: int
    """Images in which a code was read."""
    server_s: float
    """Monotonic clock of the server at the response, for clock synchronisation."""
    problem: ProblemMessage | None
    """Why reading ended."""


class PaintedCodeMessage(Message):
    """A displayed code."""

    code: Annotated[int, Field(ge=0, le=249)]
    painted_at_ms: PageMs


class ShownImageMessage(Message):
    """A displayed image."""

    image_number: Annotated[int, Field(ge=0, le=2**53)]
    sent_at_s: ServerS
    """From its message."""
    received_at_ms: PageMs
    shown_at_ms: PageMs


class ClockComparisonMessage(Message):
    """A round trip with the server time in the response (as in NTP)."""

    requested_at_ms: PageMs
    responded_at_ms: PageMs
    server_s: ServerS


class LatencyScreenMessage(Message):
    """The screen with the codes."""

    width_px: Annotated[int, Field(ge=1, le=100_000)]
    height_px: Annotated[int, Field(ge=1, le=100_000)]
    period_ms: Annotated[float, Field(gt=0.0, le=1000.0, allow_inf_nan=False)]
    """Refresh period of the screen."""


class LatencyConclusionRequest(Message):
    """Events recorded by the page with its own clock, in order."""

    made_by: MadeBy
    painted: Annotated[list[PaintedCodeMessage], Field(max_length=MAX_CODES)]
    shown: Annotated[list[ShownImageMessage], Field(max_length=MAX_IMAGES)]
    comparisons: Annotated[list[ClockComparisonMessage], Field(min_length=1, max_length=MAX_COMPARISONS)]
    screen: LatencyScreenMessage


class LatencyReportMessage(Message):
    """Latency from exposure to display; includes the delay of the screen once."""

    samples: int
    """Number of timed codes."""
    median_ms: float
    p99_ms: float
    stage_ms: dict[str, float]
    """Median of each stage; they need not add up to the median of the total."""
    image_period_ms: float
    """The resolution of one sample."""
    late_on_average_ms: float
    """Half the image period: average delay until a code is captured, included in the latency."""
    clock_error_ms: float
    """Bound of the clock error; it shifts time between the stages but not their sum."""
    images: int
    read_images: int
    skipped_images: int


class LatencyResultMessage(Message):
    """A latency measurement with its camera and screen."""

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
    """State of the latency measurement."""

    measuring: bool
    result: LatencyResultMessage | None
    """The newest result of this camera; null if never measured."""
    applies: bool
    """Whether the result is valid for the present images: they have the same size and at least the same rate.
    False without a result, true while there are no images."""


def codes_message(measurement: LatencyMeasurement) -> LatencyCodesMessage:
    """Return the codes to show."""
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
    """Return the progress at monotonic time `now_s`."""
    status = measurement.status()
    return LatencyReadingMessage(
        running=status.running,
        examined_images=status.examined_images,
        read_images=status.read_images,
        server_s=now_s,
        problem=problem_message(status.problem),
    )


def page_times(requested: LatencyConclusionRequest) -> PageTimes:
    """Return the events of the page."""
    return PageTimes(
        painted=[PaintedCode(**one.model_dump()) for one in requested.painted],
        shown=[ShownImage(**one.model_dump()) for one in requested.shown],
        comparisons=[ClockComparison(**one.model_dump()) for one in requested.comparisons],
        screen=Screen(**requested.screen.model_dump()),
    )


def result_message(result: LatencyResult) -> LatencyResultMessage:
    """Return the message of a result."""
    return LatencyResultMessage.model_validate(result, from_attributes=True)
