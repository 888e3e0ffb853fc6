"""One recording in the web process: starts the recording process and sends messages to it.

Publisher and alarms only append to a queue; a thread sends, so that they never wait for the disk. If the
queue is full because the recording process does not read, alarm steps are dropped and recorded as missing.
"""

import multiprocessing
import threading
import time
from collections import deque
from collections.abc import Callable
from typing import Protocol

import structlog

from server.alarms import AlarmService
from server.alarms.evaluation import AlarmState, AlarmStep
from server.live import Problem
from server.loop.forks import end_process, exit_text
from server.loop.shared_status import ProcessView
from server.recording.process import (
    AlarmsBegin,
    AlarmsNeeded,
    FromServer,
    RecordingOrder,
    RecordingStatus,
    RingChanged,
    StateNeeded,
    StepsTaken,
    Stop,
    TextMessage,
    ToServer,
    run_recording,
)
from server.recording_file import Topic
from tracker.navigation.alarms import AlarmSnapshot

PERIOD_S = 0.05
MAX_QUEUED = 4000
STOP_TIMEOUT_S = 10.0

log = structlog.get_logger(__name__)


class TrackedImages(Protocol):
    """The part of the tracking system that a recording needs."""

    @property
    def current(self) -> ProcessView:
        """Return the tracking process with its ring."""

    def record(self, *, is_recording: bool) -> None:
        """Make it send its state before the next image."""


class Recorder:
    """Records until it is stopped or fails.

    Args:
        order: What is recorded, and where.
        tracked: The tracking system.
        alarms: The alarms.
        on_end: Called once from the thread of the recorder with the reason of the end; None if it was
            stopped.
    """

    def __init__(
        self,
        order: RecordingOrder,
        *,
        tracked: TrackedImages,
        alarms: AlarmService,
        on_end: Callable[[Problem | None], None] = lambda _: None,
    ) -> None:
        self._order = order
        self._tracked = tracked
        self._alarms = alarms
        self._on_end = on_end
        self._lock = threading.Lock()
        self._queue: deque[FromServer] = deque()
        self._dropped = 0
        self._status = RecordingStatus()
        self._generation = -1
        self._stop_reason: str | None = None
        self._is_stopping = threading.Event()
        context = multiprocessing.get_context("forkserver")
        self._connection, theirs = context.Pipe()
        self._process = context.Process(
            target=run_recording, args=(order, theirs), name="recording", daemon=True
        )
        self._process.start()
        theirs.close()
        self._thread = threading.Thread(target=self._run, name="recorder", daemon=True)
        self._thread.start()

    @property
    def pid(self) -> int | None:
        """Process id of the recording process."""
        return self._process.pid

    @property
    def status(self) -> RecordingStatus:
        """Last reported state."""
        with self._lock:
            return self._status

    def put_text(self, topic: Topic, text: str) -> None:
        """Record a message. Returns at once."""
        self._put(TextMessage(topic=topic, text=text, at_s=time.monotonic()))

    def stop(self, reason: str = "") -> RecordingStatus:
        """End the recording, wait until its file is closed, and return its last state."""
        self._stop_reason = reason
        self._is_stopping.set()
        self._thread.join(2 * STOP_TIMEOUT_S)
        return self.status

    def _put(self, message: FromServer) -> None:
        with self._lock:
            if len(self._queue) >= MAX_QUEUED:
                self._dropped += 1
                return
            if self._dropped:
                self._queue.append(StepsTaken(steps=(), missing=self._dropped))
                self._dropped = 0
            self._queue.append(message)

    def _take_step(self, step: AlarmStep, picture: AlarmSnapshot) -> None:
        self._put(StepsTaken(steps=((step, picture),)))

    def _begin_alarms(self, state: AlarmState, at_s: float) -> None:
        self._put(AlarmsBegin(state=state, at_s=at_s))

    def _run(self) -> None:
        problem: Problem | None = None
        try:
            self._work()
            problem = self.status.problem
        except (EOFError, OSError):
            self._process.join(STOP_TIMEOUT_S)
            problem = self.status.problem or _ended(exit_text(self._process.exitcode))
        except Exception as error:
            log.exception("the recording failed")
            problem = _ended(f"because of an error ({type(error).__name__}: {error})")
        finally:
            self._alarms.record_steps(None)
            self._tracked.record(is_recording=False)
            self._end_process()
            with self._lock:
                self._status = RecordingStatus(
                    written_bytes=self._status.written_bytes,
                    images=self._status.images,
                    missing_images=self._status.missing_images,
                    problem=problem,
                    is_ended=True,
                )
            self._on_end(problem)

    def _work(self) -> None:
        """Send and receive until the process has closed the file."""
        while True:
            self._send_ring()
            self._send_queue()
            if self._is_stopping.wait(0.0) and self._stop_reason is not None:
                self._alarms.record_steps(None)
                self._send_queue()
                self._connection.send(Stop(reason=self._stop_reason))
                self._stop_reason = None
            while self._connection.poll(PERIOD_S):
                message: ToServer = self._connection.recv()
                if isinstance(message, RecordingStatus):
                    with self._lock:
                        self._status = message
                    if message.is_ended:
                        return
                elif isinstance(message, StateNeeded):
                    self._tracked.record(is_recording=True)
                elif isinstance(message, AlarmsNeeded):
                    self._alarms.record_steps(self._take_step, self._begin_alarms)
                self._send_queue()

    def _send_ring(self) -> None:
        current = self._tracked.current
        if current.generation != self._generation:
            self._generation = current.generation
            self._connection.send(RingChanged(ring=current.ring))

    def _send_queue(self) -> None:
        with self._lock:
            queued = list(self._queue)
            self._queue.clear()
        for message in queued:
            self._connection.send(message)

    def _end_process(self) -> None:
        self._connection.close()
        end_process(self._process, timeout_s=STOP_TIMEOUT_S)


def _ended(how: str) -> Problem:
    return Problem(
        code="RECORDING_PROCESS_ENDED",
        message=f"the recording process ended {how}",
        remedy="Start the recording again; the part written so far is readable. Navigation continues.",
        context={"exit": how},
    )
