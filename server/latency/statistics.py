"""Latency from the times at which codes were painted, captured and shown. Pure functions."""

from collections.abc import Mapping, Sequence
from dataclasses import dataclass
from enum import StrEnum

import numpy as np

from server.latency.clocks import ClockComparison, ServerClock
from server.latency.record import LatencyReport
from tracker.errors import CalibrationError

# All codes are painted once within 25 s, so that an older painting of the same number is excluded.
MAX_LATENCY_MS = 5000.0
# Between two read codes one image may show a mixture of both; more make the start of the second one unknown.
MAX_UNREAD_IMAGES = 1
# Fraction of the images from the first to the last. Above it, the resolution is worse than an image period.
MAX_SKIPPED_RATIO = 0.1
# Fraction of the images on the page. Below it, the camera does not see the code.
MIN_READ_RATIO = 0.5
AIM = "Point the camera at the screen, darken the room, or move closer until the code is large."


class Stage(StrEnum):
    """Stages of the latency, in order."""

    SCREEN_AND_CAMERA = "screen and camera"  # painted -> stamped as captured
    TRACKING = "tracking"  # captured -> tracked
    SERVER = "server"  # tracked -> sent
    LINE = "line"  # sent -> received
    PAGE = "page"  # received -> painted


@dataclass(frozen=True, slots=True, kw_only=True)
class PaintedCode:
    """A code on the screen.

    Attributes:
        code: Its number.
        painted_at_ms: Page time of the screen refresh with which it appeared.
    """

    code: int
    painted_at_ms: float


@dataclass(frozen=True, slots=True, kw_only=True)
class ReadImage:
    """An image that the server searched for a code.

    Attributes:
        image_number: Number of the image.
        captured_at_s, concluded_at_s: Monotonic times of the server.
        code: Number of the code; None if none was read.
    """

    image_number: int
    captured_at_s: float
    concluded_at_s: float
    code: int | None


@dataclass(frozen=True, slots=True, kw_only=True)
class ShownImage:
    """An image that was shown on the page.

    Attributes:
        image_number: Number of the image.
        sent_at_s: Monotonic time of the server.
        received_at_ms, shown_at_ms: Times by the page's clock.
    """

    image_number: int
    sent_at_s: float
    received_at_ms: float
    shown_at_ms: float


@dataclass(frozen=True, slots=True, kw_only=True)
class _Sample:
    painted: PaintedCode
    read: ReadImage
    shown: ShownImage

    @property
    def latency_ms(self) -> float:
        return self.shown.shown_at_ms - self.painted.painted_at_ms

    def stage_ms(self, clock: ServerClock) -> Mapping[Stage, float]:
        captured_ms = clock.page_ms(self.read.captured_at_s)
        concluded_ms = clock.page_ms(self.read.concluded_at_s)
        sent_ms = clock.page_ms(self.shown.sent_at_s)
        return {
            Stage.SCREEN_AND_CAMERA: captured_ms - self.painted.painted_at_ms,
            Stage.TRACKING: concluded_ms - captured_ms,
            Stage.SERVER: sent_ms - concluded_ms,
            Stage.LINE: self.shown.received_at_ms - sent_ms,
            Stage.PAGE: self.shown.shown_at_ms - self.shown.received_at_ms,
        }


def latency_report(
    *,
    painted: Sequence[PaintedCode],
    read: Sequence[ReadImage],
    shown: Sequence[ShownImage],
    comparisons: Sequence[ClockComparison],
    min_timed: int,
) -> LatencyReport:
    """Compute median, 99th percentile and stages of the latency from painted codes to displayed images.

    Each code is timed by the first image on the page that shows it or a later code, so that a skipped image
    delays the codes of its period instead of hiding them.

    Args:
        painted: Codes in the order of painting.
        read: Images read by the server, in any order.
        shown: Displayed images in order.
        comparisons: Comparisons of both clocks; at least one.
        min_timed: Minimum number of timed codes.

    Raises:
        CalibrationError: LATENCY_CODE_NOT_READ, LATENCY_IMAGES_SKIPPED.
    """
    images_by_number = {one.image_number: one for one in read}
    once = _first_shown(shown)
    read_images = sum(
        one.image_number in images_by_number and images_by_number[one.image_number].code is not None
        for one in once
    )
    if read_images < MIN_READ_RATIO * max(len(once), 1):
        raise _code_not_read(f"the code was read in {read_images} of {len(once)} images", min_timed)
    skipped = _count_skipped(once, images_by_number)
    samples = _samples(painted, once, images_by_number)
    if len(samples) < min_timed:
        raise _code_not_read(f"{len(samples)} of {len(painted)} codes could be timed", min_timed)
    clock = ServerClock.of(comparisons)
    latency_ms = np.array([one.latency_ms for one in samples])
    stages = [one.stage_ms(clock) for one in samples]
    period_ms = _image_period_ms(once, images_by_number)
    return LatencyReport(
        samples=len(samples),
        median_ms=_rounded(np.median(latency_ms)),
        # Not interpolated between two samples: the larger one is used.
        p99_ms=_rounded(np.percentile(latency_ms, 99.0, method="higher")),
        stage_ms={stage.value: _rounded(np.median([one[stage] for one in stages])) for stage in Stage},
        image_period_ms=_rounded(period_ms),
        late_on_average_ms=_rounded(period_ms / 2.0),
        clock_error_ms=_rounded(clock.error_ms),
        images=len(once),
        read_images=read_images,
        skipped_images=skipped,
    )


