"""Token bucket: a rate limit with bursts."""

from dataclasses import dataclass


@dataclass(slots=True, kw_only=True)
class TokenBucket:
    """Refills at a constant rate up to its capacity; each message takes one token.

    Attributes:
        rate_hz: refill rate, the sustained number of messages a second.
        capacity: maximum burst.
        tokens: tokens at `updated_at_s`.
        updated_at_s: time of the last update, monotonic.
    """

    rate_hz: float
    capacity: float
    tokens: float
    updated_at_s: float

    @classmethod
    def full(cls, *, rate_hz: float, capacity: float, now_s: float) -> "TokenBucket":
        """Return a full bucket."""
        return cls(rate_hz=rate_hz, capacity=capacity, tokens=capacity, updated_at_s=now_s)

    def take(self, now_s: float) -> bool:
        """Take one token; return False when there is none."""
        self.tokens = min(self.capacity, self.tokens + (now_s - self.updated_at_s) * self.rate_hz)
        self.updated_at_s = now_s
        if self.tokens < 1.0:
            return False
        self.tokens -= 1.0
        return True
