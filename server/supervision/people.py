"""Who is here: each person once, however many pages they have open, and how their line does."""

from collections.abc import Iterable
from dataclasses import dataclass, field
from enum import StrEnum

from server.security import Person, Role
from server.supervision.budget import Budget

# What an answer may take before a line counts as slow, and before it counts as silent.
SLOW_AFTER_S, SILENT_AFTER_S = 0.5, 2.0


class View(StrEnum):
    """The views of the page."""

    THEATRE = "theatre"
    OPERATOR = "operator"
    SUPERVISOR = "supervisor"


class LineState(StrEnum):
    """How the line to somebody does."""

    GOOD = "good"
    SLOW = "slow"
    SILENT = "silent"


@dataclass(slots=True, kw_only=True)
class Seat:
    """One page that somebody has open.

    Attributes:
        number: tells it from all others of this run of the server.
        person: whose it is.
        view: what it shows.
        since: when it came, UTC, ISO 8601.
        budget: how much it may still send.
        sent_at_s: when it was sent what it has not answered yet; None while it owes no answer.
        round_trip_s: how long its last answer took.
    """

    number: int
    person: Person
    view: View
    since: str
    budget: Budget
    sent_at_s: float | None = None
    round_trip_s: float = 0.0

    def answered(self, now_s: float) -> None:
        """It has taken what was sent, and asks for more."""
        if self.sent_at_s is not None:
            self.round_trip_s, self.sent_at_s = now_s - self.sent_at_s, None

    def line(self, now_s: float) -> LineState:
        """How its line does: by its last answer, or by how long one has been missing."""
        waited_s = 0.0 if self.sent_at_s is None else now_s - self.sent_at_s
        worst_s = max(self.round_trip_s, waited_s)
        if worst_s >= SILENT_AFTER_S:
            return LineState.SILENT
        return LineState.SLOW if worst_s >= SLOW_AFTER_S else LineState.GOOD


@dataclass(frozen=True, slots=True, kw_only=True)
class Present:
    """Somebody who is here.

    Attributes:
        person_id: of the person; never told to others.
        name: as they are called.
        role: what they are here for.
        views: that they have open, each once.
        since: when the first page of theirs that is still open came, UTC, ISO 8601.
        line: of their best page.
    """

    person_id: str
    name: str
    role: Role
    views: tuple[View, ...]
    since: str
    line: LineState


@dataclass(slots=True)
class _Pages:
    seats: list[Seat] = field(default_factory=list)


def everybody(seats: Iterable[Seat], now_s: float) -> tuple[Present, ...]:
    """Each person once, in the order in which they came."""
    pages: dict[str, _Pages] = {}
    for seat in seats:
        pages.setdefault(seat.person.id, _Pages()).seats.append(seat)
    return tuple(_present(one.seats, now_s) for one in pages.values())


def _present(seats: list[Seat], now_s: float) -> Present:
    person = seats[-1].person
    lines = {seat.line(now_s) for seat in seats}
    return Present(
        person_id=person.id,
        name=person.name,
        role=person.role,
        views=tuple(view for view in View if any(seat.view is view for seat in seats)),
        since=min(seat.since for seat in seats),
        line=next(state for state in LineState if state in lines),
    )
