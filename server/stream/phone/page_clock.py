"""Offset of a page's clock to this machine's monotonic clock, bounded by round trips.

The server sends a ping at s, the page reads its clock at p, and the answer arrives at r. So the page's clock
is ahead by at most p - s and at least p - r. The minimum of the upper bounds is used: its error is the
shortest delay on the way to the page, not that of large images on the way back.
"""

from collections import deque

# Two clocks drift by up to 0.1 ms/s: within this time by no more than a round trip.
WINDOW_S = 10.0


class PageClock:
    """Offset bounds from the round trips of the last seconds. Times are passed in, in seconds."""

    def __init__(self) -> None:
        self._bounds: deque[tuple[float, float, float]] = deque()

    @property
    def is_known(self) -> bool:
        """Whether there was a round trip."""
        return bool(self._bounds)

    @property
    def error_s(self) -> float:
        """Maximum by which `captured_at_s` may be too early. Only when `is_known`."""
        return self._max_ahead_s - self._min_ahead_s

    def take(self, *, sent_s: float, page_s: float, received_s: float) -> None:
        """Add one round trip."""
        bounds = (received_s, page_s - received_s, page_s - sent_s)
        self._bounds.append(bounds)
        while self._bounds[0][0] < received_s - WINDOW_S:
            self._bounds.popleft()
        if self._max_ahead_s < self._min_ahead_s:
            # The bounds contradict: the page's clock was stopped or set, as by a device that slept.
            self._bounds.clear()
            self._bounds.append(bounds)

    def captured_at_s(self, page_s: float) -> float:
        """Convert a time of the page to this machine's clock; never later than the true time."""
        return page_s - self._max_ahead_s

    @property
    def _max_ahead_s(self) -> float:
        return min(bounds[2] for bounds in self._bounds)

    @property
    def _min_ahead_s(self) -> float:
        return max(bounds[1] for bounds in self._bounds)
