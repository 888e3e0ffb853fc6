"""A thread that passes live images to a step of the procedure."""

import threading
import time
from collections.abc import Callable

import structlog

from server.live import Instant, LiveHub, Problem
from tracker.errors import NavigationError

WAIT_S = 0.2
# Pause after each call, as a multiple of its duration: the video path needs the rest of the processor.
PAUSE_RATIO = 1.5

log = structlog.get_logger(__name__)


class LiveListener:
    """Calls `callback` with the newest instant, in its own thread, until it is stopped.

    A slow callback skips images; nothing is queued. An exception in the callback ends the thread and is
    available as `problem`.

    Args:
        hub: source of the instants.
        callback: called with each instant, always from the same thread.
        name: name of the thread, for the log.
        min_pause_s: minimum time from the start of one call to the start of the next.
        pause_ratio: minimum pause after a call, as a multiple of its duration.
    """

    def __init__(
        self,
        hub: LiveHub,
        callback: Callable[[Instant], None],
        *,
        name: str,
        min_pause_s: float = 0.0,
        pause_ratio: float = PAUSE_RATIO,
    ) -> None:
        self._hub = hub
        self._process = callback
        self._min_pause_s = min_pause_s
        self._pause_ratio = pause_ratio
        self._stop = threading.Event()
        self._problem: Problem | None = None
        newest = hub.newest
        # Images from before the start are not processed.
        self._sequence = -1 if newest is None else newest.sequence
        self._thread = threading.Thread(target=self._run, name=name, daemon=True)
        self._thread.start()

    @property
    def problem(self) -> Problem | None:
        """The error that ended the thread; None while it runs, and after `stop`."""
        return self._problem

    @property
    def running(self) -> bool:
        """Whether images are still processed."""
        return self._problem is None and not self._stop.is_set()

    def stop(self) -> None:
        """Stop, and return after the last call has finished."""
        self._stop.set()
        if threading.current_thread() is not self._thread:
            self._thread.join()

    def _run(self) -> None:
        while not self._stop.is_set():
            instant = self._hub.wait_after(self._sequence, WAIT_S)
            if instant is None:
                continue
            self._sequence = instant.sequence
            began_s = time.monotonic()
            try:
                self._process(instant)
            except NavigationError as error:
                self._problem = Problem.from_error(error)
                return
            except Exception:
                log.exception("processing of a live image failed", step=self._thread.name)
                self._problem = Problem(
                    code="STEP_FAILED",
                    message=f"{self._thread.name} ended because of an error in the server",
                    remedy="Start it again; if the error persists, send the server log to the maintainer.",
                    context={"activity": self._thread.name},
                )
                return
            took_s = time.monotonic() - began_s
            self._stop.wait(max(self._min_pause_s - took_s, self._pause_ratio * took_s))
