"""Views of a calibration board, taken by themselves from the live images while somebody moves it."""

import threading
from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np
import numpy.typing as npt

from server.live import Instant, LiveHub, Problem, SourceState, SourceStatus
from server.procedure.following import Follower
from tracker.camera import Board, CameraControl, control_changes
from tracker.camera.collecting import BoardCollector, CollectingProgress, Judgement
from tracker.camera.detection import BoardNotFound, BoardView, find_board
from tracker.errors import CalibrationError, InvalidInput
from tracker.geometry import Array

# Each look costs a good part of a core; the video needs the rest.
REST_S = 0.1
MAX_VIEWS = 60
NO_POINTS: Array = np.zeros((0, 2))


@dataclass(frozen=True, slots=True, kw_only=True)
class TakenView:
    """A view that is kept.

    Attributes:
        name: what the report calls it.
        view: the board's points in it.
    """

    name: str
    view: BoardView


@dataclass(frozen=True, slots=True, kw_only=True)
class CollectionStatus:
    """How far it has come.

    Attributes:
        board: that is looked for.
        running: whether more is taken by itself.
        size_wh_px: of the images; zeros before the first.
        progress: what is taken and what is missing; None before the first image.
        image_number: of the newest image that was looked at; -1 before the first.
        said: what became of that image, in a sentence.
        points_px: (n, 2) of the board in that image, for drawing.
        trouble: why nothing is taken any more.
    """

    board: Board
    running: bool
    size_wh_px: tuple[int, int]
    progress: CollectingProgress | None
    image_number: int
    said: str
    points_px: Array
    problem: Problem | None


SAID = {
    Judgement.TAKEN: "taken",
    Judgement.TOO_FEW_POINTS: "too little of the board is seen",
    Judgement.FIRST_SIGHT: "the board is seen: hold it still",
    Judgement.MOVING: "the board moves: hold it still",
    Judgement.NOTHING_NEW: "such a view is taken already: move or tilt the board",
}


class BoardCollection:
    """Collects from the live images until it is stopped; may be asked from any thread."""

    def __init__(self, hub: LiveHub, board: Board) -> None:
        self._board = board
        self._lock = threading.Lock()
        self._collector: BoardCollector | None = None
        self._taken: list[TakenView] = []
        self._controls: Mapping[CameraControl, int] = {}
        self._image_number = -1
        self._said = "waiting for an image"
        self._points_px = NO_POINTS
        self._follower = Follower(hub, self._look, name="collecting views of the board", rest_s=REST_S)

    @property
    def status(self) -> CollectionStatus:
        """How far it has come."""
        with self._lock:
            collector = self._collector
            return CollectionStatus(
                board=self._board,
                running=self._follower.running,
                size_wh_px=(0, 0) if collector is None else collector.size_wh_px,
                progress=None if collector is None else collector.progress,
                image_number=self._image_number,
                said=self._said,
                points_px=self._points_px,
                problem=self._follower.problem,
            )

    @property
    def taken(self) -> tuple[TakenView, ...]:
        """The views that are kept."""
        with self._lock:
            return tuple(self._taken)

    @property
    def controls(self) -> Mapping[CameraControl, int]:
        """Of the live camera, when views were last taken of it; empty where none is known."""
        with self._lock:
            return self._controls

    def add(self, image: npt.NDArray[np.uint8], *, name: str) -> None:
        """Keep the board's view in an image that was taken by hand, whether or not it adds something new.

        Raises:
            InvalidInput: BOARD_NOT_FOUND, IMAGE_SIZE_CHANGED, VIEWS_ENOUGH.
        """
        found = find_board(image, self._board)
        if isinstance(found, BoardNotFound):
            raise InvalidInput(
                "BOARD_NOT_FOUND",
                f"the board is not found in {name}: {found.sentence}",
                "Take the image again, sharp, with the whole board in it and no glare on it.",
                {"image": name, "reason": found.reason.value},
            )
        with self._lock:
            self._reject_more()
            self._collector_for(image).keep(found.object_points_mm, found.image_points_px)
            self._taken.append(TakenView(name=name, view=found))

    def stop(self) -> None:
        """Take no more."""
        self._follower.stop()

    def _look(self, instant: Instant) -> None:
        if instant.image is None or instant.snapshot is None:
            self._note_absence(_no_picture(instant), -1)
            return
        found = find_board(instant.image, self._board)
        number = instant.snapshot.image_number
        if isinstance(found, BoardNotFound):
            self._note_absence(found.sentence, number)
            return
        with self._lock:
            self._reject_more()
            collector = self._collector_for(instant.image)
            judgement = collector.judge(
                ids=found.ids,
                object_points_mm=found.object_points_mm,
                image_points_px=found.image_points_px,
                captured_at_s=instant.snapshot.captured_at_s,
            )
            if judgement is Judgement.TAKEN:
                self._note_controls(instant.source)
                self._taken.append(TakenView(name=f"image {number}", view=found))
            self._image_number, self._points_px = number, found.image_points_px
            self._said = SAID[judgement]

    def _note_controls(self, source: SourceStatus) -> None:
        """Refuse views of a camera that was changed since the first one: they are of two cameras."""
        now = {} if source.camera is None else source.camera.controls
        changes = control_changes(self._controls, now)
        if changes:
            change = changes[0]
            raise CalibrationError(
                "CAMERA_CHANGED",
                f"{change.control.value} of the camera changed from {change.calibrated} to {change.now} "
                "while views were taken",
                "Leave the camera alone (camera.lock_controls switches automatic focus off), and start anew.",
                {"control": change.control.value, "before": change.calibrated, "now": change.now},
            )
        self._controls = now or self._controls

    def _reject_more(self) -> None:
        if len(self._taken) >= MAX_VIEWS:
            raise InvalidInput(
                "VIEWS_ENOUGH",
                f"{MAX_VIEWS} views are taken, which is the most that are kept",
                "Calibrate with them, or start anew.",
                {"views": MAX_VIEWS},
            )

    def _note_absence(self, said: str, image_number: int) -> None:
        with self._lock:
            if self._collector is not None:
                self._collector.lose()
            self._image_number, self._said, self._points_px = image_number, said, NO_POINTS

    def _collector_for(self, image: npt.NDArray[np.uint8]) -> BoardCollector:
        height, width = image.shape[:2]
        if self._collector is None:
            self._collector = BoardCollector((width, height))
        if self._collector.size_wh_px != (width, height):
            before = self._collector.size_wh_px
            raise InvalidInput(
                "IMAGE_SIZE_CHANGED",
                f"images are {width}x{height} px now, and were {before[0]}x{before[1]} px",
                "Set the camera to the size that it works with, and start anew.",
                {"size_wh_px": [width, height], "before_wh_px": list(before)},
            )
        return self._collector


def _no_picture(instant: Instant) -> str:
    """That there is none, and why, as far as camera or tracking say."""
    problem = instant.source.problem or instant.process.problem
    if problem is not None:
        return f"there is no picture: {problem.message}"
    ended = instant.source.state is SourceState.ENDED
    return "there is no picture: the camera's images have ended" if ended else "there is no picture"
