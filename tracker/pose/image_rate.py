"""Image period from capture times, and the longest gap allowed between two images.

A low image rate is allowed, so a gap is defined in image periods.
"""

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np


def image_period_s(times_s: Sequence[float], *, min_intervals: int = 1) -> float | None:
    """Return the median time between two images [s]; None with fewer than `min_intervals` intervals.

    For an even number of intervals this is the lower median, so that a single gap among few images does not
    determine the period. Times that do not increase are ignored.
    """
    intervals = np.sort(np.diff(np.asarray(times_s, dtype=np.float64)))
    intervals = intervals[intervals > 0.0]
    if len(intervals) < max(1, min_intervals):
        return None
    return float(intervals[(len(intervals) - 1) // 2])


@dataclass(frozen=True, slots=True, kw_only=True)
class GapLimit:
    """Limits of the time between two images, for any image rate.

    Attributes:
        max_periods: image periods. Six, because a camera of 5 to 10 images/s on a loaded machine has gaps of
            0.54 s. Higher: lost images go unnoticed. Lower: such a camera captures nothing.
        always_allowed_s: lower bound of the limit; a hand cannot leave a landmark and return in this time.
        max_s: upper bound of the limit; in a longer time a hand can rest at two positions.
    """

    max_periods: float = 6.0
    always_allowed_s: float = 0.25
    max_s: float = 1.0

    def allowed_s(self, period_s: float | None) -> float:
        """Return the longest allowed gap [s] at this image period; the lower bound while it is unknown."""
        scaled_s = 0.0 if period_s is None else self.max_periods * period_s
        return min(self.max_s, max(self.always_allowed_s, scaled_s))
