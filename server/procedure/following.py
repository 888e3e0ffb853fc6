"""Looks at the live images while a step of the set-up collects from them."""

import threading
import time
from collections.abc import Callable

import structlog

from server.live import Instant, LiveHub, Problem
from tracker.errors import NavigationError

WAIT_S = 0.2
# After a look that took long the machine is left to the video for as long again, and half of it more.
REST_BY_LOOK = 1.5

log = structlog.get_logger(__name__)


class Follower:
    """Hands the newest instant to `look`, in a thread of its own, until it is stopped.

    A look that takes long skips images; nothing is queued. What a look raises ends the following and is kept
    as `trouble`.

    Args:
        hub: where instants come from.
        look: what is done with each; called from one thread alone.
        name: of the thread, for the log.
        rest_s: least pause between two looks, so that the video keeps its share of the machine.
        rest_ratio: least pause, in the time that the look before it took.
    """

    def __init__(
        self,
        hub: LiveHub,
        look: Callable[[Instant], None],
        *,
        name: str,
        rest_s: float = 0.0,
        rest_ratio: float = REST_BY_LOOK,
    ) -> None:
        self._hub = hub
        self._look = look
        self._rest_s = rest_s
        self._rest_ratio = rest_ratio
        self._stop = threading.Event()
        self._problem: Problem | None = None
        newest = hub.newest
        # What was there before somebody asked is not looked at.
        self._sequence = -1 if newest is None else newest.sequence
        self._thread = threading.Thread(target=self._run, name=name, daemon=True)
        self._thread.start()

    @property
    def problem(self) -> Problem | None:
        """Why it ended by itself; None while it follows, and when it was stopped."""
        return self._problem

    @property
    def running(self) -> bool:
        """Whether it still looks."""
        return self._problem is None and not self._stop.is_set()

    def stop(self) -> None:
        """Look no more; returns when the last look is over."""
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
                self._look(instant)
            except NavigationError as error:
                self._problem = Problem.from_error(error)
                return
            except Exception:
                log.exception("a live image could not be used", step=self._thread.name)
                self._problem = Problem(
                    code="STEP_FAILED",
                    message=f"{self._thread.name} ended by a mistake of the server",
                    remedy="Start it again; if it comes back, send the server's log to the maintainer.",
                )
                return
            took_s = time.monotonic() - began_s
            self._stop.wait(max(self._rest_s - took_s, self._rest_ratio * took_s))
