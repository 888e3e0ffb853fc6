"""Pointers and drawings on the video image or on a cut of the CT; each expires with the image then shown.

A mark on a cut is bound to the CT as well, and is removed as soon as another CT is navigated. Marks are kept
in memory only, with one line each in the log; they do not survive the process.
"""

from collections.abc import Sequence
from dataclasses import dataclass, field
from enum import StrEnum
from typing import TypeAlias

from server.security import Person

# x, y on what the mark was made on: in pixels of the whole image, or in mm on the plane of a cut. One type
# for both, since pen, arrow and circle are the same shapes on either.
MarkPoint: TypeAlias = tuple[float, float]
Vector: TypeAlias = tuple[float, float, float]

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
class CutPlane:
    """The plane of a cut on which a mark was made.

    Attributes:
        ct_id: id of the CT, in whose frame (the vertebra's) the plane is stated.
        origin_in_vertebra_mm: the plane's point (0, 0).
        right_in_vertebra, down_in_vertebra: orthogonal unit directions of x and y.
    """

    ct_id: str
    origin_in_vertebra_mm: Vector
    right_in_vertebra: Vector
    down_in_vertebra: Vector


@dataclass(frozen=True, slots=True, kw_only=True)
class Pointer:
    """Current pointer of one page.

    Attributes:
        session: number of the page's session.
        person: its owner.
        at: its position on the image or on the plane.
        plane: the plane of a cut; None on the image.
        moment: the image that was shown.
        moved_at_s: time of its last move, monotonic.
    """

    session: int
    person: Person
    at: MarkPoint
    plane: CutPlane | None = None
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
        moment: the image that was shown when it was started.
        plane: the plane of a cut; None on the image.
        points: its points on the image or on the plane.
    """

    key: str
    session: int
    person: Person
    shape: Shape
    moment: Moment
    plane: CutPlane | None = None
    points: list[MarkPoint] = field(default_factory=list)


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

    def find(self, key: str) -> Drawing | None:
        """Return a drawing; None if it has expired."""
        return self._drawings.get(key)

    def extend(self, drawing: Drawing, points: Sequence[MarkPoint]) -> bool:
        """Append points; return False above the maximum length."""
        if len(drawing.points) + len(points) > MAX_POINTS_PER_DRAWING:
            return False
        drawing.points.extend(points)
        return True

    def retain_ct(self, ct_id: str) -> None:
        """Remove marks on cuts of another CT than this one."""

        def is_other(plane: CutPlane | None) -> bool:
            return plane is not None and plane.ct_id != ct_id

        self._pointers = {key: one for key, one in self._pointers.items() if not is_other(one.plane)}
        self._drawings = {key: one for key, one in self._drawings.items() if not is_other(one.plane)}

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
