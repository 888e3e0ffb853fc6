"""Who asks those in theatre to hold. It raises an alarm, and stops or changes nothing."""

import threading
from collections.abc import Callable, Mapping

from server.alarms import AlarmDesk
from server.clock import Clock, utc_now, utc_text
from server.errors import SetupOrderError
from server.security import Person, Role
from server.supervision.asked import Asked, Keeping, NotKept
from tracker.navigation.alarms import AlarmPicture


class Holds:
    """Several may ask at once: the alarm stands until each of them has released, or the operator has.

    A hold belongs to the theatre and not to a case: it stands whichever case is opened or closed, and over a
    start of the server. Safe to use from any thread; asking and releasing wait for the disk.

    Args:
        desk: where the alarm is raised; at once for those who asked before the start.
        kept: where it is kept who asks.
        clock: the wall clock, for when they asked.

    Raises:
        StoreError: what was kept cannot be read.
    """

    def __init__(self, desk: AlarmDesk, *, kept: Keeping | None = None, clock: Clock = utc_now) -> None:
        self._desk = desk
        self._kept: Keeping = kept or NotKept()
        self._clock = clock
        self._lock = threading.Lock()
        # Never changed, only put in place of each other: the event loop asks, and waits for no disk.
        self._asking: Mapping[str, Asked] = {one.person_id: one for one in self._kept.read()}
        # Called after each change, so that everybody in the room is told.
        self.tell: Callable[[], None] = lambda: None
        if self._asking:
            desk.ask_hold(by=self._names())

    @property
    def asking(self) -> tuple[Asked, ...]:
        """Who asks, in the order in which they asked."""
        return tuple(self._asking.values())

    def ask(self, person: Person, *, name: str = "") -> AlarmPicture:
        """This person asks to hold; `name` is taken where nobody has to sign in.

        Raises:
            StoreError: it cannot be kept; theatre hears of it all the same, until a start of the server.
        """
        with self._lock:
            before = self._asking.get(person.id)
            at = utc_text(self._clock()) if before is None else before.at
            asked = Asked(person_id=person.id, name=name or person.name, at=at)
            return self._changed({**self._asking, person.id: asked}, by=asked.name)

    def release(self, person: Person, *, name: str = "") -> AlarmPicture:
        """This person asks no more; the operator ends it for everybody.

        Raises:
            SetupOrderError: HOLD_NOT_YOURS.
            StoreError: that cannot be kept; it has ended all the same, until a start of the server.
        """
        with self._lock:
            is_operator = person.role is Role.OPERATOR
            if self._asking and not is_operator and person.id not in self._asking:
                raise SetupOrderError(
                    "HOLD_NOT_YOURS",
                    f"the hold was asked for by {self._names()}, not by {person.name}",
                    "Leave it to who asked, or to the operator.",
                    {"asked_by": [one.name for one in self._asking.values()]},
                )
            others = {key: one for key, one in self._asking.items() if key != person.id and not is_operator}
            return self._changed(others, by=name or person.name)

    def _changed(self, asking: Mapping[str, Asked], *, by: str) -> AlarmPicture:
        """Theatre hears first, whatever the disk says; who did it hears once it is kept."""
        self._asking = asking
        picture = self._desk.ask_hold(by=self._names()) if asking else self._desk.release_hold(by=by)
        self.tell()
        self._kept.write(asking.values())
        return picture

    def _names(self) -> str:
        return ", ".join(dict.fromkeys(one.name for one in self._asking.values()))
