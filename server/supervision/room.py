"""The room: participants and their marks. Pure: time is passed in."""

import itertools
from collections.abc import Sequence
from dataclasses import dataclass

from server.security import Person, Role
from server.supervision.marks import (
    MAX_POINTS_PER_DRAWING,
    CutPlane,
    Drawing,
    MarkPoint,
    Marks,
    Moment,
    Pointer,
    Shape,
)
from server.supervision.participants import Participant, RoomSession, View, participants_of
from server.supervision.token_bucket import TokenBucket

MAX_SESSIONS = 200
MAX_SESSIONS_PER_PERSON = 20
# A page sends at most 25 pointer and 25 drawing messages per second, each with a request for the next
# message.
MARKS_PER_SECOND, MARKS_AT_ONCE = 60.0, 120.0
# A cut is at most 110 mm wide and high.
MAX_ON_CUT_MM = 200.0
MAY_MARK = frozenset({Role.SUPERVISOR, Role.OPERATOR})


class RoomPolicyViolation(Exception):
    """A page sent a message that it may not send; the connection is closed with this reason."""


class RoomFull(Exception):
    """The room has reached its maximum number of pages."""


@dataclass(frozen=True, slots=True, kw_only=True)
class ShownImage:
    """The newest image.

    Attributes:
        moment: its number and capture time.
        size_wh_px: its width and height.
        ct_id: of the CT that is navigated, on whose cuts marks are made; empty if there is none.
    """

    moment: Moment
    size_wh_px: tuple[int, int]
    ct_id: str = ""


