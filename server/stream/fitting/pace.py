"""Which size a viewer's line carries, judged from its sendings alone. Pure: times come in as numbers.

A size is left for a smaller one when the line was busy nearly all the time and still missed every second
image or more. It is tried again when the line has been idle enough for a larger one, and less and less often
where that went wrong: a size that flaps is worse than a small one.
"""

from server.stream.fitting.sizes import Choice, Size

# Of the time that was looked at: a line that rests for longer is not what holds the images up.
BUSY_RATIO = 0.75
# Of the images that came meanwhile; with fewer than this, a smaller size shows more than it loses.
MIN_SENT_RATIO = 0.5
DOWN_AFTER_S = 0.9
UP_AFTER_S = 3.0
# A picture of twice the width and height has about this many times the bytes.
LARGER_BYTES_RATIO = 3.5
# How busy the line may be with the larger size, as expected from the present one.
UP_BUSY_RATIO = 0.6
WAIT_S, LONGEST_WAIT_S = 5.0, 80.0
# A larger size that is left again so soon was a mistake.
REGRET_S = 15.0


class Pace:
    """The size for one viewer."""

    def __init__(self, choice: Choice = Choice.AUTO) -> None:
        self._choice = choice
        self._carried = Size.FULL
        self._largest = Size.FULL
        self._wait_s = WAIT_S
        self._up_from_s = -float("inf")
        self._raised_at_s = -float("inf")
        self._from_s: float | None = None
        self._busy_s, self._images, self._missed = 0.0, 0, 0

    @property
    def choice(self) -> Choice:
        """What the viewer asked for."""
        return self._choice

    @property
    def size(self) -> Size:
        """In which size its next picture goes out."""
        return self._choice.fixed or self._carried.at_most(self._largest)

    def limit(self, largest: Size) -> None:
        """With auto, send nothing larger: the viewer cannot show more, however much its line carries."""
        self._largest = largest

    def choose(self, choice: Choice) -> None:
        """Take what the viewer asks for; with auto, begin with the size that it had."""
        if self._choice.fixed is not None:
            self._carried = self._choice.fixed
        self._choice = choice
        self._begin(None)

    def sent(self, *, began_s: float, ended_s: float, missed: int) -> None:
        """One picture was sent, and taken by the viewer.

        Args:
            began_s: when its sending began; monotonic.
            ended_s: when the line, or the viewer where it says so, had taken it.
            missed: how many images came meanwhile that this viewer will never have.
        """
        if self._choice is not Choice.AUTO:
            return
        from_s = self._from_s = began_s if self._from_s is None else self._from_s
        self._busy_s += ended_s - began_s
        self._images += 1
        self._missed += missed
        span_s = ended_s - from_s
        if span_s <= 0.0:
            return
        busy_ratio, sent_ratio = self._busy_s / span_s, self._images / (self._images + self._missed)
        if span_s >= DOWN_AFTER_S and busy_ratio >= BUSY_RATIO and sent_ratio < MIN_SENT_RATIO:
            self._reduce(ended_s)
        elif span_s >= UP_AFTER_S:
            if busy_ratio * LARGER_BYTES_RATIO <= UP_BUSY_RATIO and ended_s >= self._up_from_s:
                self._raise(ended_s)
            self._begin(ended_s)

    def _reduce(self, now_s: float) -> None:
        if self._carried is Size.QUARTER:
            # There is nothing smaller; look at the next stretch anew.
            self._begin(now_s)
            return
        regretted = now_s - self._raised_at_s <= REGRET_S
        self._wait_s = min(self._wait_s * 2.0, LONGEST_WAIT_S) if regretted else WAIT_S
        self._up_from_s = now_s + self._wait_s
        self._carried = self._carried.smaller
        self._begin(now_s)

    def _raise(self, now_s: float) -> None:
        if self._carried is not Size.FULL:
            self._raised_at_s = now_s
            self._carried = self._carried.larger

    def _begin(self, now_s: float | None) -> None:
        self._from_s = now_s
        self._busy_s, self._images, self._missed = 0.0, 0, 0
