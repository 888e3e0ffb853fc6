"""Where the drill's tip was in the last seconds."""

from collections import deque

import numpy as np

from tracker.geometry import Array

SPAN_S = 10.0
EVERY_S = 0.1
# A tip that was away for longer came back from elsewhere.
LONGEST_GAP_S = 1.0


class Trace:
    """The places of one tip in the world of the scene. Mutable; time comes in with each place."""

    def __init__(self) -> None:
        self._places: deque[tuple[float, Array]] = deque()
        self._seen_at_s = -np.inf

    def take(self, tip_mm: Array, *, at_s: float) -> bool:
        """One more place (3,); whether the trace is another one now."""
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
        """(n, 2, 3), from place to place; empty with fewer than two."""
        places = np.array([place for _, place in self._places]).reshape(-1, 3)
        return np.stack([places[:-1], places[1:]], axis=1)
