"""Unit of the translations in a pose file."""

from enum import StrEnum


class Unit(StrEnum):
    """Unit of the translations in a pose file."""

    MM = "mm"
    CM = "cm"
    M = "m"

    @property
    def in_mm(self) -> float:
        """Length of the unit in mm."""
        return {Unit.MM: 1.0, Unit.CM: 10.0, Unit.M: 1000.0}[self]
