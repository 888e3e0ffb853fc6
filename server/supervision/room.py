"""The room: who is in it, and what they mark. Pure: the time is handed in."""

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

from server.security import Person, Role
from server.supervision.budget import Budget
from server.supervision.marks import (
    MAX_POINTS_A_DRAWING,
    Drawing,
    Marks,
    Moment,
    Pixel,
    Pointer,
    Shape,
)
from server.supervision.people import Present, Seat, View, everybody

MAX_SEATS = 200
MAX_SEATS_A_PERSON = 20
# A page points 25 times a second at most, and draws as often; a grant for each message comes on top.
MARKS_A_SECOND, MARKS_AT_ONCE = 60.0, 120.0
MAY_MARK = frozenset({Role.SUPERVISOR, Role.OPERATOR})


class Unfair(Exception):
    """A page sent what it may not; it is told this, and goes."""


class RoomFull(Exception):
    """There is no seat left; said in words."""


@dataclass(frozen=True, slots=True, kw_only=True)
class Shown:
    """The newest image.

    Attributes:
        moment: which one.
        size_wh_px: of the whole image.
    """

    moment: Moment
    size_wh_px: tuple[int, int]


class Room:
    """Who is here and what they mark.

    Args:
        fades_after_s: how long drawings stay.
    """

    def __init__(self, *, fades_after_s: float) -> None:
        self.marks = Marks(fades_after_s=fades_after_s)
        self._seats: dict[int, Seat] = {}
        self._numbers = itertools.count(1)

    def enter(self, person: Person, view: View, *, now_s: float, at: str) -> Seat:
        """Somebody opens a page.

        Args:
            person: who.
            view: what the page shows.
            now_s: monotonic.
            at: the same by the wall clock, UTC, ISO 8601.

        Raises:
            RoomFull: too many pages are open.
        """
        own = sum(seat.person.id == person.id for seat in self._seats.values())
        if len(self._seats) >= MAX_SEATS or own >= MAX_SEATS_A_PERSON:
            most = MAX_SEATS_A_PERSON if own >= MAX_SEATS_A_PERSON else MAX_SEATS
            raise RoomFull(f"{most} pages are open already; close one")
        budget = Budget.full(rate_hz=MARKS_A_SECOND, most=MARKS_AT_ONCE, now_s=now_s)
        seat = Seat(number=next(self._numbers), person=person, view=view, since=at, budget=budget)
        self._seats[seat.number] = seat
        return seat

    def leave(self, seat: Seat) -> None:
        """A page was closed; what its person drew stays for its time."""
        self._seats.pop(seat.number, None)
        self.marks.lift(seat.number)

    def present(self, now_s: float) -> tuple[Present, ...]:
        """Each person once."""
        return everybody(self._seats.values(), now_s)

    def point(self, seat: Seat, at_px: Pixel, moment: Moment, shown: Shown | None, *, now_s: float) -> None:
        """Somebody's pointer moved.

        Raises:
            Unfair: not for this role; too often.
        """
        self._reject(seat, now_s)
        if shown is not None and _is_on(shown, [at_px]) and _was_shown(moment, shown):
            pointer = Pointer(
                seat=seat.number, person=seat.person, at_px=at_px, moment=moment, moved_at_s=now_s
            )
            self.marks.point(pointer)

    def lift(self, seat: Seat, *, now_s: float) -> None:
        """Somebody points at nothing any more.

        Raises:
            Unfair: not for this role; too often.
        """
        self._reject(seat, now_s)
        self.marks.lift(seat.number)

    def draw(
        self,
        seat: Seat,
        key: int,
        shape: Shape,
        points_px: Sequence[Pixel],
        moment: Moment,
        shown: Shown | None,
        *,
        now_s: float,
    ) -> bool:
        """Somebody begins a drawing; whether it stands. On no picture, or off it, nothing is drawn.

        Raises:
            Unfair: not for this role; too often; an arrow or circle of more or less than two points.
        """
        self._reject(seat, now_s)
        if shape is not Shape.PEN and len(points_px) != 2:
            raise Unfair(f"a drawing of the shape {shape.value} has two points, not {len(points_px)}")
        if shown is None or not _is_on(shown, points_px) or not _was_shown(moment, shown):
            return False
        self.marks.begin(
            Drawing(
                key=_key(seat, key),
                seat=seat.number,
                person=seat.person,
                shape=shape,
                moment=moment,
                points_px=list(points_px),
            )
        )
        return True

    def extend(
        self, seat: Seat, key: int, points_px: Sequence[Pixel], shown: Shown | None, *, now_s: float
    ) -> None:
        """Somebody draws on with the pen.

        Raises:
            Unfair: not for this role; too often; too long.
        """
        self._reject(seat, now_s)
        if shown is None or not _is_on(shown, points_px):
            return
        if not self.marks.extend(_key(seat, key), points_px):
            raise Unfair(f"a drawing has at most {MAX_POINTS_A_DRAWING} points")

    def undo(self, seat: Seat, *, now_s: float) -> bool:
        """Somebody takes back the last thing that they drew; whether there was one.

        Raises:
            Unfair: not for this role; too often.
        """
        self._reject(seat, now_s)
        return self.marks.undo(seat.person.id)

    def clear(self, seat: Seat, *, everybodys: bool, now_s: float) -> int:
        """Somebody takes back all that they drew; the operator all that anybody drew; how much that was.

        Raises:
            Unfair: not for this role; too often.
        """
        self._reject(seat, now_s)
        if everybodys and seat.person.role is not Role.OPERATOR:
            raise Unfair("only the operator clears what others drew")
        return self.marks.clear(None if everybodys else seat.person.id)

    def _reject(self, seat: Seat, now_s: float) -> None:
        if seat.person.role not in MAY_MARK:
            raise Unfair(f"a {seat.person.role.value} only watches")
        if not seat.budget.spend(now_s):
            raise Unfair(f"at most {MARKS_A_SECOND:g} marks a second are taken")


def _key(seat: Seat, key: int) -> str:
    return f"{seat.number}-{key}"


def _is_on(shown: Shown, points_px: Sequence[Pixel]) -> bool:
    """A picture may have changed its size since it was drawn on: that is no fault of who drew."""
    width, height = shown.size_wh_px
    return all(-0.5 <= x <= width - 0.5 and -0.5 <= y <= height - 0.5 for x, y in points_px)


def _was_shown(moment: Moment, shown: Shown) -> bool:
    """Nobody has seen an image that was not yet captured."""
    newest = shown.moment
    return moment.image_number <= newest.image_number and moment.captured_at_s <= newest.captured_at_s
