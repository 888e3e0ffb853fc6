"""How often something was done within a time, by what it was done with."""

from collections import deque
from dataclasses import dataclass, field


@dataclass(slots=True, kw_only=True)
class Often:
    """Counts what is done by key, and says how long to wait where it is done too often.

    Attributes:
        most: how often within the window.
        window_s: how long that is.
        max_keys: more are not remembered: the one that came first is let go.
    """

    most: int
    window_s: float
    max_keys: int = 1000
    _times_s: dict[str, deque[float]] = field(default_factory=dict)

    def wait_s(self, key: str, now_s: float) -> float:
        """0 where once more is not too often, else how long until then."""
        times_s = self._times_s.get(key, deque())
        if len(times_s) < self.most:
            return 0.0
        return max(0.0, times_s[0] + self.window_s - now_s)

    def count(self, key: str, now_s: float) -> None:
        """It was done once more."""
        if key not in self._times_s and len(self._times_s) >= self.max_keys:
            del self._times_s[next(iter(self._times_s))]
        self._times_s.setdefault(key, deque(maxlen=self.most)).append(now_s)
