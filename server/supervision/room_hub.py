"""The room with its clock and its subscribers."""

import asyncio
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from server.clock import utc_now, utc_text
from server.live import LiveHub
from server.security import Person
from server.supervision.hold_requests import HoldRequests
from server.supervision.marks import Drawing, Moment, Pointer
from server.supervision.participants import RoomSession, View
from server.supervision.room import Room, ShownImage
from server.supervision.room_updates import RoomState
from server.supervision.signatures import SignatureService

# Updates are sent at once, with at least this interval; without any, one message a second is a heartbeat.
MIN_INTERVAL_S, HEARTBEAT_S = 1.0 / 30.0, 1.0
VISIT_LASTS_S = 5.0


@dataclass(slots=True)
class RoomSubscription:
    """A session in the room, and the event that wakes its connection."""

    session: RoomSession
    wakeup: asyncio.Event


class RoomHub:
    """The room of one server. For one event loop; only `notify_threadsafe` may be called from any thread.

    Args:
        hub: live images, on which marks are made.
        holds: hold requests.
        signatures: of plan and registration; None without a store.
        fades_after_s: lifetime of a drawing.
        clock: monotonic clock, the one of the images' capture times.
    """

    def __init__(
        self,
        *,
        hub: LiveHub,
        holds: HoldRequests,
        signatures: SignatureService | None,
        fades_after_s: float,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        # Called with each accepted mark as JSON; must return at once.
        self.on_mark: Callable[[str], None] = lambda _: None
        self.room = Room(fades_after_s=fades_after_s)
        self._hub = hub
        self._holds = holds
        self._signatures = signatures
        self._clock = clock
        self._lock = threading.Lock()
        self._subscriptions: dict[int, RoomSubscription] = {}
        # Session and time of the last request, by person.
        self._visits: dict[str, tuple[RoomSession, float]] = {}
        self._loop: asyncio.AbstractEventLoop | None = None
        holds.on_change = self.notify_threadsafe
        if signatures is not None:
            signatures.on_change = self.notify_threadsafe

    @property
    def now_s(self) -> float:
        """Monotonic time."""
        return self._clock()

    @property
    def shown(self) -> ShownImage | None:
        """Number, time and size of the newest image; None while there is none."""
        newest = self._hub.newest
        snapshot = None if newest is None else newest.snapshot
        if snapshot is None:
            return None
        return ShownImage(
            moment=Moment(image_number=snapshot.image_number, captured_at_s=snapshot.captured_at_s),
            size_wh_px=snapshot.size_wh_px,
            ct_id=snapshot.setup.ct_id,
        )

    @contextmanager
    def join(self, person: Person, view: View) -> Iterator[RoomSubscription]:
        """Register a session for the duration of the block.

        Raises:
            RoomFull: too many pages are open.
        """
        at = utc_text(utc_now(), timespec="seconds")
        with self._lock:
            self._loop = asyncio.get_running_loop()
        subscription = RoomSubscription(
            self.room.enter(person, view, now_s=self.now_s, at=at), asyncio.Event()
        )
        subscription.wakeup.set()
        self._subscriptions[subscription.session.number] = subscription
        self.notify()
        try:
            yield subscription
        finally:
            del self._subscriptions[subscription.session.number]
            self.room.leave(subscription.session)
            self.notify()

    def visit(self, person: Person) -> RoomSession:
        """Return the session of a person who marks by requests, as through the hub, without a socket.

        It ends `VISIT_LASTS_S` after the last request.

        Raises:
            RoomFull: too many pages are open.
        """
        self._end_visits()
        visit = self._visits.get(person.id)
        if visit is None:
            at = utc_text(utc_now(), timespec="seconds")
            visit = (self.room.enter(person, View.SUPERVISOR, now_s=self.now_s, at=at), 0.0)
        self._visits[person.id] = (visit[0], self.now_s)
        return visit[0]

    def visit_of(self, person: Person) -> RoomSession | None:
        """Return the session of a person who marks by requests now."""
        self._end_visits()
        visit = self._visits.get(person.id)
        return None if visit is None else visit[0]

    def _end_visits(self) -> None:
        for person_id, (session, at_s) in list(self._visits.items()):
            if self.now_s - at_s > VISIT_LASTS_S:
                del self._visits[person_id]
                self.room.leave(session)

    def notify(self) -> None:
        """Wake all subscribers. Call it in the event loop."""
        for subscription in self._subscriptions.values():
            subscription.wakeup.set()

    def notify_threadsafe(self) -> None:
        """Wake all subscribers, from any thread."""
        with self._lock:
            loop = self._loop
        # A closed loop has no subscribers.
        if loop is not None and not loop.is_closed():
            loop.call_soon_threadsafe(self.notify)

    def marks_on_cuts(self) -> tuple[Drawing | Pointer, ...]:
        """Return the marks on cuts of the CT that is navigated."""
        self._retain_ct()
        marks, now_s = self.room.marks, self.now_s
        return tuple(one for one in (*marks.drawings(now_s), *marks.pointers(now_s)) if one.plane is not None)

    def _retain_ct(self) -> None:
        shown = self.shown
        # Without an image it is unknown which CT is navigated; the pages then show no cut.
        if shown is not None:
            self.room.marks.retain_ct(shown.ct_id)

    def state(self) -> RoomState:
        """Return the state of the room now."""
        self._retain_ct()
        self._end_visits()
        now_s, asking = self.now_s, self._holds.requests
        return RoomState(
            now_s=now_s,
            fades_after_s=self.room.marks.fades_after_s,
            people=self.room.participants(now_s),
            pointers=self.room.marks.pointers(now_s),
            drawings=self.room.marks.drawings(now_s),
            holds=asking,
            signable=None if self._signatures is None else self._signatures.known,
        )
