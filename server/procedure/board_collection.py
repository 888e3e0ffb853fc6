"""Automatic collection of views of a calibration board from the live images."""

import threading
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from server.live import Instant, LiveHub, Problem, SourceState, SourceStatus
from server.procedure.live_listener import LiveListener
from tracker.camera import Board, CameraControl, control_changes
from tracker.camera.board_collector import BoardCollector, BoardCollectorProgress, ViewVerdict
from tracker.camera.detection import BoardNotFound, BoardView, find_board
from tracker.errors import CalibrationError, InvalidInput
from tracker.geometry import Array

# Board detection is expensive; the video needs the rest of the processor.
MIN_PAUSE_S = 0.1
# Pause relative to the processing time; a slow machine must also detect a board twice while it is held still.
PAUSE_RATIO = 0.3
MAX_VIEWS = 60
NO_POINTS: Array = np.zeros((0, 2))


@dataclass(frozen=True, slots=True, kw_only=True)
class CollectedView:
    """A collected view.

    Attributes:
        name: its name in the report.
        view: the detected points of the board.
    """

    name: str
    view: BoardView


@dataclass(frozen=True, slots=True, kw_only=True)
class CollectionStatus:
    """Progress of the collection.

    Attributes:
        board: the calibration board.
        running: whether views are still collected.
        size_wh_px: size of the images; zeros before the first.
        progress: what is collected and what is missing; None before the first image.
        image_number: newest processed image; -1 before the first.
        message: result for that image.
        points_px: (n, 2) detected points in that image, for display.
        problem: why the collection ended.
    """

    board: Board
    running: bool
    size_wh_px: tuple[int, int]
    progress: BoardCollectorProgress | None
    image_number: int
    message: str
    points_px: Array
    problem: Problem | None

    @property
    def is_taken(self) -> bool:
        """Return whether the newest image gave a view."""
        return self.message == MESSAGES[ViewVerdict.TAKEN]


MESSAGES = {
    ViewVerdict.TAKEN: "taken",
    ViewVerdict.TOO_FEW_POINTS: "too small a part of the board is visible",
    ViewVerdict.FIRST_SIGHT: "board found: hold it still",
    ViewVerdict.MOVING: "the board is moving: hold it still",
    ViewVerdict.NOTHING_NEW: "a similar view has already been taken: move or tilt the board",
}


