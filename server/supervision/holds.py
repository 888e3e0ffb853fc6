"""Who asks those in theatre to hold. It raises an alarm, and stops or changes nothing."""

import threading
from collections.abc import Callable

from server.alarms import AlarmDesk
from server.errors import SetupOrderError
from server.security import Person, Role
from tracker.navigation.alarms import AlarmPicture


class Holds:
    """Several may ask at once: the alarm stands until each of them has released, or the operator has.

    Safe to use from any thread.

    Args:
        desk: where the alarm is raised.
    """

    def __init__(self, desk: AlarmDesk) -> None:
        self._desk = desk
        self._lock = threading.Lock()
        self._asking: dict[str, str] = {}
        # Called after each change, so that everybody in the room is told.
        self.tell: Callable[[], None] = lambda: None

    @property
    def asking(self) -> tuple[tuple[str, str], ...]:
        """Who asks: their ids and names, in the order in which they asked."""
        with self._lock:
            return tuple(self._asking.items())

    def ask(self, person: Person, *, name: str = "") -> AlarmPicture:
        """This person asks to hold; `name` is taken where nobody has to sign in."""
        with self._lock:
            self._asking[person.id] = name or person.name
            picture = self._desk.ask_hold(by=self._names())
        self.tell()
        return picture

    def release(self, person: Person, *, name: str = "") -> AlarmPicture:
        """This person asks no more; the operator ends it for everybody.

        Raises:
            SetupOrderError: HOLD_NOT_YOURS.
        """
        with self._lock:
            if person.role is Role.OPERATOR:
                self._asking.clear()
            elif person.id not in self._asking and self._asking:
                raise SetupOrderError(
                    "HOLD_NOT_YOURS",
                    f"the hold was asked for by {self._names()}, not by {person.name}",
                    "Leave it to who asked, or to the operator.",
                    {"asked_by": list(self._asking.values())},
                )
            self._asking.pop(person.id, None)
            if self._asking:
                picture = self._desk.ask_hold(by=self._names())
            else:
                picture = self._desk.release_hold(by=name or person.name)
        self.tell()
        return picture

    def _names(self) -> str:
        return ", ".join(dict.fromkeys(self._asking.values()))
