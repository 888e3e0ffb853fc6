"""Rulers on a printed page, to verify its scale with another ruler."""

from collections.abc import Iterator

from server.printing.sheet import Label, Line, Point

MM_PER_INCH = 25.4
RULER_MM, RULER_INCHES = 50, 2
MAX_TICK_MM = 5.0


def millimetre_ruler(at_mm: Point, *, length_mm: int = RULER_MM) -> Iterator[Line | Label]:
    """Yield a ruler in mm with its zero at this point and its ticks upwards."""
    return _ruler(at_mm, unit_mm=1.0, units=length_mm, long_each=10, word="mm")


def inch_ruler(at_mm: Point, *, inches: int = RULER_INCHES) -> Iterator[Line | Label]:
    """Yield a ruler in eighths of an inch."""
    return _ruler(at_mm, unit_mm=MM_PER_INCH / 8.0, units=inches * 8, long_each=8, word="in")


def vertical_ruler(at_mm: Point, *, length_mm: int = RULER_MM) -> Iterator[Line]:
    """Yield a ruler in mm down the page from this point, ticks to the right, without numbers.

    Some printers stretch only in the direction of the paper feed.
    """
    x, top = at_mm
    yield Line(start_mm=(x, top), end_mm=(x, top + length_mm), width_mm=0.15)
    for tick in range(length_mm + 1):
        long = MAX_TICK_MM if tick % 10 == 0 else 3.5 if tick % 5 == 0 else 2.0
        yield Line(start_mm=(x, top + tick), end_mm=(x + long, top + tick), width_mm=0.15)


def _ruler(at_mm: Point, *, unit_mm: float, units: int, long_each: int, word: str) -> Iterator[Line | Label]:
    """Yield a line with a tick per unit, and a longer, numbered tick at every `long_each`."""
    left, base = at_mm
    yield Line(start_mm=(left, base), end_mm=(left + units * unit_mm, base), width_mm=0.15)
    for tick in range(units + 1):
        x = left + tick * unit_mm
        numbered = tick % long_each == 0
        height = 5.0 if numbered else 3.5 if tick % (long_each // 2) == 0 else 2.0
        yield Line(start_mm=(x, base), end_mm=(x, base - height), width_mm=0.15)
        if numbered:
            number = tick if long_each == 10 else tick // long_each
            yield Label(text=f"{number}", at_mm=(x - 1.0, base - 6.0), size_mm=3.0)
    yield Label(text=word, at_mm=(left + units * unit_mm + 3.0, base), size_mm=3.5)
