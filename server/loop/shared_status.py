"""Status of the tracking process and its ring, shared by supervisor and publisher."""

import contextlib
import os
import threading
from dataclasses import dataclass, replace
from multiprocessing import Pipe
from multiprocessing.connection import Connection, wait

from server.capture.rehearsal import PlayedScene
from server.live import Problem, ProcessState, ProcessStatus, SourceState, SourceStatus
from server.loop.ring import ImageRing


@dataclass(frozen=True, slots=True, kw_only=True)
class ProcessView:
    """One consistent view of the process.

    Attributes:
        process: status of the tracking process, without what it reports itself.
        generation: grows with each change of the ring; data read under another generation is invalid.
        ring: ring of the running process; None while there is none.
    """

    process: ProcessStatus
    generation: int
    ring: ImageRing | None


class SharedStatus:
    """Shared by the supervisor's and the publisher's thread; each change wakes the publisher."""

    def __init__(self, source_name: str) -> None:
        self._lock = threading.Lock()
        self._current = ProcessView(
            process=ProcessStatus(state=ProcessState.STARTING), generation=0, ring=None
        )
        self._source = SourceStatus(name=source_name, state=SourceState.OPENING)
        self._played_scene: PlayedScene | None = None
        # One pipe for all successive tracking processes, and to wake the publisher.
        self._notices, self.notice = Pipe(duplex=False)
        os.set_blocking(self._notices.fileno(), False)
        os.set_blocking(self.notice.fileno(), False)

    @property
    def current(self) -> ProcessView:
        """The present state."""
        with self._lock:
            return self._current

    @property
    def source(self) -> SourceStatus:
        """The source of images, as last reported."""
        with self._lock:
            return self._source

    @property
    def played_scene(self) -> PlayedScene | None:
        """The scene of the rehearsal, as last reported."""
        with self._lock:
            return self._played_scene

    def post(self, process: ProcessStatus, ring: ImageRing | None) -> None:
        """Set process and ring. For the supervisor."""
        with self._lock:
            changed = ring is not self._current.ring
            generation = self._current.generation + (1 if changed else 0)
            self._current = ProcessView(process=process, generation=generation, ring=ring)
        self.wake()

    def set_problem(self, problem: Problem) -> None:
        """Set why the process does not report although it runs. For the supervisor."""
        with self._lock:
            process = replace(self._current.process, problem=problem)
            self._current = replace(self._current, process=process)
        self.wake()

    def set_source(self, source: SourceStatus) -> None:
        """Set the reported source. For the publisher."""
        with self._lock:
            self._source = source

    def set_played_scene(self, played_scene: PlayedScene | None) -> None:
        """Set the reported scene. For the publisher."""
        if played_scene is not None:
            with self._lock:
                self._played_scene = played_scene

    def set_running(self, generation: int) -> None:
        """Mark the process of this generation as running and reporting. For the publisher.

        With a report the problem of a process that did not report is over.
        """
        with self._lock:
            current = self._current
            if current.generation == generation:
                running = ProcessStatus(state=ProcessState.RUNNING, restarts=current.process.restarts)
                self._current = replace(current, process=running)

    def wake(self) -> None:
        """Wake the publisher."""
        with contextlib.suppress(BlockingIOError, OSError):
            os.write(self.notice.fileno(), b"!")

    def wait(self, timeout_s: float) -> None:
        """Wait for a report, a change, or the timeout."""
        if wait([self._notices], timeout=max(0.0, timeout_s)):
            with contextlib.suppress(BlockingIOError):
                os.read(self._notices.fileno(), 65536)

    @property
    def notices(self) -> Connection:
        """The reading end of the pipe."""
        return self._notices
