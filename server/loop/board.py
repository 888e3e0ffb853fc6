"""What the supervisor knows and the publisher tells: the state of the tracking process, and its ring."""

import contextlib
import os
import threading
from dataclasses import dataclass
from multiprocessing import Pipe
from multiprocessing.connection import Connection, wait

from server.capture.rehearsal import Begun
from server.live import ProcessState, ProcessStatus, SourceState, SourceStatus
from server.loop.ring import ImageRing


@dataclass(frozen=True, slots=True, kw_only=True)
class Posted:
    """One consistent view of the board.

    Attributes:
        process: the tracking process, without what it says itself.
        generation: grows with each change of the ring; what was read under another one is void.
        ring: of the running process; None while there is none.
    """

    process: ProcessStatus
    generation: int
    ring: ImageRing | None


class Board:
    """Shared by the two threads; each change wakes the publisher."""

    def __init__(self, source_name: str) -> None:
        self._lock = threading.Lock()
        self._posted = Posted(process=ProcessStatus(state=ProcessState.STARTING), generation=0, ring=None)
        self._source = SourceStatus(name=source_name, state=SourceState.OPENING)
        self._begun: Begun | None = None
        # One pipe for all tracking processes, one after the other, and for waking the publisher.
        self._notices, self.notice = Pipe(duplex=False)
        os.set_blocking(self._notices.fileno(), False)
        os.set_blocking(self.notice.fileno(), False)

    @property
    def posted(self) -> Posted:
        """What is true now."""
        with self._lock:
            return self._posted

    @property
    def source(self) -> SourceStatus:
        """The source of images, as last reported."""
        with self._lock:
            return self._source

    @property
    def begun(self) -> Begun | None:
        """What of the rehearsal is played, as last reported."""
        with self._lock:
            return self._begun

    def post(self, process: ProcessStatus, ring: ImageRing | None) -> None:
        """The supervisor's: the process changed."""
        with self._lock:
            changed = ring is not self._posted.ring
            generation = self._posted.generation + (1 if changed else 0)
            self._posted = Posted(process=process, generation=generation, ring=ring)
        self.wake()

    def note_source(self, source: SourceStatus) -> None:
        """The publisher's: what the process said of the source."""
        with self._lock:
            self._source = source

    def note_begun(self, begun: Begun | None) -> None:
        """The publisher's: what the process said of the rehearsal."""
        if begun is not None:
            with self._lock:
                self._begun = begun

    def note_running(self, generation: int) -> None:
        """The publisher's: the process of this generation has spoken."""
        with self._lock:
            process = self._posted.process
            if self._posted.generation == generation and process.state is not ProcessState.RUNNING:
                running = ProcessStatus(state=ProcessState.RUNNING, restarts=process.restarts)
                self._posted = Posted(process=running, generation=generation, ring=self._posted.ring)

    def wake(self) -> None:
        """Wake the publisher."""
        with contextlib.suppress(BlockingIOError, OSError):
            os.write(self.notice.fileno(), b"!")

    def wait(self, timeout_s: float) -> None:
        """Wait for a report, a change, or the end of the time."""
        if wait([self._notices], timeout=max(0.0, timeout_s)):
            with contextlib.suppress(BlockingIOError):
                os.read(self._notices.fileno(), 65536)

    @property
    def notices(self) -> Connection:
        """The reading end of the pipe."""
        return self._notices
