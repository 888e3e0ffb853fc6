"""Capture times: those of the driver if plausible, otherwise the arrival times.

OpenCV's V4L2 backend reports the time of the buffer as `CAP_PROP_POS_MSEC`. A time that is in the future, not
after the previous one, or older than a second is replaced by the arrival time; after 15 such times the clock
is no longer used. An image that waited while the machine was suspended keeps its age.
"""

import math

from server.live import ImageClock

# Tolerance: the driver computes its time from the camera's.
MAX_AHEAD_S = 0.005
# Maximum age of an undelayed image: exposure, transfer and a few buffers of a slow camera.
MAX_AGE_S = 1.0
# After this many plausible times in a row, an old time is an old image and not a clock error.
TRUSTED_AFTER = 30
# Excess of implausible over plausible times at which the clock is abandoned.
GIVEN_UP_AFTER = 15
# Minimum increment of capture times, also when the clock is changed between two images.
MIN_STEP_S = 1e-6


class DriverClock:
    """Checks the driver's times image by image. Both clocks are monotonic, in seconds."""

    def __init__(self) -> None:
        self._last_driver_s = -math.inf
        self._last_s = -math.inf
        self._plausible_in_row = 0
        self._implausible = 0
        self._gave_up = False
        self._is_used = True

    @property
    def clock(self) -> ImageClock:
        """The clock of the last image's time; before the first one, the driver's."""
        return ImageClock.DRIVER if self._is_used else ImageClock.ARRIVAL

    @property
    def gave_up(self) -> bool:
        """Whether the driver's clock was implausible so often that it is no longer used."""
        return self._gave_up

    def restart(self) -> None:
        """Reset after the device was reopened: its first time is not compared with earlier ones."""
        self._last_driver_s = -math.inf

    def captured_at_s(self, driver_s: float, *, arrived_s: float) -> float:
        """Return the capture time; never later than the arrival, and strictly increasing.

        Args:
            driver_s: time of the driver; 0 without one.
            arrived_s: arrival time.
        """
        is_plausible = self._judge(driver_s, arrived_s)
        self._is_used = is_plausible and not self._gave_up
        at_s = min(driver_s, arrived_s) if self._is_used else arrived_s
        self._last_s = max(at_s, self._last_s + MIN_STEP_S)
        return self._last_s

    def _judge(self, driver_s: float, arrived_s: float) -> bool:
        grows = driver_s > self._last_driver_s
        self._last_driver_s = driver_s
        age_s = arrived_s - driver_s
        is_young = -MAX_AHEAD_S <= age_s <= MAX_AGE_S
        if grows and is_young and driver_s > 0.0:
            self._plausible_in_row += 1
            self._implausible = max(0, self._implausible - 1)
            return True
        # An image that was buffered while this machine was busy; its arrival time would make it look new.
        is_late = grows and age_s > MAX_AGE_S and self._plausible_in_row >= TRUSTED_AFTER
        self._implausible += 1
        if not is_late:
            self._plausible_in_row = 0
        self._gave_up = self._gave_up or self._implausible >= GIVEN_UP_AFTER
        return is_late
