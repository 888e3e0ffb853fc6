"""Who watches, and what they missed."""

import asyncio
from collections.abc import Awaitable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from enum import StrEnum

import structlog

from server.security import ANYBODY, Person, Role
from server.stream.connection import Line
from server.stream.errors import TooManyViewers
from server.stream.fitting.pace import Pace
from server.stream.fitting.sizes import Choice

_log = structlog.get_logger(__name__)

MAX_A_PERSON = 8
# Of so many places one is kept for those without whom nothing goes on in theatre.
PLACES_A_KEPT_ONE = 8
KEPT_FOR = frozenset({Role.OPERATOR, Role.SCREEN})


class ViewerKind(StrEnum):
    """The ways to watch."""

    MJPEG = "mjpeg"
    LIVE = "live"
    VIEW = "view"
    ROOM = "room"
    SCENE = "scene"


# Each of these ways has places of its own: it takes no picture from anybody. All others share theirs.
APART = frozenset({ViewerKind.ROOM, ViewerKind.SCENE})


@dataclass(slots=True, eq=False)
class Viewer:
    """One who watches.

    Attributes:
        kind: by which way.
        person: who it is; `ANYBODY` where nobody signs in.
        sequence: of the last instant taken, -1 before the first.
        dropped: how many instants it skipped, because it was slower than they came.
        pace: in which size its pictures go out.
    """

    kind: ViewerKind
    person: Person = ANYBODY
    sequence: int = -1
    dropped: int = 0
    pace: Pace = field(default_factory=Pace)

    def took(self, sequence: int) -> None:
        """Note that this instant goes to the viewer now."""
        if self.sequence >= 0:
            self.dropped += max(0, sequence - self.sequence - 1)
        self.sequence = sequence


class Stalled(Exception):
    """Nothing could be sent to a viewer for too long."""


class Viewers:
    """All who watch now, and sums over those who went. Used in one event loop only."""

    def __init__(self, *, most: int = 64, send_timeout_s: float = 2.0) -> None:
        self.send_timeout_s = send_timeout_s
        self._max = most
        self._watching: list[Viewer] = []
        self._dropped_by_gone = dict.fromkeys(ViewerKind, 0)
        self._let_go = dict.fromkeys(ViewerKind, 0)

    @contextmanager
    def watching(
        self, kind: ViewerKind, choice: Choice = Choice.AUTO, *, person: Person = ANYBODY
    ) -> Iterator[Viewer]:
        """One more watches, for the time of the block; a stall ends it quietly, and is counted.

        Raises:
            TooManyViewers: as many watch as are allowed, or as one person may; then no place is taken.
        """
        self._reject(kind, person)
        viewer = Viewer(kind, person=person, pace=Pace(choice))
        self._watching.append(viewer)
        try:
            yield viewer
        except Stalled:
            self._let_go[kind] += 1
            _log.info("viewer_let_go", kind=kind, blocked_s=self.send_timeout_s, dropped=viewer.dropped)
        finally:
            self._watching.remove(viewer)
            self._dropped_by_gone[kind] += viewer.dropped

    def _reject(self, kind: ViewerKind, person: Person) -> None:
        ways = {kind} if kind in APART else set(ViewerKind) - APART
        same = [one for one in self._watching if one.kind in ways]
        own = sum(one.person.id == person.id for one in same)
        most = self._max - (0 if person.role in KEPT_FOR else self._max // PLACES_A_KEPT_ONE)
        error = None
        if len(same) >= most:
            error = TooManyViewers(len(same), most)
        elif person != ANYBODY and own >= MAX_A_PERSON:
            error = TooManyViewers(own, MAX_A_PERSON, person.name)
        if error is not None:
            _log.warning("viewer_rejected", kind=kind, by=person.name, watching=len(same), own=own, most=most)
            raise error

    async def send(self, sending: Awaitable[None], line: Line | None) -> None:
        """Send something, and wait until the line has taken it, for as long as one sending may take.

        Raises:
            Stalled: nothing went for that long, or the whole needed several times as long.
        """
        try:
            async with asyncio.timeout(self.send_timeout_s):
                await sending
            if line is not None:
                await line.drained(patience_s=self.send_timeout_s)
        except TimeoutError as error:
            raise Stalled from error

    def count(self, kind: ViewerKind) -> int:
        """How many watch by this way now."""
        return sum(viewer.kind is kind for viewer in self._watching)

    def dropped(self, kind: ViewerKind) -> int:
        """How many instants viewers of this kind skipped since the start."""
        now = sum(viewer.dropped for viewer in self._watching if viewer.kind is kind)
        return self._dropped_by_gone[kind] + now

    def let_go(self, kind: ViewerKind) -> int:
        """How many viewers of this kind were let go because they were stalled."""
        return self._let_go[kind]
