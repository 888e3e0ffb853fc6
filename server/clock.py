"""Wall clock and its text format.

A wall clock can be set, by a person or by NTP, while the server runs. Times of day come from `utc_now`;
durations are measured by a monotonic clock, and what lasts until a time of day by a `SteadyClock`.
"""

import time
from collections.abc import Callable
from datetime import UTC, datetime, timedelta
from typing import Literal, TypeAlias

Clock: TypeAlias = Callable[[], datetime]


def utc_now() -> datetime:
    """Return the present time in UTC."""
    return datetime.now(tz=UTC)


def elapsed_s() -> float:
    """Return monotonic time, which includes the sleep of the computer where the system can tell it."""
    boot_time = getattr(time, "CLOCK_BOOTTIME", None)
    return time.monotonic() if boot_time is None else time.clock_gettime(boot_time)


def slept_s() -> float:
    """Return how long the computer slept since its start, where the system can tell it."""
    return elapsed_s() - time.monotonic()


class SteadyClock:
    """A clock in UTC that nobody can set: the wall clock when it was made, and the time since then."""

    def __init__(self, *, wall: Clock = utc_now, elapsed_s: Callable[[], float] = elapsed_s) -> None:
        self._elapsed_s = elapsed_s
        self._began_at, self._began_s = wall(), elapsed_s()

    def __call__(self) -> datetime:
        """Return the present time in UTC."""
        return self._began_at + timedelta(seconds=self._elapsed_s() - self._began_s)


class AgeClock:
    """The monotonic clock of images, plus the sleep of the computer since this was made.

    A check on anatomy is not younger because the computer slept after it. One that was made after the sleep
    looks older than it is, which asks for another one early.
    """

    def __init__(
        self, *, images_s: Callable[[], float] = time.monotonic, elapsed_s: Callable[[], float] = elapsed_s
    ) -> None:
        self._elapsed_s = elapsed_s
        self._ahead_s = elapsed_s() - images_s()

    def __call__(self) -> float:
        """Return the present time in seconds; without sleep, that of the image clock."""
        return self._elapsed_s() - self._ahead_s


def utc_text(at: datetime, *, timespec: Literal["seconds", "milliseconds"] = "milliseconds") -> str:
    """Format a time as UTC in ISO 8601 with the suffix Z."""
    return at.astimezone(UTC).isoformat(timespec=timespec).replace("+00:00", "Z")
