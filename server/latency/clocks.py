"""Conversion of the server's monotonic clock to the page's clock."""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

# Round trips longer than the shortest one by more than this are not used, because of network delay.
MAX_EXTRA_MS = 2.0
# Below this span a drift cannot be distinguished from network jitter.
MIN_SPAN_MS = 5000.0
# Quartz clocks differ by less; a larger slope is network jitter.
MAX_DRIFT_RATIO = 500e-6


@dataclass(frozen=True, slots=True, kw_only=True)
class ClockComparison:
    """A request of the page with the server time in the response.

    Attributes:
        requested_at_ms, responded_at_ms: Times by the page's clock.
        server_s: Monotonic time of the server in between.
    """

    requested_at_ms: float
    responded_at_ms: float
    server_s: float

    @property
    def round_trip_ms(self) -> float:
        """Duration of the round trip."""
        return self.responded_at_ms - self.requested_at_ms


@dataclass(frozen=True, slots=True, kw_only=True)
class ServerClock:
    """Linear fit to the comparisons: page_ms = zero_ms + (server_s - zero_s) * ms_per_s.

    Attributes:
        zero_s, zero_ms: The same moment by both clocks.
        ms_per_s: 1000 plus the drift between the clocks.
        error_ms: Bound of the error: half of the longest round trip used.
    """

    zero_s: float
    zero_ms: float
    ms_per_s: float
    error_ms: float

    @classmethod
    def of(cls, comparisons: Sequence[ClockComparison]) -> "ServerClock":
        """Fit the comparisons with the shortest round trips; at least one is needed."""
        fastest_ms = min(one.round_trip_ms for one in comparisons)
        used = [one for one in comparisons if one.round_trip_ms <= fastest_ms + MAX_EXTRA_MS]
        server_ms = np.array([one.server_s for one in used]) * 1000.0
        page_ms = np.array([0.5 * (one.requested_at_ms + one.responded_at_ms) for one in used])
        ahead_ms = page_ms - server_ms
        zero_ms = float(server_ms.mean())
        drift = 0.0
        if np.ptp(server_ms) >= MIN_SPAN_MS:
            since_ms = server_ms - zero_ms
            drift = float(since_ms @ (ahead_ms - ahead_ms.mean()) / (since_ms @ since_ms))
        if abs(drift) > MAX_DRIFT_RATIO:
            drift = 0.0
        return cls(
            zero_s=zero_ms / 1000.0,
            zero_ms=zero_ms + float(ahead_ms.mean() if drift else np.median(ahead_ms)),
            ms_per_s=1000.0 * (1.0 + drift),
            error_ms=0.5 * max(one.round_trip_ms for one in used),
        )

    def page_ms(self, server_s: float) -> float:
        """Convert a server time to a page time."""
        return self.zero_ms + (server_s - self.zero_s) * self.ms_per_s
