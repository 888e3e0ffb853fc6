"""Board options of the command line. No heavy imports, so that `--help` is fast."""

from dataclasses import dataclass
from enum import StrEnum


class Pattern(StrEnum):
    """Calibration pattern."""

    DOTS = "dots"
    CHECKERBOARD = "checkerboard"
    CHARUCO = "charuco"


class Layout(StrEnum):
    """Layout of dots (symmetric, asymmetric) or of a ChArUco board (newer, older)."""

    SYMMETRIC = "symmetric"
    ASYMMETRIC = "asymmetric"
    NEWER = "newer"
    OLDER = "older"


@dataclass(frozen=True, slots=True, kw_only=True)
class BoardOptions:
    """Options that describe a board; None if not given."""

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
