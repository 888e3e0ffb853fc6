"""Images of a stream that waited on their way, told by the rhythm in which images arrive.

A stream has no time of its own that could be believed: after a pause of the network or of this machine, what
was held back arrives all at once, and by its arrival it would look new.

The price is one image after each pause. Bursts closer than a quarter of a second look like the rhythm
itself and are not noticed.
"""

# From one image to the next: more periods than this, and more time than this, is a pause.
PAUSE_PERIODS = 3.0
MIN_PAUSE_S = 0.25
# Sooner after the one before than this share of a period: it had been waiting.
RHYTHM_RATIO = 0.5
# Before the rhythm is known. Many servers begin with what they have kept since the last whole image.
MIN_PERIOD_S = 0.02
LEARNING_RATE = 0.1


class Backlog:
    """Judges each image by when it arrived; times are passed in."""

    def __init__(self) -> None:
        self.restart()

    def restart(self) -> None:
        """The stream was opened: nothing is known of its rhythm."""
        self._last_s: float | None = None
        self._period_s = MIN_PERIOD_S
        self._is_learnt = False
        self._catching_up = True
        self._paused = False
        self._live_at_s = 0.0

    def is_old(self, arrived_s: float) -> bool:
        """Whether an image waited somewhere before it arrived.

        The first one after a pause may have been taken at its beginning, so it counts as old, and so do those
        that come upon its heels. The first one in rhythm is live.
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
        # Of two pauses in a row nothing was held back between: the camera has become slow.
        self._catching_up = False
        rate = LEARNING_RATE if self._is_learnt else 1.0
        self._period_s += rate * (interval_s - self._period_s)
        self._is_learnt = True
        self._live_at_s = arrived_s
        return False

    def old_for_s(self, arrived_s: float) -> float:
        """For how long no image was live."""
        return arrived_s - self._live_at_s
