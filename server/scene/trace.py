"""Trace of a drill's tip over the last seconds."""

from collections import deque

import numpy as np

from tracker.geometry import Array

SPAN_S = 10.0
EVERY_S = 0.1
# After a longer absence of the tip its positions are not connected.
LONGEST_GAP_S = 1.0


class Trace:
    """Positions of one tip in the world of the scene. Mutable; times are passed in."""

    def __init__(self) -> None:
        self._places: deque[tuple[float, Array]] = deque()
        self._seen_at_s = -np.inf

    def take(self, tip_mm: Array, *, at_s: float) -> bool:
        """Add a position (3,); return whether the trace has changed."""
        if not 0.0 <= at_s - self._seen_at_s <= LONGEST_GAP_S:
            self._places.clear()
        self._seen_at_s = at_s
        if self._places and at_s - self._places[-1][0] < EVERY_S:
            return False
        self._places.append((at_s, np.asarray(tip_mm, dtype=np.float64)))
        while at_s - self._places[0][0] > SPAN_S:
            self._places.popleft()
        return True

    @property
    def segments_mm(self) -> Array:
        """Return the segments (n, 2, 3) between positions; empty for fewer than two positions."""
        places = np.array([place for _, place in self._places]).reshape(-1, 3)
        return np.stack([places[:-1], places[1:]], axis=1)
