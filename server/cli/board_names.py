"""Board options of the command line. No heavy imports, so that `--help` is fast."""

from dataclasses import dataclass
from enum import StrEnum

# What the two numbers of --size count, in help and remedies.
SIZE_COUNTS = "dots, inner corners of a checkerboard, squares of a ChArUco board, tags of an AprilGrid"


class Pattern(StrEnum):
    """Calibration pattern."""

    DOTS = "dots"
    CHECKERBOARD = "checkerboard"
    CHARUCO = "charuco"
    APRILGRID = "aprilgrid"


class Layout(StrEnum):
    """Layout of dots (symmetric, asymmetric) or of a ChArUco board (newer, older)."""

    SYMMETRIC = "symmetric"
    ASYMMETRIC = "asymmetric"
    NEWER = "newer"
    OLDER = "older"


@dataclass(frozen=True, slots=True, kw_only=True)
class BoardOptions:
    """Options that describe a board; None if not given.

    They have no defaults, so that the type check names each command that does not pass a new one.
    """

    pattern: Pattern
    size: str
    pitch_mm: float | None
    square_mm: float | None
    marker_mm: float | None
    tag_mm: float | None
    gap_mm: float | None
    dictionary: str | None
    fiducials: str | None
    layout: Layout | None
    inset: str | None = None
    inset_square_mm: float | None = None
