"""Participants of the room: each person once, with their open pages and the state of their connection."""

from collections.abc import Iterable
from dataclasses import dataclass, field, replace
from enum import StrEnum

from server.security import Person, Role
from server.supervision.token_bucket import TokenBucket

# Response time from which a connection counts as slow, and as silent.
SLOW_AFTER_S, SILENT_AFTER_S = 0.5, 2.0


class View(StrEnum):
    """Views of the web page."""

    THEATRE = "theatre"
    OPERATOR = "operator"
    SUPERVISOR = "supervisor"


class ViewPart(StrEnum):
    """Part of a view: the layout of pictures and figures, or the page of the operator's view."""

    APPROACH = "approach"
    ALIGN = "align"
    DRILL = "drill"
    OVERVIEW = "overview"
    FIGURES = "figures"
    CASE = "case"
    CAMERA = "camera"
    TOOL = "tool"
    PLAN = "plan"
    REGISTER = "register"
    CHECK = "check"
    NAVIGATE = "navigate"
    RECORDINGS = "recordings"
    REPORT = "report"
    PEOPLE = "people"


class Picture(StrEnum):
    """Pictures of a page: the video, a cut of the CT, or the 3-D scene."""

    VIDEO = "video"
    PROBE = "probe"
    AXIAL = "axial"
    SAGITTAL = "sagittal"
    ANATOMICAL_AXIAL = "anatomical-axial"
    ANATOMICAL_SAGITTAL = "anatomical-sagittal"
    ANATOMICAL_CORONAL = "anatomical-coronal"
    SCENE = "scene"


class Freshness(StrEnum):
    """Whether a page shows what is happening now."""

    LIVE = "live"
    OLD = "old"  # its picture and figures are covered
    HIDDEN = "hidden"  # another tab or window is in front of it
    UNKNOWN = "unknown"  # it has not reported yet, or does not answer


@dataclass(frozen=True, slots=True, kw_only=True)
class Look:
    """What a page shows, as it reports it.

    Attributes:
        part: part of its view; None where it has none.
        pictures: visible pictures, the largest first.
        freshness: whether they are live.
        max_age_ms: upper limit of their age in the last second, in steps; None if they are not live.
    """

    part: ViewPart | None = None
    pictures: tuple[Picture, ...] = ()
    freshness: Freshness = Freshness.UNKNOWN
    max_age_ms: float | None = None


@dataclass(frozen=True, slots=True, kw_only=True)
class PageLook:
    """A page of a person.

    Attributes:
        view: its view.
        look: what it shows.
    """

    view: View
    look: Look


class ConnectionState(StrEnum):
    """State of the connection to a person."""

    GOOD = "good"
    SLOW = "slow"
    SILENT = "silent"


@dataclass(slots=True, kw_only=True)
class RoomSession:
    """One open page of a person.

    Attributes:
        number: unique number in this run of the server.
        person: the person.
        view: the view that the page shows.
        since: time of joining, UTC, ISO 8601.
        bucket: rate limit of its marks.
        look_bucket: rate limit of its reports of what it shows.
        look: the newest of them.
        sent_at_s: send time of the message that it has not answered yet; None while no answer is due.
        round_trip_s: response time of its last answer.
    """

    number: int
    person: Person
    view: View
    since: str
    bucket: TokenBucket
    look_bucket: TokenBucket
    look: Look = field(default_factory=Look)
    sent_at_s: float | None = None
    round_trip_s: float = 0.0

    def answered(self, now_s: float) -> None:
        """Record the answer to the last message."""
        if self.sent_at_s is not None:
            self.round_trip_s, self.sent_at_s = now_s - self.sent_at_s, None

    def page_look(self, now_s: float) -> PageLook:
        """Return the page and what it shows; a page that does not answer may have frozen since its report."""
        is_silent = self.connection(now_s) is ConnectionState.SILENT
        look = replace(self.look, freshness=Freshness.UNKNOWN, max_age_ms=None) if is_silent else self.look
        return PageLook(view=self.view, look=look)

    def connection(self, now_s: float) -> ConnectionState:
        """Return the connection's state, by the last response time or the wait for the next one."""
        waited_s = 0.0 if self.sent_at_s is None else now_s - self.sent_at_s
        worst_s = max(self.round_trip_s, waited_s)
        if worst_s >= SILENT_AFTER_S:
            return ConnectionState.SILENT
        return ConnectionState.SLOW if worst_s >= SLOW_AFTER_S else ConnectionState.GOOD


@dataclass(frozen=True, slots=True, kw_only=True)
class Participant:
    """A person in the room.

    Attributes:
        person_id: id of the person; not sent to others.
        name: display name.
        role: role of the person.
        pages: open pages; those that show the same are listed once.
        since: time at which the oldest open page joined, UTC, ISO 8601.
        connection: state of the best of the person's connections.
    """

    person_id: str
    name: str
    role: Role
    pages: tuple[PageLook, ...]
    since: str
    connection: ConnectionState


@dataclass(slots=True)
class _Pages:
    sessions: list[RoomSession] = field(default_factory=list)


def participants_of(sessions: Iterable[RoomSession], now_s: float) -> tuple[Participant, ...]:
    """Return each person once, in the order of joining."""
    pages: dict[str, _Pages] = {}
    for session in sessions:
        pages.setdefault(session.person.id, _Pages()).sessions.append(session)
    return tuple(_present(one.sessions, now_s) for one in pages.values())


def _present(sessions: list[RoomSession], now_s: float) -> Participant:
    person = sessions[-1].person
    connections = {session.connection(now_s) for session in sessions}
    return Participant(
        person_id=person.id,
        name=person.name,
        role=person.role,
        pages=tuple(dict.fromkeys(one.page_look(now_s) for one in sessions)),
        since=min(session.since for session in sessions),
        connection=next(state for state in ConnectionState if state in connections),
    )
