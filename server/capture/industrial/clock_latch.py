"""Reads an industrial camera's clock, where supported."""

import contextlib
from collections.abc import Callable

from server.capture.device_clock import DeviceClock
from server.capture.industrial.device import Features

# Interval in which a crystal drifts by up to a millisecond.
RENEWED_EVERY_S = 10.0
# Of this many readings the one with the shortest round trip is used, which bounds the error.
READINGS = 3
NANOSECONDS_PER_S = 1e9
# Command and value: SFNC 2.1 in nanoseconds, GigE Vision 1 in ticks.
LATCHES = (("TimestampLatch", "TimestampLatchValue"), ("GevTimestampControlLatch", "GevTimestampValue"))


class LatchedClock:
    """Synchronises a `DeviceClock` with the camera's clock by latching it periodically."""

    def __init__(self, features: Features, device_clock: DeviceClock, *, clock: Callable[[], float]) -> None:
        self._features = features
        self._device_clock = device_clock
        self._clock = clock
        self._renewed_s: float | None = None
        self._is_offered = True

    def renew(self) -> None:
        """Latch the camera's clock when due, or after a jump; do nothing where it is not supported."""
        if not self._is_offered:
            return
        now_s = self._clock()
        is_due = self._renewed_s is None or now_s - self._renewed_s >= RENEWED_EVERY_S
        if not is_due and self._device_clock.is_latched:
            return
        self._renewed_s = now_s
        readings = [reading for _ in range(READINGS) if (reading := self._reading()) is not None]
        self._is_offered = bool(readings)
        if readings:
            _, device_s, monotonic_s = min(readings)
            self._device_clock.latch(device_s, monotonic_s=monotonic_s)

    def _reading(self) -> tuple[float, float, float] | None:
        """Return the round-trip time, the camera's time, and this machine's time in its middle."""
        for command, name in LATCHES:
            before_s = self._clock()
            with contextlib.suppress(OSError):
                self._features.execute(command)
                after_s = self._clock()
                value = self._features.value(name)
                if isinstance(value, int):
                    return after_s - before_s, value / self._ticks_per_s(name), (before_s + after_s) / 2.0
        return None

    def _ticks_per_s(self, name: str) -> float:
        frequency_hz = self._features.value("GevTimestampTickFrequency") if name.startswith("Gev") else None
        return (
            float(frequency_hz)
            if isinstance(frequency_hz, int | float) and frequency_hz
            else NANOSECONDS_PER_S
        )
