"""A device's own clock, mapped to this machine's monotonic clock.

Its beginning is any, and its rate a little off: a crystal gains or loses up to 0.1 ms a second. Where the
device can be asked for its time, the offset between the clocks is known. Where it cannot, the offset is the
least difference between arrival and device time of late: some image always arrives nearly undelayed, so the
lower envelope of the delays is that of the way at its best, and what an image took longer is its own delay.
Exposure, transfer and encoding at their best stay unknown, so an image looks younger by them, never older.
"""

import math

from server.capture.driver_clock import MAX_AHEAD_S

# The least difference is looked for in this time: long enough for one undelayed image, and short enough that
# a crystal drifts by no more than a millisecond.
WINDOW_S = 10.0
BUCKETS = 10
# An image can make up for the delay of the one before, of which only the known part is counted: a device's
# time that gains so much more on the arrivals was set forward.
MAX_GAIN_S = 0.5


class DeviceClock:
    """Times of one device. Without a clock of its own: times are passed in.

    Attributes:
        jumps: how often the device's clock was set anew.
    """

    def __init__(self) -> None:
        self.jumps = 0
        self.restart()

    def restart(self) -> None:
        """The device was opened again: its clock may be another."""
        self._last_device_s = -math.inf
        self._last_arrived_s = -math.inf
        self._delay_s = 0.0
        self._latched_s: float | None = None
        self._min_s: dict[int, float] = {}

    def latch(self, device_s: float, *, monotonic_s: float) -> None:
        """Both clocks were read at one moment: from here on no lower envelope is needed."""
        self._latched_s = monotonic_s - device_s

    def monotonic_s(self, device_s: float, *, arrived_s: float) -> float:
        """When an image was taken, by the monotonic clock; 0 where the device's clock did not go on.

        Args:
            device_s: its time by the device.
            arrived_s: when it arrived.
        """
        is_first = math.isinf(self._last_device_s)
        went_on = device_s > self._last_device_s
        gain_s = (device_s - self._last_device_s) - (arrived_s - self._last_arrived_s)
        self._last_device_s, self._last_arrived_s = device_s, arrived_s
        is_ahead = self._latched_s is not None and device_s + self._latched_s > arrived_s + MAX_AHEAD_S
        if not is_first and (not went_on or is_ahead or gain_s > self._delay_s + MAX_GAIN_S):
            # Nothing that was known of it holds.
            self.jumps += 1
            self._latched_s = None
            self._min_s.clear()
        at_s = device_s + self._offset_s(arrived_s - device_s, arrived_s)
        self._delay_s = arrived_s - at_s
        return at_s if went_on else 0.0

    @property
    def is_latched(self) -> bool:
        """Whether the offset is known by reading both clocks."""
        return self._latched_s is not None

    def _offset_s(self, difference_s: float, arrived_s: float) -> float:
        if self._latched_s is not None:
            return self._latched_s
        bucket = math.floor(arrived_s * BUCKETS / WINDOW_S)
        self._min_s[bucket] = min(difference_s, self._min_s.get(bucket, math.inf))
        for old in [one for one in self._min_s if one <= bucket - BUCKETS]:
            del self._min_s[old]
        return min(self._min_s.values())
