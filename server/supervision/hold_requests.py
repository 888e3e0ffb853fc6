"""Hold requests: they raise an alarm in theatre, and stop or change nothing."""

import threading
from collections.abc import Callable, Mapping

from server.alarms import AlarmService
from server.clock import Clock, utc_now, utc_text
from server.errors import SetupOrderError
from server.security import Person, Role
from server.supervision.hold_storage import HoldRequest, HoldStorage, NoHoldStorage
from tracker.navigation.alarms import AlarmSnapshot


class HoldRequests:
    """Hold requests of a theatre; the alarm stays until every person has released it, or the operator has.

    A hold belongs to the theatre and not to a case: it survives the opening and closing of cases and a
    restart of the server. Thread-safe; requests and releases wait for the disk.

    Args:
        service: raises the alarm; at once for requests from before the start.
        storage: storage of the requests.
        clock: wall clock, for the time of a request.

    Raises:
        StoreError: the stored requests cannot be read.
    """

    def __init__(
        self, service: AlarmService, *, storage: HoldStorage | None = None, clock: Clock = utc_now
    ) -> None:
        self._service = service
        self._storage: HoldStorage = storage or NoHoldStorage()
        self._clock = clock
        self._lock = threading.Lock()
        # Immutable and replaced as a whole: the event loop reads it without waiting for the disk.
        self._requests: Mapping[str, HoldRequest] = {one.person_id: one for one in self._storage.read()}
        # Called after each change, to notify the room.
        self.on_change: Callable[[], None] = lambda: None
        if self._requests:
            service.request_hold(by=self._names())

    @property
    def requests(self) -> tuple[HoldRequest, ...]:
        """Open requests, oldest first."""
        return tuple(self._requests.values())

    def request(self, person: Person, *, name: str = "") -> AlarmSnapshot:
        """Add a person's request; `name` is used where sign-in is off.

        Raises:
            StoreError: it cannot be stored; the alarm is raised all the same, until a restart of the server.
        """
        with self._lock:
            before = self._requests.get(person.id)
            at = utc_text(self._clock()) if before is None else before.at
            request = HoldRequest(person_id=person.id, name=name or person.name, at=at)
            return self._changed({**self._requests, person.id: request}, by=request.name)

    def release(self, person: Person, *, name: str = "") -> AlarmSnapshot:
        """Remove a person's request; the operator removes all.

        Raises:
            SetupOrderError: HOLD_NOT_YOURS.
            StoreError: the release cannot be stored; the hold has ended all the same, until a restart.
        """
        with self._lock:
            is_operator = person.role is Role.OPERATOR
            if self._requests and not is_operator and person.id not in self._requests:
                raise SetupOrderError(
                    "HOLD_NOT_YOURS",
                    f"the hold was requested by {self._names()}, not by {person.name}",
                    "Ask this person or the operator to release it.",
                    {
                        "requested_by": [one.name for one in self._requests.values()],
                        "by": self._names(),
                        "person": person.name,
                    },
                )
            others = {key: one for key, one in self._requests.items() if key != person.id and not is_operator}
            return self._changed(others, by=name or person.name)

    def _changed(self, requests: Mapping[str, HoldRequest], *, by: str) -> AlarmSnapshot:
        """Update the alarm first, whatever the disk does; then store the change."""
        self._requests = requests
        picture = (
            self._service.request_hold(by=self._names()) if requests else self._service.release_hold(by=by)
        )
        self.on_change()
        self._storage.write(requests.values())
        return picture

    def _names(self) -> str:
        return ", ".join(dict.fromkeys(one.name for one in self._requests.values()))
