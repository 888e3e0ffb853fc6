"""Wall clock and its text format."""

from collections.abc import Callable
from datetime import UTC, datetime
from typing import Literal, TypeAlias

Clock: TypeAlias = Callable[[], datetime]


def utc_now() -> datetime:
    """Return the present time in UTC."""
    return datetime.now(tz=UTC)


def utc_text(at: datetime, *, timespec: Literal["seconds", "milliseconds"] = "milliseconds") -> str:
    """Format a time as UTC in ISO 8601 with the suffix Z."""
    return at.astimezone(UTC).isoformat(timespec=timespec).replace("+00:00", "Z")