class Room:
    """Participants and their marks.

    Args:
        fades_after_s: lifetime of a drawing.
    """

    def __init__(self, *, fades_after_s: float) -> None:
        self.marks = Marks(fades_after_s=fades_after_s)
        self._sessions: dict[int, RoomSession] = {}
        self._numbers = itertools.count(1)

    def enter(self, person: Person, view: View, *, now_s: float, at: str) -> RoomSession:
        """Add a page.

        Args:
            person: its person.
            view: the view that it shows.
            now_s: monotonic time.
            at: the same by the wall clock, UTC, ISO 8601.

        Raises:
            RoomFull: too many pages are open.
        """
        own = sum(session.person.id == person.id for session in self._sessions.values())
        if len(self._sessions) >= MAX_SESSIONS or own >= MAX_SESSIONS_PER_PERSON:
            maximum = MAX_SESSIONS_PER_PERSON if own >= MAX_SESSIONS_PER_PERSON else MAX_SESSIONS
            raise RoomFull(f"{maximum} pages are open, the maximum; close one")
        bucket = TokenBucket.full(rate_hz=MARKS_PER_SECOND, capacity=MARKS_AT_ONCE, now_s=now_s)
        session = RoomSession(number=next(self._numbers), person=person, view=view, since=at, bucket=bucket)
        self._sessions[session.number] = session
        return session

    def leave(self, session: RoomSession) -> None:
        """Remove a page and its pointer; drawings stay until they expire."""
        self._sessions.pop(session.number, None)
        self.marks.lift(session.number)

    def participants(self, now_s: float) -> tuple[Participant, ...]:
        """Return each person once."""
        return participants_of(self._sessions.values(), now_s)

    def point(
        self,
        session: RoomSession,
        at: MarkPoint,
        moment: Moment,
        shown: ShownImage | None,
        *,
        plane: CutPlane | None = None,
        now_s: float,
    ) -> None:
        """Set the pointer of a page; it is ignored off the image, or on another CT.

        Raises:
            RoomPolicyViolation: not for this role; rate limit.
        """
        self._reject(session, now_s)
        if shown is not None and _is_on(shown, plane, [at]) and _was_shown(moment, shown):
            pointer = Pointer(
                session=session.number,
                person=session.person,
                at=at,
                plane=plane,
                moment=moment,
                moved_at_s=now_s,
            )
            self.marks.point(pointer)

    def lift(self, session: RoomSession, *, now_s: float) -> None:
        """Remove the pointer of a page.

        Raises:
            RoomPolicyViolation: not for this role; rate limit.
        """
        self._reject(session, now_s)
        self.marks.lift(session.number)

    def draw(
        self,
        session: RoomSession,
        key: int,
        shape: Shape,
        points: Sequence[MarkPoint],
        moment: Moment,
        shown: ShownImage | None,
        *,
        plane: CutPlane | None = None,
        now_s: float,
    ) -> bool:
        """Start a drawing; return False without an image, off it, or on another CT.

        Raises:
            RoomPolicyViolation: not for this role; rate limit; an arrow or circle without two points.
        """
        self._reject(session, now_s)
        if shape is not Shape.PEN and len(points) != 2:
            raise RoomPolicyViolation(f"a drawing of shape {shape.value} needs 2 points, not {len(points)}")
        if shown is None or not _is_on(shown, plane, points) or not _was_shown(moment, shown):
            return False
        self.marks.begin(
            Drawing(
                key=_key(session, key),
                session=session.number,
                person=session.person,
                shape=shape,
                moment=moment,
                plane=plane,
                points=list(points),
            )
        )
        return True

    def extend(
        self,
        session: RoomSession,
        key: int,
        points: Sequence[MarkPoint],
        shown: ShownImage | None,
        *,
        now_s: float,
    ) -> None:
        """Append points of the pen; those of an expired drawing are ignored.

        Raises:
            RoomPolicyViolation: not for this role; rate limit; too long.
        """
        self._reject(session, now_s)
        drawing = self.marks.find(_key(session, key))
        if shown is None or drawing is None or not _is_on(shown, drawing.plane, points):
            return
        if not self.marks.extend(drawing, points):
            raise RoomPolicyViolation(f"a drawing has at most {MAX_POINTS_PER_DRAWING} points")

    def undo(self, session: RoomSession, *, now_s: float) -> bool:
        """Remove the newest drawing of the person; return whether there was one.

        Raises:
            RoomPolicyViolation: not for this role; rate limit.
        """
        self._reject(session, now_s)
        return self.marks.undo(session.person.id)

    def clear(self, session: RoomSession, *, everybodys: bool, now_s: float) -> int:
        """Remove the person's drawings, or for the operator all drawings; return their number.

        Raises:
            RoomPolicyViolation: not for this role; rate limit.
        """
        self._reject(session, now_s)
        if everybodys and session.person.role is not Role.OPERATOR:
            raise RoomPolicyViolation("only the operator may clear drawings of others")
        return self.marks.clear(None if everybodys else session.person.id)

    def _reject(self, session: RoomSession, now_s: float) -> None:
        if session.person.role not in MAY_MARK:
            raise RoomPolicyViolation(f"a {session.person.role.value} may not mark")
        if not session.bucket.take(now_s):
            raise RoomPolicyViolation(f"at most {MARKS_PER_SECOND:g} marks per second are accepted")


def _key(session: RoomSession, key: int) -> str:
    return f"{session.number}-{key}"


def _is_on(shown: ShownImage, plane: CutPlane | None, points: Sequence[MarkPoint]) -> bool:
    """Return whether all points lie on the image, whose size may have changed, or on a cut of this CT."""
    if plane is not None:
        is_near = all(abs(part) <= MAX_ON_CUT_MM for point in points for part in point)
        return is_near and plane.ct_id == shown.ct_id
    width, height = shown.size_wh_px
    return all(-0.5 <= x <= width - 0.5 and -0.5 <= y <= height - 0.5 for x, y in points)


def _was_shown(moment: Moment, shown: ShownImage) -> bool:
    """Return whether an image of this number and time was captured already."""
    newest = shown.moment
    return moment.image_number <= newest.image_number and moment.captured_at_s <= newest.captured_at_s
