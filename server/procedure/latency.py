"""Measurement of the latency from the scene to the page: codes are read in the live images and timed."""

import threading
import time
from collections.abc import Callable, Sequence
from dataclasses import dataclass

from server.clock import Clock, utc_now, utc_text
from server.errors import CaptureError, SetupOrderError
from server.latency import (
    ClockComparison,
    CodePlan,
    CodeReader,
    LatencyResult,
    PaintedCode,
    ReadImage,
    Screen,
    ShownImage,
    latency_report,
    plan_codes,
)
from server.live import Instant, LiveHub, Problem
from server.procedure.collecting_step import CollectingStep
from server.procedure.images_in_use import reject_without_images
from server.procedure.live_listener import LiveListener
from server.store import CaseStore
from server.store.latency_file import LatencyFile
from tracker.errors import InvalidInput, NavigationError

# A measuring page polls twice a second; a closed page sends no message.
MAX_SILENCE_S = 5.0
# Two minutes at 60 images/s.
MAX_IMAGES = 7200
# Pause relative to the processing time; short, because every image must be read.
PAUSE_RATIO = 0.25


@dataclass(frozen=True, slots=True, kw_only=True)
class PageTimes:
    """Times measured by the page, on its own clock.

    Attributes:
        painted: codes in the order in which they were painted.
        shown: images in the order in which they were shown.
        comparisons: comparisons of its clock with the server's.
        screen: the screen of the page.
    """

    painted: Sequence[PaintedCode]
    shown: Sequence[ShownImage]
    comparisons: Sequence[ClockComparison]
    screen: Screen


@dataclass(frozen=True, slots=True, kw_only=True)
class ReadingStatus:
    """Progress of the measurement.

    Attributes:
        running: whether images are still processed.
        examined_images: number of processed images.
        read_images: number of images in which a code was read.
        problem: why the measurement ended.
    """

    running: bool
    examined_images: int
    read_images: int
    problem: Problem | None


class LatencyMeasurement:
    """Reads the code in every live image until it is stopped, the page stops polling, or the case changes.

    Args:
        hub: the live images.
        plan: the codes that the page shows.
        clock: monotonic clock, for the timeout of the page.
    """

    def __init__(self, hub: LiveHub, plan: CodePlan, *, clock: Callable[[], float] = time.monotonic) -> None:
        self.plan = plan
        self._clock = clock
        self._polled_at_s = clock()
        self._lock = threading.Lock()
        self._reader = CodeReader()
        self._read: dict[int, ReadImage] = {}
        self._size_wh_px = (0, 0)
        self._ended: NavigationError | None = None
        self._listener = LiveListener(
            hub, self._process, name="reading codes for the latency", pause_ratio=PAUSE_RATIO
        )

    @property
    def read(self) -> tuple[ReadImage, ...]:
        """The processed images with their codes."""
        with self._lock:
            return tuple(self._read.values())

    @property
    def size_wh_px(self) -> tuple[int, int]:
        """Size of the images; zeros before the first."""
        with self._lock:
            return self._size_wh_px

    def status(self) -> ReadingStatus:
        """Return the progress. A call also resets the timeout of the page."""
        with self._lock:
            self._polled_at_s = self._clock()
            return ReadingStatus(
                running=self._listener.running,
                examined_images=len(self._read),
                read_images=sum(one.code is not None for one in self._read.values()),
                problem=self._listener.problem,
            )

    def end_for(self, error: NavigationError) -> None:
        """End the measurement with this error at the next image."""
        with self._lock:
            self._ended = error

    def stop(self) -> None:
        """Stop reading."""
        self._listener.stop()

    def _process(self, instant: Instant) -> None:
        self._reject_if_over()
        snapshot = instant.snapshot
        if instant.image is None or snapshot is None:
            return
        code = self._reader.read(instant.image)
        tracked_s = sum(snapshot.stage_ms.values()) / 1000.0
        one = ReadImage(
            image_number=snapshot.image_number,
            captured_at_s=snapshot.captured_at_s,
            concluded_at_s=snapshot.captured_at_s + tracked_s,
            code=code,
        )
        with self._lock:
            if self._size_wh_px not in {(0, 0), snapshot.size_wh_px}:
                raise InvalidInput(
                    "IMAGE_SIZE_CHANGED",
                    f"the image size changed from {self._size_wh_px[0]}x{self._size_wh_px[1]} px to "
                    f"{snapshot.size_wh_px[0]}x{snapshot.size_wh_px[1]} px",
                    "Set the camera to its working size, and measure again.",
                    {
                        "size_wh_px": list(snapshot.size_wh_px),
                        "before_wh_px": list(self._size_wh_px),
                        "before_width_px": self._size_wh_px[0],
                        "before_height_px": self._size_wh_px[1],
                        "width_px": snapshot.size_wh_px[0],
                        "height_px": snapshot.size_wh_px[1],
                    },
                )
            self._size_wh_px = snapshot.size_wh_px
            self._read.setdefault(one.image_number, one)

    def _reject_if_over(self) -> None:
        with self._lock:
            silent_s, images, ended = self._clock() - self._polled_at_s, len(self._read), self._ended
        if ended is not None:
            raise ended
        if silent_s > MAX_SILENCE_S:
            raise SetupOrderError(
                "LATENCY_PAGE_LEFT",
                f"the page that shows the codes was silent for {silent_s:.1f} s, limit {MAX_SILENCE_S:g} s",
                "Keep that page open and in the foreground, and measure again.",
                {"silent_s": silent_s, "max_silent_s": MAX_SILENCE_S},
            )
        if images >= MAX_IMAGES:
            raise SetupOrderError(
                "LATENCY_TOO_LONG",
                f"no result after {images} images, the maximum",
                "Point the camera at the screen, then measure again.",
                {"images": images},
            )


