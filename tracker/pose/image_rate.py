"""The image rate of a measurement, from the times of its own images, and how long a gap it allows.

A camera with few images a second is no fault. What counts as a gap is therefore a number of image periods.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np


def image_period_s(times_s: Sequence[float], *, min_intervals: int = 1) -> float | None:
    """Median time between two images [s]; None with fewer intervals than `min_intervals`.

    Of two middle intervals the shorter one counts: a single gap between few images must not pass for the
    period. Times that do not increase are left out.
    """
    intervals = np.sort(np.diff(np.asarray(times_s, dtype=np.float64)))
    intervals = intervals[intervals > 0.0]
    if len(intervals) < max(1, min_intervals):
        return None
    return float(intervals[(len(intervals) - 1) // 2])


@dataclass(frozen=True, slots=True, kw_only=True)
class GapLimit:
    """How much time may pass between two images, at any image rate.

    Attributes:
        max_periods: image periods. Six, because a camera of 5 to 10 images/s on a loaded machine has gaps of
            0.54 s. Higher: lost images go unnoticed. Lower: such a camera captures nothing.
        always_allowed_s: a gap that no image rate forbids; in a shorter one no hand leaves a landmark and
            comes back.
        max_s: a gap that no image rate allows; in a longer one a hand can rest on two places.
    """

    max_periods: float = 6.0
    always_allowed_s: float = 0.25
    max_s: float = 1.0

    def allowed_s(self, period_s: float | None) -> float:
        """The longest allowed gap [s] at this image period; the shortest limit while it is unknown."""
        scaled_s = 0.0 if period_s is None else self.max_periods * period_s
        return min(self.max_s, max(self.always_allowed_s, scaled_s))
