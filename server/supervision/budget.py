"""How much one page may send in a time."""

from dataclasses import dataclass


@dataclass(slots=True, kw_only=True)
class Budget:
    """Fills up steadily, and is spent by what is sent.

    Attributes:
        rate_hz: how many messages a second it bears for ever.
        most: how many at once after a silence.
        left: how many now.
        at_s: when that was.
    """

    rate_hz: float
    most: float
    left: float
    at_s: float

    @classmethod
    def full(cls, *, rate_hz: float, most: float, now_s: float) -> "Budget":
        """Of one who has sent nothing yet."""
        return cls(rate_hz=rate_hz, most=most, left=most, at_s=now_s)

    def spend(self, now_s: float) -> bool:
        """One message more; False when it was too many."""
        self.left = min(self.most, self.left + (now_s - self.at_s) * self.rate_hz)
        self.at_s = now_s
        if self.left < 1.0:
            return False
        self.left -= 1.0
        return True
