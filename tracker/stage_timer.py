"""Measure the duration of each stage of one image with the caller's clock."""

from collections.abc import Callable


class StageTimer:
    """Sums the duration of each stage by name. Without a clock `elapsed_ms` stays empty."""

    def __init__(self, clock: Callable[[], float] | None) -> None:
        self._clock = clock
        self._last_s = 0.0
        self.elapsed_ms: dict[str, float] = {}

    def start(self) -> None:
        """Start a new image."""
        self.elapsed_ms = {}
        if self._clock is not None:
            self._last_s = self._clock()

    def end(self, stage: str) -> None:
        """Add the time since the last call to this stage."""
        if self._clock is None:
            return
        now = self._clock()
        self.elapsed_ms[stage] = self.elapsed_ms.get(stage, 0.0) + (now - self._last_s) * 1000.0
        self._last_s = now
