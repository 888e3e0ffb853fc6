"""The wall clock, and how a moment of it is written."""

from collections.abc import Callable
from datetime import UTC, datetime
from typing import Literal, TypeAlias

Clock: TypeAlias = Callable[[], datetime]


def utc_now() -> datetime:
    """The wall clock, in UTC."""
    return datetime.now(tz=UTC)


def utc_text(at: datetime, *, timespec: Literal["seconds", "milliseconds"] = "milliseconds") -> str:
    """A moment of any time zone as UTC in ISO 8601, with a Z at its end."""
    return at.astimezone(UTC).isoformat(timespec=timespec).replace("+00:00", "Z")
