"""Ctrl+C and SIGTERM: a clean end, whenever they come."""

import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType


class Stopping:
    """Notes the wish to stop from the first line to the last; the first handler given is told of it."""

    def __init__(self) -> None:
        self.asked = 0
        self._act: Callable[[], None] | None = None

    def call_when_asked(self, act: Callable[[], None]) -> None:
        """From now on a signal calls `act`, instead of ending the program where it is."""
        self._act = act

    @contextmanager
    def caught(self) -> Iterator["Stopping"]:
        """Until the end of the block, Ctrl+C and SIGTERM come here."""
        before = {number: signal.signal(number, self._note) for number in (signal.SIGINT, signal.SIGTERM)}
        try:
            yield self
        finally:
            for number, handler in before.items():
                signal.signal(number, handler)

    def _note(self, number: int, frame: FrameType | None) -> None:
        del number, frame
        self.asked += 1
        if self._act is not None:
            self._act()
        elif self.asked == 1:
            # A second Ctrl+C must not interrupt the cleaning up that this one begins.
            sys.exit(0)