class BoardCollection:
    """Collects views from the live images until it is stopped. Thread-safe."""

    def __init__(self, hub: LiveHub, board: Board) -> None:
        self._board = board
        self._lock = threading.Lock()
        self._collector: BoardCollector | None = None
        self._taken: list[CollectedView] = []
        self._controls: Mapping[CameraControl, int] = {}
        self._device = ""
        self._image_number = -1
        self._message = "waiting for an image"
        self._points_px = NO_POINTS
        self._listener = LiveListener(
            hub,
            self._process,
            name="collecting views of the board",
            min_pause_s=MIN_PAUSE_S,
            pause_ratio=PAUSE_RATIO,
        )

    @property
    def status(self) -> CollectionStatus:
        """Progress of the collection."""
        with self._lock:
            collector = self._collector
            return CollectionStatus(
                board=self._board,
                running=self._listener.running,
                size_wh_px=(0, 0) if collector is None else collector.size_wh_px,
                progress=None if collector is None else collector.progress,
                image_number=self._image_number,
                message=self._message,
                points_px=self._points_px,
                problem=self._listener.problem,
            )

    @property
    def taken(self) -> tuple[CollectedView, ...]:
        """The collected views."""
        with self._lock:
            return tuple(self._taken)

    @property
    def controls(self) -> Mapping[CameraControl, int]:
        """Camera controls at the last collected view; empty if unknown."""
        with self._lock:
            return self._controls

    @property
    def device(self) -> str:
        """The camera of the last collected view, see `CameraStatus.device`; empty if unknown."""
        with self._lock:
            return self._device

    def add(self, image: npt.NDArray[np.uint8], *, name: str) -> None:
        """Add the view of an image that was taken manually, without testing whether it adds information.

        Raises:
            InvalidInput: BOARD_NOT_FOUND, IMAGE_SIZE_CHANGED, VIEWS_ENOUGH.
        """
        found = find_board(image, self._board)
        if isinstance(found, BoardNotFound):
            raise InvalidInput(
                "BOARD_NOT_FOUND",
                f"the board was not found in {name}: {found.sentence}",
                "Take another image that is sharp and shows the whole board without glare.",
                {"image": name, "reason": found.reason.value, "board_problem": found.sentence},
            )
        with self._lock:
            self._reject_more()
            self._collector_for(image).add(found.object_points_mm, found.image_points_px)
            self._taken.append(CollectedView(name=name, view=found))

    def stop(self) -> None:
        """Stop collecting."""
        self._listener.stop()

    def _process(self, instant: Instant) -> None:
        if instant.image is None or instant.snapshot is None:
            self._record_absence(_no_picture(instant), -1)
            return
        found = find_board(instant.image, self._board)
        number = instant.snapshot.image_number
        if isinstance(found, BoardNotFound):
            self._record_absence(found.sentence, number)
            return
        with self._lock:
            self._reject_more()
            collector = self._collector_for(instant.image)
            judgement = collector.offer(
                ids=found.ids,
                object_points_mm=found.object_points_mm,
                image_points_px=found.image_points_px,
                captured_at_s=instant.snapshot.captured_at_s,
            )
            if judgement is ViewVerdict.TAKEN:
                self._record_controls(instant.source)
                self._taken.append(CollectedView(name=f"image {number}", view=found))
            self._image_number, self._points_px = number, found.image_points_px
            self._message = MESSAGES[judgement]

    def _record_controls(self, source: SourceStatus) -> None:
        """Reject views after a change of the camera or its controls: the intrinsics may have changed."""
        device = source.device
        if device and self._device and device != self._device:
            raise CalibrationError(
                "CAMERA_DIFFERS",
                f"the camera changed from '{self._device}' to '{device}' while views were taken",
                "Keep only one camera connected, and start again.",
                {"before": self._device, "now": device},
            )
        self._device = device or self._device
        now = {} if source.camera is None else source.camera.controls
        changes = control_changes(self._controls, now)
        if changes:
            change = changes[0]
            raise CalibrationError(
                "CAMERA_CHANGED",
                f"{change.control.value} of the camera changed from {change.calibrated} to {change.now} "
                "while views were taken",
                "Do not change the camera (camera.lock_controls disables autofocus), and start again.",
                {"control": change.control.value, "before": change.calibrated, "now": change.now},
            )
        self._controls = now or self._controls

    def _reject_more(self) -> None:
        if len(self._taken) >= MAX_VIEWS:
            raise InvalidInput(
                "VIEWS_ENOUGH",
                f"{MAX_VIEWS} views have been taken, the maximum",
                "Calibrate with them, or start again.",
                {"views": MAX_VIEWS},
            )

    def _record_absence(self, message: str, image_number: int) -> None:
        with self._lock:
            if self._collector is not None:
                self._collector.reset_motion()
            self._image_number, self._message, self._points_px = image_number, message, NO_POINTS

    def _collector_for(self, image: npt.NDArray[np.uint8]) -> BoardCollector:
        height, width = image.shape[:2]
        if self._collector is None:
            self._collector = BoardCollector((width, height))
        if self._collector.size_wh_px != (width, height):
            before = self._collector.size_wh_px
            raise InvalidInput(
                "IMAGE_SIZE_CHANGED",
                f"the image size changed from {before[0]}x{before[1]} px to {width}x{height} px",
                "Set the camera to its working size, and start again.",
                {
                    "size_wh_px": [width, height],
                    "before_wh_px": list(before),
                    "before_width_px": before[0],
                    "before_height_px": before[1],
                    "width_px": width,
                    "height_px": height,
                },
            )
        return self._collector


def _no_picture(instant: Instant) -> str:
    """Return the message for a missing image, with its reason if that is known."""
    problem = instant.source.problem or instant.process.problem
    if problem is not None:
        return f"there is no image: {problem.message}"
    ended = instant.source.state is SourceState.ENDED
    return "there is no image: the source has ended" if ended else "there is no image"
