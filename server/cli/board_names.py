"""The words that describe a board on the command line; light, so that `--help` answers at once."""

from dataclasses import dataclass
from enum import StrEnum


class Pattern(StrEnum):
    """What is printed on the board."""

    DOTS = "dots"
    CHECKERBOARD = "checkerboard"
    CHARUCO = "charuco"


class Layout(StrEnum):
    """Of dots: symmetric or asymmetric; of ChArUco: newer or older."""

    SYMMETRIC = "symmetric"
    ASYMMETRIC = "asymmetric"
    NEWER = "newer"
    OLDER = "older"


@dataclass(frozen=True, slots=True, kw_only=True)
class BoardOptions:
    """The options that describe a board, None where they were left out."""

    pattern: Pattern
    size: str
    pitch_mm: float | None = None
    square_mm: float | None = None
    marker_mm: float | None = None
    dictionary: str | None = None
    fiducials: str | None = None
    layout: Layout | None = None
    inset: str | None = None
    inset_square_mm: float | None = None
