"""The database as the rooms of the store use it: short transactions, one writer at a time, times as text."""

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import structlog
from sqlalchemy.orm import Session

from server.clock import Clock, utc_now, utc_text
from server.store.database import empty_journal, for_writing, open_database
from server.store.errors import StoreConflict, told
from server.store.home import Home

log = structlog.get_logger(__name__)


class Ledger:
    """The open database of a home; safe to use from any thread."""

    def __init__(self, home: Home, *, clock: Clock = utc_now) -> None:
        self.home = home
        self._clock = clock
        self._engine = open_database(home, now=clock)
        self._writing = for_writing(self._engine)
        self._turn = threading.RLock()
        self._held: dict[str, int] = {}
        self._listeners: list[Callable[[], None]] = []

    @property
    def now(self) -> str:
        """UTC, ISO 8601 with milliseconds."""
        return utc_text(self._clock())

    @contextmanager
    def reading(self) -> Iterator[Session]:
        """Everything that is read in here is of one moment."""
        with told(self.home.folder), Session(self._engine) as session, session.begin():
            yield session

    @contextmanager
    def writing(self) -> Iterator[Session]:
        """All that is changed in here, or nothing; at the end of the block it is on the disk."""
        with (
            self._turn,
            told(self.home.folder),
            Session(self._writing) as session,
            session.begin(),
        ):
            yield session
        for listener in self._listeners:
            try:
                listener()
            except Exception:
                # What was written is written: whoever only listens cannot undo that.
                log.exception("a change of the store could not be followed")

    def call_after_writing(self, listener: Callable[[], None]) -> None:
        """Have this called whenever something was changed, by the thread that changed it."""
        self._listeners.append(listener)

    @contextmanager
    def holding(self, case_id: str) -> Iterator[None]:
        """Until the end of the block the case cannot be deleted."""
        with self._turn:
            self._held[case_id] = self._held.get(case_id, 0) + 1
        try:
            yield
        finally:
            with self._turn:
                self._held[case_id] -= 1
                if not self._held[case_id]:
                    del self._held[case_id]

    def reject_held(self, case_id: str) -> None:
        """To be asked inside `writing`.

        Raises:
            StoreConflict: CASE_IN_USE, a file of it is being written, or it is being copied out.
        """
        if case_id in self._held:
            raise StoreConflict(
                "CASE_IN_USE",
                f"the case {case_id} is in use: {self._held[case_id]} times it is being written or copied",
                "Wait until that is done, or cancel it, then do it again.",
                {"case_id": case_id, "in_use": self._held[case_id]},
            )

    def empty_journal(self) -> None:
        """Leave nothing of what was deleted in the journal."""
        with self._turn, told(self.home.folder):
            empty_journal(self._engine)

    def close(self) -> None:
        """Close the database; the home stays."""
        self._engine.dispose()
