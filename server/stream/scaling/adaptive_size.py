"""Picture size that a viewer's connection carries, from its send times alone. Pure: times are passed in.

The size is reduced when the connection was busy nearly all the time and still skipped every second image or
more. A larger one is tried when the connection was idle enough for it, and with a growing delay after a
failed try: an alternating size is worse than a small one.
"""

from server.stream.scaling.sizes import PictureSize, SizeChoice

# Share of busy time; below it the connection is not the bottleneck.
BUSY_RATIO = 0.75
# Share of images sent; below it, a smaller size shows more than it loses.
MIN_SENT_RATIO = 0.5
DOWN_AFTER_S = 0.9
UP_AFTER_S = 3.0
# Ratio of bytes of a picture of twice the width and height.
LARGER_BYTES_RATIO = 3.5
# Maximum expected busy share with the larger size.
UP_BUSY_RATIO = 0.6
WAIT_S, LONGEST_WAIT_S = 5.0, 80.0
# A larger size that is reduced again within this time was a failed try.
REGRET_S = 15.0


class AdaptiveSize:
    """The picture size of one viewer."""

    def __init__(self, choice: SizeChoice = SizeChoice.AUTO) -> None:
        self._choice = choice
        self._carried = PictureSize.FULL
        self._largest = PictureSize.FULL
        self._wait_s = WAIT_S
        self._up_from_s = -float("inf")
        self._raised_at_s = -float("inf")
        self._from_s: float | None = None
        self._busy_s, self._images, self._missed = 0.0, 0, 0

    @property
    def choice(self) -> SizeChoice:
        """The viewer's choice."""
        return self._choice

    @property
    def size(self) -> PictureSize:
        """Size of its next picture."""
        return self._choice.fixed or self._carried.at_most(self._largest)

    def limit(self, largest: PictureSize) -> None:
        """Set the maximum size for auto: the client cannot display more."""
        self._largest = largest

    def choose(self, choice: SizeChoice) -> None:
        """Set the viewer's choice; auto starts with the present size."""
        if self._choice.fixed is not None:
            self._carried = self._choice.fixed
        self._choice = choice
        self._begin(None)

    def sent(self, *, began_s: float, ended_s: float, missed: int) -> None:
        """Record one delivered picture.

        Args:
            began_s: start of the send, monotonic.
            ended_s: end of the delivery, as measured, or as reported by the client.
            missed: number of images that this viewer skipped meanwhile.
        """
        if self._choice is not SizeChoice.AUTO:
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
        if self._carried is PictureSize.QUARTER:
            # Already the smallest size: start a new measurement.
            self._begin(now_s)
            return
        regretted = now_s - self._raised_at_s <= REGRET_S
        self._wait_s = min(self._wait_s * 2.0, LONGEST_WAIT_S) if regretted else WAIT_S
        self._up_from_s = now_s + self._wait_s
        self._carried = self._carried.smaller
        self._begin(now_s)

    def _raise(self, now_s: float) -> None:
        if self._carried is not PictureSize.FULL:
            self._raised_at_s = now_s
            self._carried = self._carried.larger

    def _begin(self, now_s: float | None) -> None:
        self._from_s = now_s
        self._busy_s, self._images, self._missed = 0.0, 0, 0
