"""What can go wrong, in sentences with numbers and a remedy.

    NavigationError
    ├── InvalidInput        what was handed in cannot be used
    ├── CalibrationError    a calibration cannot be trusted
    ├── PlanError           a plan cannot be carried out
    └── RegistrationError   plan and patient do not fit together

A marker that is not seen is no error: it is a value, `tracker.pose.Unseen`.
"""

from collections.abc import Mapping


class NavigationError(Exception):
    """One thing that went wrong, told so that a person can mend it.

    Attributes:
        code: stable identifier in UPPER_SNAKE_CASE, for machines.
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
        """Errors cross from the tracking process to the server; all four parts go with them."""
        return type(self), (self.code, self.message, self.remedy, self.context)


class InvalidInput(NavigationError):
    """What was handed in (a file, an image, a number) cannot be used."""


class CalibrationError(NavigationError):
    """A camera or tool calibration is missing, failed its gate, or does not fit the images."""


class PlanError(NavigationError):
    """A plan is missing or cannot be carried out."""


class RegistrationError(NavigationError):
    """Plan and patient are not registered, or do not fit together."""
