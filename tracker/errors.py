"""Exceptions and warnings with a stable code, a message with numbers, and a remedy.

    NavigationError
    ├── InvalidInput        a file, an image or a number is invalid
    ├── CalibrationError    a calibration is missing, rejected, or does not match the images
    ├── PlanError           a plan is missing or cannot be carried out
    └── RegistrationError   plan and patient are not registered, or do not match

A marker that is not detected is a value, `tracker.pose.Unseen`, not an exception.
"""

from collections.abc import Mapping
from dataclasses import dataclass, field


class NavigationError(Exception):
    """Base class of all errors that a user can act on.

    Attributes:
        code: stable identifier in UPPER_SNAKE_CASE.
        message: what happened in numbers and what was allowed, without a final full stop.
        remedy: what to do next, one full sentence.
        context: the numbers of the message by name, each with its unit in the name.
    """

    def __init__(
        self, code: str, message: str, remedy: str, context: Mapping[str, object] | None = None
    ) -> None:
        super().__init__(f"{message}. {remedy}")
        self.code = code
        self.message = message
        self.remedy = remedy
        self.context: dict[str, object] = dict(context or {})

    def __reduce__(self) -> tuple[object, ...]:
        """Support pickling with all four parts: errors cross from the tracking process to the server."""
        return type(self), (self.code, self.message, self.remedy, self.context)


class InvalidInput(NavigationError):
    """A file, an image or a number from the caller is invalid."""


class CalibrationError(NavigationError):
    """A camera or tool calibration is missing, rejected by its gate, or does not match the images."""


class PlanError(NavigationError):
    """A plan is missing or cannot be carried out."""


class RegistrationError(NavigationError):
    """Plan and patient are not registered, or do not match."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Remark:
    """A warning with a code, as an error has, about work that was completed.

    Attributes:
        code: stable identifier in UPPER_SNAKE_CASE, for machines.
        message: what was found in numbers, without a final full stop.
        remedy: what to do about it, in full sentences; empty if there is nothing to do.
        context: the numbers of the message by name, each with its unit in the name.
    """

    code: str
    message: str
    remedy: str = ""
    context: Mapping[str, object] = field(default_factory=dict)

    @classmethod
    def from_error(cls, error: "NavigationError") -> "Remark":
        """Return an error as a warning about work that went on without its part."""
        return cls(code=error.code, message=error.message, remedy=error.remedy, context=dict(error.context))
