"""In which unit translations are written."""

from enum import StrEnum


class Unit(StrEnum):
    """In which unit translations are written."""

    MM = "mm"
    CM = "cm"
    M = "m"

    @property
    def in_mm(self) -> float:
        """How many millimetres one is."""
        return {Unit.MM: 1.0, Unit.CM: 10.0, Unit.M: 1000.0}[self]
