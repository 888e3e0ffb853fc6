"""Maps the clock of a device to the monotonic clock of this machine.

The device clock has an arbitrary origin, and its crystal drifts by up to 0.1 ms per second. If the device
time can be read, the offset between the clocks is known. Otherwise the offset is the minimum difference
between arrival and device time within a window: some image always arrives nearly undelayed, and the excess of
another image is its own delay. The minimum of exposure, transfer and encoding remains unknown; an image looks
younger by it, never older.
"""

import math

from server.capture.driver_clock import MAX_AHEAD_S

# Window of the minimum: long enough for one undelayed image, and short enough that a crystal drifts by no
# more than a millisecond.
WINDOW_S = 10.0
BUCKETS = 10
# An image can catch up the delay of the one before, of which only the known part is counted: a device time
# that gains more than this on the arrivals was set forward.
MAX_GAIN_S = 0.5


class DeviceClock:
    """Clock of one device. Times are passed in.

    Attributes:
        jumps: number of jumps of the device's clock.
    """

    def __init__(self) -> None:
        self.jumps = 0
        self.restart()

    def restart(self) -> None:
        """Reset after the device was reopened: its clock may differ."""
        self._last_device_s = -math.inf
        self._last_arrived_s = -math.inf
        self._delay_s = 0.0
        self._latched_s: float | None = None
        self._min_s: dict[int, float] = {}

    def latch(self, device_s: float, *, monotonic_s: float) -> None:
        """Set the offset from a simultaneous reading of both clocks, instead of the minimum difference."""
        self._latched_s = monotonic_s - device_s

    def monotonic_s(self, device_s: float, *, arrived_s: float) -> float:
        """Return the capture time by the monotonic clock; 0 if the device's clock did not advance.

        Args:
            device_s: capture time by the device.
            arrived_s: arrival time.
        """
        is_first = math.isinf(self._last_device_s)
        went_on = device_s > self._last_device_s
        gain_s = (device_s - self._last_device_s) - (arrived_s - self._last_arrived_s)
        self._last_device_s, self._last_arrived_s = device_s, arrived_s
        is_ahead = self._latched_s is not None and device_s + self._latched_s > arrived_s + MAX_AHEAD_S
        if not is_first and (not went_on or is_ahead or gain_s > self._delay_s + MAX_GAIN_S):
            # All earlier differences are invalid.
            self.jumps += 1
            self._latched_s = None
            self._min_s.clear()
        at_s = device_s + self._offset_s(arrived_s - device_s, arrived_s)
        self._delay_s = arrived_s - at_s
        return at_s if went_on else 0.0

    @property
    def is_latched(self) -> bool:
        """Whether the offset comes from reading both clocks."""
        return self._latched_s is not None

    def _offset_s(self, difference_s: float, arrived_s: float) -> float:
        if self._latched_s is not None:
            return self._latched_s
        bucket = math.floor(arrived_s * BUCKETS / WINDOW_S)
        self._min_s[bucket] = min(difference_s, self._min_s.get(bucket, math.inf))
        for old in [one for one in self._min_s if one <= bucket - BUCKETS]:
            del self._min_s[old]
        return min(self._min_s.values())
