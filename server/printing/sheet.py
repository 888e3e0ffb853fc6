"""Content of a sheet of paper: all lengths in mm from its top-left corner, x right and y down."""

from dataclasses import dataclass
from typing import TypeAlias

Point: TypeAlias = tuple[float, float]


@dataclass(frozen=True, slots=True, kw_only=True)
class Fill:
    """A polygon filled with black or grey ink, or with the white of the paper.

    Attributes:
        corners_mm: Corners in order.
        white: Whether it is white.
        grey_ratio: Brightness of the ink, from black (0) to white (1).
    """

    corners_mm: tuple[Point, ...]
    white: bool = False
    grey_ratio: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Disc:
    """A circle filled with black ink."""

    centre_mm: Point
    radius_mm: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Line:
    """A thin line."""

    start_mm: Point
    end_mm: Point
    width_mm: float = 0.2


@dataclass(frozen=True, slots=True, kw_only=True)
class Label:
    """A line of text that starts at a point of its baseline."""

    text: str
    at_mm: Point
    size_mm: float = 3.5


Mark: TypeAlias = Fill | Disc | Line | Label


@dataclass(frozen=True, slots=True, kw_only=True)
class Sheet:
    """One page.

    Attributes:
        title: Title of the file.
        size_mm: Width and height of the paper.
        marks: Marks in drawing order.
    """

    title: str
    size_mm: Point
    marks: tuple[Mark, ...]


def rectangle(left_mm: float, top_mm: float, width_mm: float, height_mm: float) -> tuple[Point, ...]:
    """Return the four corners of a rectangle."""
    right, bottom = left_mm + width_mm, top_mm + height_mm
    return ((left_mm, top_mm), (right, top_mm), (right, bottom), (left_mm, bottom))
