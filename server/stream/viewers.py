"""Viewers, and the instants that they skipped."""

import asyncio
from collections.abc import Awaitable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, field
from enum import StrEnum

import structlog

from server.security import LOCAL_USER, Person, Role
from server.stream.connection import Connection
from server.stream.errors import TooManyViewers
from server.stream.scaling.adaptive_size import AdaptiveSize
from server.stream.scaling.sizes import SizeChoice

_log = structlog.get_logger(__name__)

MAX_PER_PERSON = 8
# Of this many places one is reserved for the roles that theatre needs.
PLACES_PER_RESERVED_ONE = 8
RESERVED_FOR = frozenset({Role.OPERATOR, Role.SCREEN})


class ViewerKind(StrEnum):
    """Kinds of connections."""

    MJPEG = "mjpeg"
    LIVE = "live"
    VIEW = "view"
    ROOM = "room"
    SCENE = "scene"


# Each of these kinds has its own limit: a page has one of each beside its video. All others share one.
SEPARATE_KINDS = frozenset({ViewerKind.LIVE, ViewerKind.ROOM, ViewerKind.SCENE})


@dataclass(slots=True, eq=False)
class Viewer:
    """One viewer.

    Attributes:
        kind: kind of its connection.
        person: the person; `LOCAL_USER` where sign-in is off.
        sequence: sequence of the last instant sent, -1 before the first.
        dropped: number of instants that it skipped because it was too slow.
        adaptive_size: size of its pictures.
    """

    kind: ViewerKind
    person: Person = LOCAL_USER
    sequence: int = -1
    dropped: int = 0
    adaptive_size: AdaptiveSize = field(default_factory=AdaptiveSize)

    def mark_taken(self, sequence: int) -> None:
        """Record that this instant is sent to the viewer now."""
        if self.sequence >= 0:
            self.dropped += max(0, sequence - self.sequence - 1)
        self.sequence = sequence


class Stalled(Exception):
    """Nothing could be sent to a viewer within the timeout."""


class Viewers:
    """All present viewers, and counters over past ones. For one event loop."""

    def __init__(self, *, maximum: int = 64, send_timeout_s: float = 2.0) -> None:
        self.send_timeout_s = send_timeout_s
        self._max = maximum
        self._watching: list[Viewer] = []
        self._dropped_by_gone = dict.fromkeys(ViewerKind, 0)
        self._disconnected = dict.fromkeys(ViewerKind, 0)

    @contextmanager
    def register(
        self, kind: ViewerKind, choice: SizeChoice = SizeChoice.AUTO, *, person: Person = LOCAL_USER
    ) -> Iterator[Viewer]:
        """Register a viewer for the duration of the block; a stall ends it without an error, and is counted.

        Raises:
            TooManyViewers: the maximum, or that of one person, is reached.
        """
        self._reject(kind, person)
        viewer = Viewer(kind, person=person, adaptive_size=AdaptiveSize(choice))
        self._watching.append(viewer)
        try:
            yield viewer
        except Stalled:
            self._disconnected[kind] += 1
            _log.info("viewer_disconnected", kind=kind, blocked_s=self.send_timeout_s, dropped=viewer.dropped)
        finally:
            self._watching.remove(viewer)
            self._dropped_by_gone[kind] += viewer.dropped

    def _reject(self, kind: ViewerKind, person: Person) -> None:
        ways = {kind} if kind in SEPARATE_KINDS else set(ViewerKind) - SEPARATE_KINDS
        same = [one for one in self._watching if one.kind in ways]
        own = sum(one.person.id == person.id for one in same)
        maximum = self._max - (0 if person.role in RESERVED_FOR else self._max // PLACES_PER_RESERVED_ONE)
        error = None
        if len(same) >= maximum:
            error = TooManyViewers(len(same), maximum)
        elif person != LOCAL_USER and own >= MAX_PER_PERSON:
            error = TooManyViewers(own, MAX_PER_PERSON, person.name)
        if error is not None:
            _log.warning(
                "viewer_rejected", kind=kind, by=person.name, watching=len(same), own=own, maximum=maximum
            )
            raise error

    async def send(self, sending: Awaitable[None], connection: Connection | None) -> None:
        """Send, and wait until the connection has taken it, within the timeout.

        Raises:
            Stalled: nothing went for that long, or the whole needed several times as long.
        """
        try:
            async with asyncio.timeout(self.send_timeout_s):
                await sending
            if connection is not None:
                await connection.drained(timeout_s=self.send_timeout_s)
        except TimeoutError as error:
            raise Stalled from error

    def count(self, kind: ViewerKind) -> int:
        """Return the present number of viewers of this kind."""
        return sum(viewer.kind is kind for viewer in self._watching)

    def dropped(self, kind: ViewerKind) -> int:
        """Return how many instants viewers of this kind have skipped since the start."""
        now = sum(viewer.dropped for viewer in self._watching if viewer.kind is kind)
        return self._dropped_by_gone[kind] + now

    def disconnected(self, kind: ViewerKind) -> int:
        """Return how many viewers of this kind were disconnected because they stalled."""
        return self._disconnected[kind]
