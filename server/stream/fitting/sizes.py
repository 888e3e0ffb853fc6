"""The steps of size in which the picture goes out, and what a viewer may choose."""

from collections.abc import Sequence
from enum import StrEnum

from tracker.errors import NavigationError


class Size(StrEnum):
    """A step of size, the largest first."""

    FULL = "full"
    HALF = "half"
    QUARTER = "quarter"

    @property
    def scale_ratio(self) -> float:
        """Width and height of the picture that is sent, of those of the camera's image."""
        return {Size.FULL: 1.0, Size.HALF: 0.5, Size.QUARTER: 0.25}[self]

    @property
    def smaller(self) -> "Size":
        """The next step down; the smallest stays."""
        return {Size.FULL: Size.HALF}.get(self, Size.QUARTER)

    def at_most(self, limit: "Size") -> "Size":
        """This size, or the limit where that is smaller."""
        return min(self, limit, key=lambda size: size.scale_ratio)

    @property
    def larger(self) -> "Size":
        """The next step up; the largest stays."""
        return {Size.QUARTER: Size.HALF}.get(self, Size.FULL)


class Choice(StrEnum):
    """What a viewer asks for: one size for good, or the one that its line carries."""

    AUTO = "auto"
    FULL = "full"
    HALF = "half"
    QUARTER = "quarter"

    @property
    def fixed(self) -> Size | None:
        """The size that was asked for; None for whatever the line carries."""
        return None if self is Choice.AUTO else Size(self.value)


class SizeUnknown(NavigationError):
    """There is no picture of this size."""

    def __init__(self, asked: str, known: Sequence[str] = tuple(Choice)) -> None:
        super().__init__(
            "SIZE_UNKNOWN",
            f"there is no size '{asked[:40]}', only {', '.join(known)}",
            "Ask for one of these sizes.",
            {"asked": asked[:40], "known": list(known)},
        )

    def __reduce__(self) -> tuple[object, ...]:
        """Made again from what it was made of."""
        return type(self), (self.context["asked"], self.context["known"])


def choice_from_text(text: str) -> Choice:
    """The choice of this name.

    Raises:
        SizeUnknown: there is none.
    """
    try:
        return Choice(text)
    except ValueError:
        raise SizeUnknown(text) from None
