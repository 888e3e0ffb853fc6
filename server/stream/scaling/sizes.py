"""Picture sizes, and the choices of a viewer."""

from collections.abc import Sequence
from enum import StrEnum
from typing import TypeVar

from tracker.errors import NavigationError

Choice = TypeVar("Choice", bound=StrEnum)


class PictureSize(StrEnum):
    """Picture size, the largest first."""

    FULL = "full"
    HALF = "half"
    QUARTER = "quarter"

    @property
    def scale_ratio(self) -> float:
        """Scale of the picture relative to the camera's image."""
        return {PictureSize.FULL: 1.0, PictureSize.HALF: 0.5, PictureSize.QUARTER: 0.25}[self]

    @property
    def smaller(self) -> "PictureSize":
        """The next smaller size, or the smallest."""
        return {PictureSize.FULL: PictureSize.HALF}.get(self, PictureSize.QUARTER)

    def at_most(self, limit: "PictureSize") -> "PictureSize":
        """Return the smaller of this size and the limit."""
        return min(self, limit, key=lambda size: size.scale_ratio)

    @property
    def larger(self) -> "PictureSize":
        """The next larger size, or the largest."""
        return {PictureSize.QUARTER: PictureSize.HALF}.get(self, PictureSize.FULL)


class SizeChoice(StrEnum):
    """A fixed size, or auto for the size that suits the connection."""

    AUTO = "auto"
    FULL = "full"
    HALF = "half"
    QUARTER = "quarter"

    @property
    def fixed(self) -> PictureSize | None:
        """The fixed size; None for auto."""
        return None if self is SizeChoice.AUTO else PictureSize(self.value)


class ChoiceUnknown(NavigationError):
    """The requested choice, such as a size, does not exist."""

    def __init__(self, kind: str, requested: str, known: Sequence[str]) -> None:
        super().__init__(
            f"{kind.upper()}_UNKNOWN",
            f"there is no {kind} '{requested[:40]}', available are {', '.join(known)}",
            "Use one of these.",
            {"kind": kind, "requested": requested[:40], "known": list(known)},
        )

    def __reduce__(self) -> tuple[object, ...]:
        """Pickle by the constructor's arguments."""
        return type(self), (self.context["kind"], self.context["requested"], self.context["known"])


def choice_from_text(kind: str, text: str, choices: type[Choice]) -> Choice:
    """Return the choice of this name.

    Raises:
        ChoiceUnknown: there is none.
    """
    try:
        return choices(text)
    except ValueError:
        raise ChoiceUnknown(kind, text, tuple(choices)) from None