class LatencyStep(CollectingStep[LatencyMeasurement]):
    """Measures the latency of the camera and a page; one measurement at a time. Thread-safe.

    Args:
        hub: the live images.
        store: the case store; a measurement ends when the open case changes.
        file: where results are stored.
        camera: name of the camera source, stored with its results.
        clock: monotonic clock.
        wall: wall clock, for the date of a result.
        on_result: called when a result is stored.
    """

    def __init__(
        self,
        *,
        hub: LiveHub,
        store: CaseStore,
        file: LatencyFile,
        camera: str,
        clock: Callable[[], float] = time.monotonic,
        wall: Clock = utc_now,
        on_result: Callable[[], None] = lambda: None,
    ) -> None:
        super().__init__("latency measurement is", remedy="Start a measurement on the camera's page.")
        self._hub = hub
        self._store = store
        self._file = file
        self._camera = camera
        self._clock = clock
        self._wall = wall
        self._on_result = on_result
        self._case_id: str | None = None
        store.add_commit_listener(self._follow_case)

    def begin(self, codes: int) -> LatencyMeasurement:
        """Start to read codes in the live images; a previous measurement is discarded.

        Raises:
            CaptureError: NO_PICTURE.
            SetupOrderError: NO_CAMERA_IN_USE.
        """
        reject_without_images(self._hub)
        newest = self._hub.newest
        rate_hz = 0.0 if newest is None else newest.source.rate_hz
        if newest is None or newest.is_stopped or rate_hz <= 0.0:
            raise CaptureError(
                "NO_PICTURE",
                "the camera delivers no images, so that nothing can be timed",
                "Wait until the video runs, and try again.",
            )
        self._case_id = self._opened_id()
        plan = plan_codes(codes, rate_hz=rate_hz)
        return self._start(lambda: LatencyMeasurement(self._hub, plan, clock=self._clock))

    def conclude(self, times: PageTimes, *, made_by: str) -> LatencyResult:
        """Compute the latencies and store the result; the measurement ends even if it is rejected.

        Raises:
            SetupOrderError: COLLECTION_MISSING, or why reading had ended before.
            CalibrationError: as `latency_report`.
            StoreError: it cannot be stored.
        """
        measurement = self.collection
        self.end()
        problem = measurement.status().problem
        if problem is not None:
            raise SetupOrderError(problem.code, problem.message, problem.remedy, problem.context)
        report = latency_report(
            painted=times.painted,
            read=measurement.read,
            shown=times.shown,
            comparisons=times.comparisons,
            min_timed=measurement.plan.min_timed,
        )
        width_px, height_px = measurement.size_wh_px
        result = LatencyResult(
            at=utc_text(self._wall(), timespec="seconds"),
            made_by=made_by,
            camera=self._camera,
            width_px=width_px,
            height_px=height_px,
            rate_hz=round(1000.0 / report.image_period_ms, 1) if report.image_period_ms > 0.0 else 0.0,
            screen=times.screen,
            report=report,
        )
        self._file.put(result)
        self._on_result()
        return result

    def newest(self) -> LatencyResult | None:
        """Return the last result for this camera; None if there is none.

        Raises:
            StoreError: it cannot be read.
        """
        return self._file.of(self._camera)

    def applies(self, result: LatencyResult) -> bool:
        """Return whether a result is valid for size and rate of the present images; True without images."""
        newest = self._hub.newest
        if newest is None or newest.snapshot is None or newest.source.rate_hz <= 0.0:
            return True
        period_ms = 1000.0 / newest.source.rate_hz
        return result.measured.applies_to(newest.snapshot.size_wh_px, period_ms=period_ms)

    def _opened_id(self) -> str | None:
        case = self._store.get_open_case()
        return None if case is None else case.id

    def _follow_case(self) -> None:
        """End the measurement if the open case has changed; called after each change of the store."""
        if not self.is_collecting or self._opened_id() == self._case_id:
            return
        self.collection.end_for(
            SetupOrderError(
                "LATENCY_CASE_CHANGED",
                "the open case was closed or changed during the latency measurement",
                "Measure again in the present case.",
            )
        )
