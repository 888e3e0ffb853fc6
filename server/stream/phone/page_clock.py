"""The clock of a page against this machine's monotonic clock, bounded by round trips.

The server sends a ping at s, the page reads its clock at p, and the answer arrives at r. So the page's clock
is ahead by at most p - s and at least p - r. Of many round trips the smallest upper bound is used: its error
is the shortest delay on the way to the page, not that of large images on the way back.
"""

from collections import deque

# Clocks of two devices drift by up to 0.1 ms/s: within this time by no more than a round trip takes anyway.
WINDOW_S = 10.0


class PageClock:
    """Bounds from the round trips of the last seconds. Times are passed in, in seconds."""

    def __init__(self) -> None:
        self._bounds: deque[tuple[float, float, float]] = deque()

    @property
    def is_known(self) -> bool:
        """Whether there was a round trip."""
        return bool(self._bounds)

    @property
    def error_s(self) -> float:
        """By how much `captured_at_s` may be too early, at most. Only when `is_known`."""
        return self._max_ahead_s - self._min_ahead_s

    def take(self, *, sent_s: float, page_s: float, received_s: float) -> None:
        """One round trip."""
        bounds = (received_s, page_s - received_s, page_s - sent_s)
        self._bounds.append(bounds)
        while self._bounds[0][0] < received_s - WINDOW_S:
            self._bounds.popleft()
        if self._max_ahead_s < self._min_ahead_s:
            # No offset fits all: the page's clock was stopped or set, as by a device that slept.
            self._bounds.clear()
            self._bounds.append(bounds)

    def captured_at_s(self, page_s: float) -> float:
        """A time of the page on this machine's clock: never later than it was, as far as the page's holds."""
        return page_s - self._max_ahead_s

    @property
    def _max_ahead_s(self) -> float:
        return min(bounds[2] for bounds in self._bounds)

    @property
    def _min_ahead_s(self) -> float:
        return max(bounds[1] for bounds in self._bounds)
