"""The room with its clock, and those who wait for news of it."""

import asyncio
import threading
import time
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass

from server.clock import utc_now, utc_text
from server.live import LiveHub
from server.security import Person
from server.supervision.holds import Holds
from server.supervision.marks import Moment
from server.supervision.people import Seat, View
from server.supervision.room import Room, Shown
from server.supervision.signatures import SignatureDesk
from server.supervision.told import RoomPicture

# News are told at once, but no more often than this; without any, a word a second says that the line stands.
MIN_BETWEEN_S, HEARTBEAT_S = 1.0 / 30.0, 1.0


@dataclass(slots=True)
class Waiting:
    """A seat, and what wakes its line."""

    seat: Seat
    woken: asyncio.Event


class Lobby:
    """Used in one event loop; only `wake` may be called from any thread.

    Args:
        hub: the live images, which marks are made on.
        holds: who asks to hold.
        signatures: of plan and registration; None where nothing is kept.
        fades_after_s: how long drawings stay.
        clock: monotonic, the one that images are stamped with.
    """

    def __init__(
        self,
        *,
        hub: LiveHub,
        holds: Holds,
        signatures: SignatureDesk | None,
        fades_after_s: float,
        clock: Callable[[], float] = time.monotonic,
    ) -> None:
        self.room = Room(fades_after_s=fades_after_s)
        self._hub = hub
        self._holds = holds
        self._signatures = signatures
        self._clock = clock
        self._lock = threading.Lock()
        self._waiting: dict[int, Waiting] = {}
        self._loop: asyncio.AbstractEventLoop | None = None
        holds.tell = self.wake
        if signatures is not None:
            signatures.tell = self.wake

    @property
    def now_s(self) -> float:
        """Monotonic."""
        return self._clock()

    @property
    def shown(self) -> Shown | None:
        """The newest image; None while there is none."""
        newest = self._hub.newest
        snapshot = None if newest is None else newest.snapshot
        if snapshot is None:
            return None
        return Shown(
            moment=Moment(image_number=snapshot.image_number, captured_at_s=snapshot.captured_at_s),
            size_wh_px=snapshot.size_wh_px,
        )

    @contextmanager
    def seated(self, person: Person, view: View) -> Iterator[Waiting]:
        """Somebody is here for the time of the block.

        Raises:
            RoomFull: too many pages are open.
        """
        at = utc_text(utc_now(), timespec="seconds")
        with self._lock:
            self._loop = asyncio.get_running_loop()
        waiting = Waiting(self.room.enter(person, view, now_s=self.now_s, at=at), asyncio.Event())
        waiting.woken.set()
        self._waiting[waiting.seat.number] = waiting
        self.changed()
        try:
            yield waiting
        finally:
            del self._waiting[waiting.seat.number]
            self.room.leave(waiting.seat)
            self.changed()

    def changed(self) -> None:
        """Something is new: everybody is told. In the event loop."""
        for waiting in self._waiting.values():
            waiting.woken.set()

    def wake(self) -> None:
        """The same, from any thread."""
        with self._lock:
            loop = self._loop
        # A loop that was closed meanwhile has nobody left to tell.
        if loop is not None and not loop.is_closed():
            loop.call_soon_threadsafe(self.changed)

    def picture(self) -> RoomPicture:
        """All that there is to tell now."""
        now_s, asking = self.now_s, self._holds.asking
        return RoomPicture(
            now_s=now_s,
            fades_after_s=self.room.marks.fades_after_s,
            people=self.room.present(now_s),
            pointers=self.room.marks.pointers(now_s),
            drawings=self.room.marks.drawings(now_s),
            holding=asking,
            signable=None if self._signatures is None else self._signatures.known,
        )
