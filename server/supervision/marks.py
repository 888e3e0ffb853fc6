"""Pointers and drawings on the picture; each belongs to the image that it was made on, and goes with it.

Marks are kept nowhere but as lines in the log; they do not outlast the process.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from typing import TypeAlias

from server.security import Person

Pixel: TypeAlias = tuple[float, float]

# A pointer that does not move says nothing any more.
POINTER_GOES_AFTER_S = 2.0
MAX_DRAWINGS = 60
MAX_DRAWINGS_A_PERSON = 20
MAX_POINTS_A_DRAWING = 400


class Shape(StrEnum):
    """What is drawn."""

    PEN = "pen"  # through all its points
    ARROW = "arrow"  # from the first to the second point, its head at the second
    CIRCLE = "circle"  # about the first point, through the second


@dataclass(frozen=True, slots=True, kw_only=True)
class Moment:
    """The image that somebody saw while they made a mark.

    Attributes:
        image_number: of the image.
        captured_at_s: when it was captured, by the server's monotonic clock.
    """

    image_number: int
    captured_at_s: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Pointer:
    """Where somebody points now.

    Attributes:
        seat: the page it comes from.
        person: whose it is.
        at_px: x, y in pixels of the whole image.
        moment: the image they saw.
        moved_at_s: when it was moved for the last time.
    """

    seat: int
    person: Person
    at_px: Pixel
    moment: Moment
    moved_at_s: float


@dataclass(slots=True, kw_only=True)
class Drawing:
    """Something drawn; only points are ever added to it.

    Attributes:
        key: tells it from all others of this run of the server.
        seat: the page it comes from.
        person: whose it is.
        shape: what it is.
        moment: the image that it was begun on.
        points_px: x, y in pixels of the whole image.
    """

    key: str
    seat: int
    person: Person
    shape: Shape
    moment: Moment
    points_px: list[Pixel] = field(default_factory=list)


class Marks:
    """All that is pointed at and drawn. Pure: the time is handed in.

    Args:
        fades_after_s: how long a drawing stays, counted from the image that it was made on: patient and
            camera move, and what was true of that image is not true for ever.
    """

    def __init__(self, *, fades_after_s: float) -> None:
        self.fades_after_s = fades_after_s
        self._pointers: dict[int, Pointer] = {}
        self._drawings: dict[str, Drawing] = {}

    def pointers(self, now_s: float) -> tuple[Pointer, ...]:
        """Those that moved within the last two seconds."""
        gone = [
            seat for seat, one in self._pointers.items() if now_s - one.moved_at_s >= POINTER_GOES_AFTER_S
        ]
        for seat in gone:
            del self._pointers[seat]
        return tuple(self._pointers.values())

    def drawings(self, now_s: float) -> tuple[Drawing, ...]:
        """Those whose moment is not over, the oldest first."""
        over = [key for key, one in self._drawings.items() if self.left_s(one, now_s) <= 0.0]
        for key in over:
            del self._drawings[key]
        return tuple(self._drawings.values())

    def left_s(self, drawing: Drawing, now_s: float) -> float:
        """How long a drawing still stays."""
        return drawing.moment.captured_at_s + self.fades_after_s - now_s

    def point(self, pointer: Pointer) -> None:
        """Somebody's pointer is here now."""
        self._pointers[pointer.seat] = pointer

    def lift(self, seat: int) -> None:
        """This page points at nothing any more."""
        self._pointers.pop(seat, None)

    def begin(self, drawing: Drawing) -> None:
        """One more drawing; where there are too many, the oldest goes."""
        own = [key for key, one in self._drawings.items() if one.person.id == drawing.person.id]
        if len(own) >= MAX_DRAWINGS_A_PERSON:
            del self._drawings[own[0]]
        elif len(self._drawings) >= MAX_DRAWINGS:
            del self._drawings[next(iter(self._drawings))]
        self._drawings[drawing.key] = drawing

    def extend(self, key: str, points_px: Sequence[Pixel]) -> bool:
        """Draw on; False when that would be too long. One that is gone meanwhile stays gone."""
        drawing = self._drawings.get(key)
        if drawing is None:
            return True
        if len(drawing.points_px) + len(points_px) > MAX_POINTS_A_DRAWING:
            return False
        drawing.points_px.extend(points_px)
        return True

    def undo(self, person_id: str) -> bool:
        """Take back the newest drawing of a person; whether there was one."""
        own = [key for key, one in self._drawings.items() if one.person.id == person_id]
        if own:
            del self._drawings[own[-1]]
        return bool(own)

    def clear(self, person_id: str | None = None) -> int:
        """Take away a person's drawings, or all of them; how many."""
        gone = [key for key, one in self._drawings.items() if person_id in (None, one.person.id)]
        for key in gone:
            del self._drawings[key]
        return len(gone)
