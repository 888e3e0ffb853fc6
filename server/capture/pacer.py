"""Playback of images at their original rate, or slower."""

import threading
import time


class Pacer:
    """Waits until an image is due by the clock of its source, which runs at `speed`.

    If a source falls behind by more than `slack_s`, its clock is reset, so that a pause of the machine is not
    followed by a burst of images.
    """

    def __init__(self, *, stop: threading.Event, speed: float = 1.0, slack_s: float = 0.5) -> None:
        self._stop = stop
        self._speed = speed
        self._slack_s = slack_s
        self._epoch_s: float | None = None

    def restart(self) -> None:
        """Make the next image due at once; the clock starts with it."""
        self._epoch_s = None

    def wait_until_due(self, source_time_s: float) -> float:
        """Wait until an image is due; return its lateness in seconds (0 if it had to wait)."""
        now_s, played_s = time.monotonic(), source_time_s / self._speed
        if self._epoch_s is None:
            self._epoch_s = now_s - played_s
        wait_s = self._epoch_s + played_s - now_s
        if wait_s > 0.0:
            self._stop.wait(wait_s)
            return 0.0
        if -wait_s > self._slack_s:
            self._epoch_s = now_s - played_s
        return -wait_s
