"""Runs a source in its own thread, and provides its newest image."""

import threading
import time
from collections import deque
from dataclasses import replace

import cv2
import structlog

from server.capture.frozen_image import FrozenImageDetector
from server.capture.shot import Shot, Source, is_bgr
from server.errors import CaptureError
from server.live import CameraStatus, Problem, SourceState, SourceStatus
from server.priority import lower_thread_priority
from tracker.camera import FlickerMonitor

# With half a second to connect, a source is found within a second after its return.
RETRY_AFTER_S = 0.3
STALLED_AFTER_S = 2.0
# A capture card may repeat each image of a slower camera; an image repeated for longer is not live.
FROZEN_AFTER_S = 0.25
RATE_WINDOW_S = 1.0

log = structlog.get_logger(__name__)


class Capture:
    """The newest image of a source, which is reopened automatically when it fails.

    Nothing is queued: an image that was not taken before the next one arrives is skipped and counted. An
    image that a camera repeats for longer than `FROZEN_AFTER_S` is not passed on, nor is one of another pixel
    format. Images of a camera are searched for lamp flicker. Simulated images are rendered at low priority.
    """

    def __init__(
        self, source: Source, *, stop: threading.Event, taken_before: int = 0, is_simulated: bool = False
    ) -> None:
        self._source = source
        self._stop = stop
        self._is_simulated = is_simulated
        self._change = threading.Condition()
        self._newest: Shot | None = None
        self._state = SourceState.OPENING
        self._problem: Problem | None = None
        self._same = FrozenImageDetector()
        self._flicker_monitor = FlickerMonitor()
        self._last_logged: tuple[str, str] | None = None
        self._failed_at_s: float | None = None
        self._is_open = False
        self._images = 0
        self._taken = taken_before
        self._alive_at_s = time.monotonic()
        self._times: deque[float] = deque(maxlen=240)
        self._status_changed = False
        self._crash: BaseException | None = None
        self._thread = threading.Thread(target=self._run, name="capture", daemon=True)

    def start(self) -> None:
        """Start capturing."""
        self._thread.start()

    def close(self, timeout_s: float = 1.0) -> None:
        """Wait for the thread to end; `stop` must be set before."""
        with self._change:
            self._change.notify_all()
        self._thread.join(timeout_s)

    def take(self, timeout_s: float) -> Shot | None:
        """Return the newest image not taken yet; None when the status changed or after the timeout.

        Raises:
            BaseException: any error other than CaptureError that ended the capture thread.
        """
        deadline_s = time.monotonic() + timeout_s
        with self._change:
            while self._newest is None and not self._status_changed and self._crash is None:
                left_s = deadline_s - time.monotonic()
                if left_s <= 0.0 or self._stop.is_set():
                    return None
                self._change.wait(left_s)
            if self._crash is not None:
                raise self._crash
            self._status_changed = False
            shot, self._newest = self._newest, None
            if shot is not None:
                self._taken += 1
                self._change.notify_all()
            return shot

    def status(self) -> SourceStatus:
        """Return the status of the source."""
        now_s = time.monotonic()
        with self._change:
            state, problem = self._state, self._problem
            silent_s = now_s - self._alive_at_s
            if self._source.stalls and self._is_open and silent_s > STALLED_AFTER_S:
                state, problem = SourceState.RECONNECTING, self._stalled()
            recent = [t for t in self._times if now_s - t <= RATE_WINDOW_S]
            pending = 0 if self._newest is None else 1
            return SourceStatus(
                name=self._source.name,
                state=state,
                problem=problem,
                images=self._images,
                skipped_images=max(0, self._images - self._taken - pending),
                rate_hz=_rate_hz(recent) if state is SourceState.RUNNING else 0.0,
                camera=self._camera_status(),
            )

    def _camera_status(self) -> CameraStatus | None:
        camera = self._source.camera
        return None if camera is None else replace(camera, flicker=self._flicker_monitor.flicker)

    def _stalled(self) -> Problem:
        camera = self._source.camera
        if camera is not None and camera.trigger:
            return Problem(
                code="CAMERA_NOT_TRIGGERED",
                message=f"{self._source.name} waits for a pulse on {camera.trigger}, but received none for "
                f"{STALLED_AFTER_S:g} s",
                remedy="Start the trigger source, and check its cable; or set camera.trigger to null.",
                context={"source": self._source.name, "trigger": camera.trigger, "limit_s": STALLED_AFTER_S},
            )
        return Problem(
            code="SOURCE_STALLED",
            message=f"the source {self._source.name} is open, but sent no image for {STALLED_AFTER_S:g} s",
            remedy="Check the camera, its power and its cable; it is retried automatically.",
            context={"source": self._source.name, "limit_s": STALLED_AFTER_S},
        )

    def _run(self) -> None:
        if self._is_simulated:
            lower_thread_priority()
        try:
            while not self._stop.is_set():
                try:
                    self._read_until_it_ends()
                except CaptureError as error:
                    self._fail(error)
                else:
                    return
                self._stop.wait(RETRY_AFTER_S)
        except BaseException as crash:  # noqa: BLE001  raised again in the thread that takes the images
            with self._change:
                self._crash = crash
                self._change.notify_all()
        finally:
            self._source.close()

    def _read_until_it_ends(self) -> None:
        self._source.open()
        self._flicker_monitor = FlickerMonitor()
        with self._change:
            self._is_open = True
            self._alive_at_s = time.monotonic()
        while not self._stop.is_set():
            shot = self._read()
            if shot is None:
                self._end()
                return
            if not self._is_frozen(shot):
                self._detect_flicker(shot)
                self._publish(shot)

    def _read(self) -> Shot | None:
        """Return the next image.

        Raises:
            CaptureError: the source has none, or IMAGE_NOT_DECODED, IMAGE_FORMAT_INVALID.
        """
        try:
            shot = self._source.read()
        except cv2.error as error:
            raise CaptureError(
                "IMAGE_NOT_DECODED",
                f"an image of {self._source.name} could not be decoded: {error.err}",
                "Check the cable, and set the camera to MJPEG or YUYV; it is retried automatically.",
                {"source": self._source.name, "library_error": error.err},
            ) from error
        if shot is not None and not is_bgr(shot.image):
            given = f"{shot.image.dtype} {shot.image.shape}"
            raise CaptureError(
                "IMAGE_FORMAT_INVALID",
                f"an image of {self._source.name} is {given}, needed is uint8 (height, width, 3)",
                "Check the cable, and set the camera to MJPEG or YUYV; it is retried automatically.",
                {"source": self._source.name, "given": given},
            )
        return shot

    def _is_frozen(self, shot: Shot) -> bool:
        """Return whether the source repeats an old image as if it were live.

        Raises:
            CaptureError: SOURCE_FROZEN: for so long that the source is reopened.
        """
        if not self._source.stalls or self._same.repeated_for_s(shot) <= FROZEN_AFTER_S:
            return False
        with self._change:
            silent_s = shot.captured_at_s - self._alive_at_s
        if silent_s > STALLED_AFTER_S:
            raise CaptureError(
                "SOURCE_FROZEN",
                f"the source {self._source.name} repeated the same image for {STALLED_AFTER_S:g} s",
                "Uncover the lens. If that does not help, restart the camera and any device between it and "
                "this machine, and check its cable. It is reopened automatically.",
                {"source": self._source.name, "limit_s": STALLED_AFTER_S},
            )
        return True

    def _detect_flicker(self, shot: Shot) -> None:
        """Detect flicker of lamps in the images of a camera, and log its start and end."""
        if self._source.camera is None:
            return
        before = self._flicker_monitor.flicker
        self._flicker_monitor.take(shot.image, shot.captured_at_s)
        flicker = self._flicker_monitor.flicker
        if flicker is not None and before is None:
            log.warning(
                "lamps flicker in the images",
                code="LAMP_FLICKER",
                camera=self._source.name,
                mains_hz=flicker.mains_hz,
                depth_percent=round(100.0 * flicker.depth_ratio, 1),
                remedy="The page lists exposure times that avoid it.",
            )
        elif flicker is None and before is not None:
            log.info("lamps no longer flicker", camera=self._source.name)

    def _publish(self, shot: Shot) -> None:
        defect = self._source.defect
        with self._change:
            started = self._state is not SourceState.RUNNING
            self._newest = shot
            self._images = shot.number + 1
            self._alive_at_s = shot.captured_at_s
            self._times.append(shot.captured_at_s)
            self._state = SourceState.RUNNING
            self._problem = None if defect is None else Problem.from_error(defect)
            self._change.notify_all()
        if started:
            self._log_running(shot)
        if defect is not None:
            self._log_problem(defect)
        elif started:
            self._last_logged = None
        if self._source.waits_for_consumer:
            with self._change:
                self._change.wait_for(lambda: self._newest is not shot or self._stop.is_set())

    def _end(self) -> None:
        if self._source.defect is not None:
            self._log_problem(self._source.defect)
        with self._change:
            self._state = SourceState.ENDED
            self._is_open = False
            self._problem = None if self._source.defect is None else Problem.from_error(self._source.defect)
            self._status_changed = True
            self._change.notify_all()
        log.info("source ended", source=self._source.name, images=self._images)

    def _fail(self, error: CaptureError) -> None:
        self._source.close()
        with self._change:
            self._is_open = False
            self._state = SourceState.RECONNECTING
            self._problem = Problem.from_error(error)
            self._times.clear()
            # An image from before the failure must not be used as live.
            self._newest = None
            self._status_changed = True
            if self._failed_at_s is None:
                self._failed_at_s = time.monotonic()
            self._change.notify_all()
        self._log_problem(error)

    def _log_running(self, shot: Shot) -> None:
        height, width = shot.image.shape[:2]
        size = f"{width}x{height}"
        if self._failed_at_s is None:
            log.info("source started", source=self._source.name, size_px=size)
        else:
            away_s = round(time.monotonic() - self._failed_at_s, 1)
            log.info("source reconnected", source=self._source.name, size_px=size, away_s=away_s)
        self._failed_at_s = None
        if shot.is_predicted:
            log.warning(
                "the video codec predicts images from earlier ones: the stated errors are larger",
                code="VIDEO_PREDICTED",
                source=self._source.name,
                remedy="Set the camera to MJPEG, or to uncompressed images.",
            )

    def _log_problem(self, error: CaptureError) -> None:
        """Log an error once, not at every attempt."""
        sentence = (error.code, error.message)
        if sentence != self._last_logged:
            self._last_logged = sentence
            log.warning(error.message, code=error.code, remedy=error.remedy)


def _rate_hz(times: list[float]) -> float:
    """Return the images per second between the first and last of these times."""
    if len(times) < 2 or times[-1] <= times[0]:
        return 0.0
    return (len(times) - 1) / (times[-1] - times[0])
