"""Pointers and drawings on the video image; each belongs to one image, and expires with it.

Marks are kept in memory only, with one line each in the log; they do not survive the process.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from typing import TypeAlias

from server.security import Person

Pixel: TypeAlias = tuple[float, float]

# A pointer that has not moved for this long is removed.
POINTER_TIMEOUT_S = 2.0
MAX_DRAWINGS = 60
MAX_DRAWINGS_PER_PERSON = 20
MAX_POINTS_PER_DRAWING = 400


class Shape(StrEnum):
    """Shape of a drawing."""

    PEN = "pen"  # through all its points
    ARROW = "arrow"  # from the first to the second point, its head at the second
    CIRCLE = "circle"  # about the first point, through the second


@dataclass(frozen=True, slots=True, kw_only=True)
class Moment:
    """The image that was shown when a mark was made.

    Attributes:
        image_number: number of the image.
        captured_at_s: its capture time, server's monotonic clock.
    """

    image_number: int
    captured_at_s: float


@dataclass(frozen=True, slots=True, kw_only=True)
class Pointer:
    """Current pointer of one page.

    Attributes:
        session: number of the page's session.
        person: its owner.
        at_px: x, y in pixels of the whole image.
        moment: the image that was shown.
        moved_at_s: time of its last move, monotonic.
    """

    session: int
    person: Person
    at_px: Pixel
    moment: Moment
    moved_at_s: float


@dataclass(slots=True, kw_only=True)
class Drawing:
    """A drawing; points are only ever appended.

    Attributes:
        key: unique key in this run of the server.
        session: number of the page's session.
        person: its owner.
        shape: its shape.
        moment: the image on which it was started.
        points_px: x, y in pixels of the whole image.
    """

    key: str
    session: int
    person: Person
    shape: Shape
    moment: Moment
    points_px: list[Pixel] = field(default_factory=list)


class Marks:
    """All pointers and drawings. Pure: time is passed in.

    Args:
        fades_after_s: lifetime of a drawing, from the capture of its image: patient and camera move, so a
            mark does not stay valid.
    """

    def __init__(self, *, fades_after_s: float) -> None:
        self.fades_after_s = fades_after_s
        self._pointers: dict[int, Pointer] = {}
        self._drawings: dict[str, Drawing] = {}

    def pointers(self, now_s: float) -> tuple[Pointer, ...]:
        """Return pointers that moved within the last two seconds."""
        gone = [
            session for session, one in self._pointers.items() if now_s - one.moved_at_s >= POINTER_TIMEOUT_S
        ]
        for session in gone:
            del self._pointers[session]
        return tuple(self._pointers.values())

    def drawings(self, now_s: float) -> tuple[Drawing, ...]:
        """Return drawings that have not expired, oldest first."""
        over = [key for key, one in self._drawings.items() if self.remaining_s(one, now_s) <= 0.0]
        for key in over:
            del self._drawings[key]
        return tuple(self._drawings.values())

    def remaining_s(self, drawing: Drawing, now_s: float) -> float:
        """Return the remaining lifetime of a drawing."""
        return drawing.moment.captured_at_s + self.fades_after_s - now_s

    def point(self, pointer: Pointer) -> None:
        """Set the pointer of a page."""
        self._pointers[pointer.session] = pointer

    def lift(self, session: int) -> None:
        """Remove the pointer of a page."""
        self._pointers.pop(session, None)

    def begin(self, drawing: Drawing) -> None:
        """Add a drawing; above the limits the oldest one is removed."""
        own = [key for key, one in self._drawings.items() if one.person.id == drawing.person.id]
        if len(own) >= MAX_DRAWINGS_PER_PERSON:
            del self._drawings[own[0]]
        elif len(self._drawings) >= MAX_DRAWINGS:
            del self._drawings[next(iter(self._drawings))]
        self._drawings[drawing.key] = drawing

    def extend(self, key: str, points_px: Sequence[Pixel]) -> bool:
        """Append points; return False above the maximum length. Points of an expired drawing are ignored."""
        drawing = self._drawings.get(key)
        if drawing is None:
            return True
        if len(drawing.points_px) + len(points_px) > MAX_POINTS_PER_DRAWING:
            return False
        drawing.points_px.extend(points_px)
        return True

    def undo(self, person_id: str) -> bool:
        """Remove the newest drawing of a person; return whether there was one."""
        own = [key for key, one in self._drawings.items() if one.person.id == person_id]
        if own:
            del self._drawings[own[-1]]
        return bool(own)

    def clear(self, person_id: str | None = None) -> int:
        """Remove the drawings of a person, or all; return their number."""
        gone = [key for key, one in self._drawings.items() if person_id in (None, one.person.id)]
        for key in gone:
            del self._drawings[key]
        return len(gone)
