"""Sliding-window rate limiter by key."""

from collections import deque
from dataclasses import dataclass, field


@dataclass(slots=True, kw_only=True)
class RateLimiter:
    """Counts events by key, and returns the waiting time above the limit.

    Attributes:
        max_count: maximum number of events within the window.
        window_s: length of the window.
        max_keys: maximum number of keys; above it the oldest is dropped.
    """

    max_count: int
    window_s: float
    max_keys: int = 1000
    _times_s: dict[str, deque[float]] = field(default_factory=dict)

    def wait_s(self, key: str, now_s: float) -> float:
        """Return 0 where another event is allowed, else the waiting time."""
        times_s = self._times_s.get(key, deque())
        if len(times_s) < self.max_count:
            return 0.0
        return max(0.0, times_s[0] + self.window_s - now_s)

    def count(self, key: str, now_s: float) -> None:
        """Count one event."""
        if key not in self._times_s and len(self._times_s) >= self.max_keys:
            del self._times_s[next(iter(self._times_s))]
        self._times_s.setdefault(key, deque(maxlen=self.max_count)).append(now_s)
