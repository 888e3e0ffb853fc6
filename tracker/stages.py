"""How long each stage of one image took, by a clock that the caller brings."""

from collections.abc import Callable


class Stages:
    """Adds up the time of each stage by name. Without a clock it stays empty: the tracker owns no time."""

    def __init__(self, clock: Callable[[], float] | None) -> None:
        self._clock = clock
        self._last_s = 0.0
        self.taken_ms: dict[str, float] = {}

    def start(self) -> None:
        """A new image begins."""
        self.taken_ms = {}
        if self._clock is not None:
            self._last_s = self._clock()

    def end(self, stage: str) -> None:
        """What was done since the last call was this stage."""
        if self._clock is None:
            return
        now = self._clock()
        self.taken_ms[stage] = self.taken_ms.get(stage, 0.0) + (now - self._last_s) * 1000.0
        self._last_s = now
