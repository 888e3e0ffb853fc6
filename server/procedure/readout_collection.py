"""A burst of live images of a moving board, with the board detected in each."""

import threading
from dataclasses import dataclass
from enum import StrEnum

import cv2
import numpy as np
import numpy.typing as npt

from server.live import Instant, LiveHub, Problem
from server.procedure.live_listener import LiveListener
from tracker.camera import Board
from tracker.camera.detection import BoardNotFound, find_board
from tracker.camera.readout_time import TimedView
from tracker.errors import CalibrationError

# Two seconds at 30 Hz, several reversals of the motion; 125 MB of memory for full HD.
BURST_IMAGES = 60
# Maximum time between two images of a burst.
MAX_PAUSE_S = 0.5
# Motion of the board between two images, relative to the image width, from which the burst starts.
MIN_MOTION_RATIO = 0.02
# Pause relative to the processing time: during a burst every image is needed.
PAUSE_RATIO = 0.3


class BurstStage(StrEnum):
    """Stage of a burst."""

    SHOW = "show"  # show the board to the camera
    MOVE = "move"  # move it quickly to and fro
    TAKING = "taking"  # images are taken: keep moving it
    READING = "reading"  # the board is being detected in the images
    READY = "ready"  # all images are processed


@dataclass(frozen=True, slots=True, kw_only=True)
class BurstStatus:
    """Progress of a burst.

    Attributes:
        board: the calibration board.
        stage: current stage.
        taken_images: images taken, of `BURST_IMAGES`.
        read_images: images in which the detection has run.
        found_images: images in which the board was detected.
        problem: why the burst ended.
    """

    board: Board
    stage: BurstStage
    taken_images: int
    read_images: int
    found_images: int
    problem: Problem | None


class ReadoutCollection:
    """Takes one burst when the board starts to move, then detects the board in it. Thread-safe."""

    def __init__(self, hub: LiveHub, board: Board) -> None:
        self._board = board
        self._lock = threading.Lock()
        self._stage = BurstStage.SHOW
        self._images: list[tuple[float, npt.NDArray[np.uint8]]] = []
        self._size_wh_px = (0, 0)
        self._taken = 0
        self._read = 0
        self._views: list[TimedView] = []
        self._middle_px: npt.NDArray[np.float64] | None = None
        self._listener = LiveListener(
            hub, self._process, name="watching the moving board", pause_ratio=PAUSE_RATIO
        )

    @property
    def status(self) -> BurstStatus:
        """Progress of the burst."""
        with self._lock:
            return BurstStatus(
                board=self._board,
                stage=self._stage,
                taken_images=self._taken,
                read_images=self._read,
                found_images=len(self._views),
                problem=self._listener.problem,
            )

    @property
    def views(self) -> tuple[TimedView, ...]:
        """The detected board in the processed images."""
        with self._lock:
            return tuple(self._views)

    @property
    def size_wh_px(self) -> tuple[int, int]:
        """Size of the images taken; (0, 0) before the first."""
        with self._lock:
            return self._size_wh_px

    def stop(self) -> None:
        """Stop the burst."""
        self._listener.stop()

    def _process(self, instant: Instant) -> None:
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
                # A fast board is rarely detected: a board that disappears has started to move.
                self._stage = BurstStage.SHOW if before is None else BurstStage.TAKING
                return
            self._middle_px = found.image_points_px.mean(axis=0)
            self._stage = BurstStage.MOVE
            if before is not None:
                moved_px = float(np.hypot(*(self._middle_px - before)))
                if moved_px > MIN_MOTION_RATIO * image.shape[1]:
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
                        f"limit {MAX_PAUSE_S:.1f} s, or with another size",
                        "Wait until the video runs smoothly, and start again.",
                        {
                            "images": len(self._images),
                            "pause_s": round(at_s - last_s, 2),
                            "max_pause_s": MAX_PAUSE_S,
                            "later_s": at_s - last_s,
                        },
                    )
            self._images.append((at_s, grey.copy()))
            self._size_wh_px = (grey.shape[1], grey.shape[0])
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
