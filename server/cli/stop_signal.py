"""Clean shutdown on SIGINT (Ctrl+C) and SIGTERM."""

import signal
import sys
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from types import FrameType


class StopSignal:
    """Count stop signals, and call a callback once one is set."""

    def __init__(self) -> None:
        self.count = 0
        self._act: Callable[[], None] | None = None

    def on_stop(self, act: Callable[[], None]) -> None:
        """Call `act` on each further signal instead of exiting."""
        self._act = act

    @contextmanager
    def caught(self) -> Iterator["StopSignal"]:
        """Handle SIGINT and SIGTERM until the end of the block."""
        before = {number: signal.signal(number, self._handle) for number in (signal.SIGINT, signal.SIGTERM)}
        try:
            yield self
        finally:
            for number, handler in before.items():
                signal.signal(number, handler)

    def _handle(self, number: int, frame: FrameType | None) -> None:
        del number, frame
        self.count += 1
        if self._act is not None:
            self._act()
        elif self.count == 1:
            # A second Ctrl+C must not interrupt the cleanup that this one starts.
            sys.exit(0)
