"""A burst of live images of a board that is shaken, and the board found in each of them."""

import threading
from dataclasses import dataclass
from enum import StrEnum

import cv2
import numpy as np
import numpy.typing as npt

from server.live import Instant, LiveHub, Problem
from server.procedure.following import Follower
from tracker.camera import Board
from tracker.camera.detection import BoardNotFound, find_board
from tracker.camera.readout import TimedView
from tracker.errors import CalibrationError

# Two seconds at 30 Hz: some to-and-fro; in memory 125 MB of full HD.
BURST_IMAGES = 60
# An image that came later than this after the one before belongs to no burst.
MAX_PAUSE_S = 0.5
# Between two looks, of the image's width: the hand has begun to move the board.
BEGINS_AT_RATIO = 0.02
# Of the time of a look: while a burst is taken, each image is needed.
REST_RATIO = 0.3


class BurstStage(StrEnum):
    """What the person is to do, or waits for."""

    SHOW = "show"  # the board to the camera
    MOVE = "move"  # it quickly to and fro
    TAKING = "taking"  # images are taken: go on moving it
    READING = "reading"  # the board is looked for in them
    READY = "ready"  # all are read


@dataclass(frozen=True, slots=True, kw_only=True)
class BurstStatus:
    """How far a burst has come.

    Attributes:
        board: that is looked for.
        stage: what is done now.
        taken_images: of `BURST_IMAGES`.
        read_images: in how many of them the board was looked for.
        found_images: in how many it was found.
        trouble: why nothing more is taken.
    """

    board: Board
    stage: BurstStage
    taken_images: int
    read_images: int
    found_images: int
    problem: Problem | None


class ReadoutCollection:
    """Takes one burst as soon as the board moves, then looks for it; may be asked from any thread."""

    def __init__(self, hub: LiveHub, board: Board) -> None:
        self._board = board
        self._lock = threading.Lock()
        self._stage = BurstStage.SHOW
        self._images: list[tuple[float, npt.NDArray[np.uint8]]] = []
        self._taken = 0
        self._read = 0
        self._views: list[TimedView] = []
        self._middle_px: npt.NDArray[np.float64] | None = None
        self._follower = Follower(hub, self._look, name="watching the moving board", rest_ratio=REST_RATIO)

    @property
    def status(self) -> BurstStatus:
        """How far it has come."""
        with self._lock:
            return BurstStatus(
                board=self._board,
                stage=self._stage,
                taken_images=self._taken,
                read_images=self._read,
                found_images=len(self._views),
                problem=self._follower.problem,
            )

    @property
    def views(self) -> tuple[TimedView, ...]:
        """The board in the images that are read."""
        with self._lock:
            return tuple(self._views)

    def stop(self) -> None:
        """Take no more."""
        self._follower.stop()

    def _look(self, instant: Instant) -> None:
        if self._stage is BurstStage.READING:
            self._read_next()
        elif (
            self._stage is not BurstStage.READY and instant.image is not None and instant.snapshot is not None
        ):
            at_s = instant.snapshot.captured_at_s
            if self._stage is BurstStage.TAKING:
                self._take(instant.image, at_s)
            else:
                self._await_motion(instant.image)

    def _await_motion(self, image: npt.NDArray[np.uint8]) -> None:
        found = find_board(image, self._board)
        with self._lock:
            before = self._middle_px
            if isinstance(found, BoardNotFound):
                # A board that is quick is seldom found: what was in view and is gone has begun to move.
                self._stage = BurstStage.SHOW if before is None else BurstStage.TAKING
                return
            self._middle_px = found.image_points_px.mean(axis=0)
            self._stage = BurstStage.MOVE
            if before is not None:
                moved_px = float(np.hypot(*(self._middle_px - before)))
                if moved_px > BEGINS_AT_RATIO * image.shape[1]:
                    self._stage = BurstStage.TAKING

    def _take(self, image: npt.NDArray[np.uint8], at_s: float) -> None:
        grey = image if image.ndim == 2 else np.asarray(cv2.cvtColor(image, cv2.COLOR_BGR2GRAY), np.uint8)
        with self._lock:
            if self._images:
                last_s, last = self._images[-1]
                if last.shape != grey.shape or not 0.0 < at_s - last_s <= MAX_PAUSE_S:
                    raise CalibrationError(
                        "READOUT_INTERRUPTED",
                        f"after {len(self._images)} images the next one came {at_s - last_s:.1f} s later, "
                        f"allowed {MAX_PAUSE_S:.1f} s and no other size",
                        "Wait until the video runs smoothly, and begin again.",
                        {"images": len(self._images), "pause_s": round(at_s - last_s, 2)},
                    )
            self._images.append((at_s, grey.copy()))
            self._taken = len(self._images)
            if self._taken >= BURST_IMAGES:
                self._stage = BurstStage.READING

    def _read_next(self) -> None:
        at_s, image = self._images.pop(0)
        found = find_board(image, self._board)
        with self._lock:
            self._read += 1
            if not isinstance(found, BoardNotFound):
                self._views.append(TimedView(at_s=at_s, view=found))
            if not self._images:
                self._stage = BurstStage.READY
