"""Detection of delayed images of a stream by their arrival times.

A stream has no reliable timestamps. After a pause of the network or of this machine, buffered images arrive
all at once and would look new by their arrival time. The detection costs one image after each pause. Bursts
less than a quarter of a second apart cannot be distinguished from the image rate and are not detected.
"""

# A gap longer than both limits is a pause.
PAUSE_PERIODS = 3.0
MIN_PAUSE_S = 0.25
# An image that arrives earlier than this share of a period was buffered.
RHYTHM_RATIO = 0.5
# Until the period is known. Many servers start with the images buffered since the last key frame.
MIN_PERIOD_S = 0.02
LEARNING_RATE = 0.1


class Backlog:
    """Classifies each image by its arrival time; times are passed in."""

    def __init__(self) -> None:
        self.restart()

    def restart(self) -> None:
        """Reset after the stream was opened."""
        self._last_s: float | None = None
        self._period_s = MIN_PERIOD_S
        self._is_learnt = False
        self._catching_up = True
        self._paused = False
        self._live_at_s = 0.0

    def is_old(self, arrived_s: float) -> bool:
        """Return whether an image was buffered before it arrived.

        The first image after a pause may have been taken at the start of the pause, so it counts as old, like
        those that follow closely. The first image after a full period is live.
        """
        if self._last_s is None:
            self._last_s = self._live_at_s = arrived_s
            return True
        interval_s, self._last_s = arrived_s - self._last_s, arrived_s
        was_paused = self._paused
        self._paused = interval_s > max(MIN_PAUSE_S, PAUSE_PERIODS * self._period_s)
        if self._paused and not was_paused and self._is_learnt:
            self._catching_up = True
            return True
        if self._catching_up and interval_s < RHYTHM_RATIO * self._period_s:
            return True
        # Two pauses in a row mean that nothing was buffered: the camera has become slow.
        self._catching_up = False
        rate = LEARNING_RATE if self._is_learnt else 1.0
        self._period_s += rate * (interval_s - self._period_s)
        self._is_learnt = True
        self._live_at_s = arrived_s
        return False

    def old_for_s(self, arrived_s: float) -> float:
        """Return the time since the last live image."""
        return arrived_s - self._live_at_s