def _first_shown(shown: Sequence[ShownImage]) -> tuple[ShownImage, ...]:
    """Return the first display of each image; an alarm between two images is sent with the previous image."""
    first: dict[int, ShownImage] = {}
    for one in shown:
        first.setdefault(one.image_number, one)
    return tuple(first.values())


def _samples(
    painted: Sequence[PaintedCode], shown: Sequence[ShownImage], read: Mapping[int, ReadImage]
) -> list[_Sample]:
    """Return each painted code with the first image that shows it or a later code."""
    samples: list[_Sample] = []
    last: int | None = None
    unread = 0
    for image in shown:
        reading = read.get(image.image_number)
        place = None if reading is None else _place_of(reading.code, painted, image.shown_at_ms)
        if reading is None or place is None or (last is not None and place < last):
            unread += 1
            continue
        # The first code is not timed, because it may have been shown before it was in view of the camera.
        if last is not None and unread <= MAX_UNREAD_IMAGES:
            samples += [
                _Sample(painted=one, read=reading, shown=image) for one in painted[last + 1 : place + 1]
            ]
        last, unread = place, 0
    return samples


def _place_of(code: int | None, painted: Sequence[PaintedCode], shown_at_ms: float) -> int | None:
    """Return the index of the newest painting of this code before the image; None without one."""
    if code is None:
        return None
    for place in range(len(painted) - 1, -1, -1):
        one = painted[place]
        since_ms = shown_at_ms - one.painted_at_ms
        if since_ms > MAX_LATENCY_MS:
            return None
        if one.code == code and since_ms >= 0.0:
            return place
    return None


def _count_skipped(shown: Sequence[ShownImage], read: Mapping[int, ReadImage]) -> int:
    """Return the number of skipped images.

    Raises:
        CalibrationError: LATENCY_IMAGES_SKIPPED.
    """
    numbers = [one.image_number for one in shown]
    given = max(numbers) - min(numbers) + 1 if numbers else 0
    skipped = given - len(numbers)
    unlooked = sum(number not in read for number in numbers)
    allowed = int(MAX_SKIPPED_RATIO * given)
    if max(skipped, unlooked) <= allowed:
        return skipped
    what = (
        f"{skipped} of {given} images were not shown on this page"
        if skipped > allowed
        else f"{unlooked} of {len(numbers)} images on this page were not searched for a code"
    )
    raise CalibrationError(
        "LATENCY_IMAGES_SKIPPED",
        f"{what}, the maximum is {allowed}",
        "Close other pages, select a smaller picture or lower camera.rate_hz, and measure again.",
        {
            "skip_phrase": what,
            "skipped_images": skipped,
            "unprocessed_images": unlooked,
            "shown_images": len(numbers),
            "images": given,
            "max_images": allowed,
        },
    )


def _code_not_read(what: str, min_timed: int) -> CalibrationError:
    return CalibrationError(
        "LATENCY_CODE_NOT_READ",
        f"{what}, the minimum is {min_timed}",
        AIM,
        {"min_timed": min_timed, "code_count": what},
    )


def _image_period_ms(shown: Sequence[ShownImage], read: Mapping[int, ReadImage]) -> float:
    """Return the median time between the captures of two successive images on the page."""
    captured_s = [read[one.image_number].captured_at_s for one in shown if one.image_number in read]
    return float(np.median(np.diff(captured_s))) * 1000.0 if len(captured_s) > 1 else 0.0


def _rounded(value_ms: float | np.floating) -> float:
    return round(float(value_ms), 1)
