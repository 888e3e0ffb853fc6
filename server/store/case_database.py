"""Sessions on the database: short transactions, a single writer, time stamps as text."""

import threading
from collections.abc import Callable, Iterator
from contextlib import contextmanager

import structlog
from sqlalchemy.orm import Session

from server.clock import Clock, utc_now, utc_text
from server.store.database import open_database, truncate_journal, with_immediate_transactions
from server.store.errors import StoreConflict, translate_errors
from server.store.home import Home

log = structlog.get_logger(__name__)


class CaseDatabase:
    """The open database of a home. Thread-safe."""

    def __init__(self, home: Home, *, clock: Clock = utc_now) -> None:
        self.home = home
        self._clock = clock
        self._engine = open_database(home, now=clock)
        self._writing = with_immediate_transactions(self._engine)
        self._write_lock = threading.RLock()
        self._in_use: dict[str, int] = {}
        self._listeners: list[Callable[[], None]] = []

    @property
    def now(self) -> str:
        """Current time, UTC, ISO 8601 with milliseconds."""
        return utc_text(self._clock())

    @contextmanager
    def read_session(self) -> Iterator[Session]:
        """Context manager for a read transaction, with a consistent snapshot."""
        with translate_errors(self.home.folder), Session(self._engine) as session, session.begin():
            yield session

    @contextmanager
    def write_session(self) -> Iterator[Session]:
        """Context manager for an atomic write transaction; it is on the disk after the block."""
        with (
            self._write_lock,
            translate_errors(self.home.folder),
            Session(self._writing) as session,
            session.begin(),
        ):
            yield session
        for listener in self._listeners:
            try:
                listener()
            except Exception:
                # The transaction is committed: an error in a listener must not undo it.
                log.exception("a listener failed after a change of the store")

    def add_commit_listener(self, listener: Callable[[], None]) -> None:
        """Register a function to be called after each commit, in the thread that committed."""
        self._listeners.append(listener)

    @contextmanager
    def in_use(self, case_id: str) -> Iterator[None]:
        """Context manager that prevents the deletion of the case."""
        with self._write_lock:
            self._in_use[case_id] = self._in_use.get(case_id, 0) + 1
        try:
            yield
        finally:
            with self._write_lock:
                self._in_use[case_id] -= 1
                if not self._in_use[case_id]:
                    del self._in_use[case_id]

    def reject_in_use(self, case_id: str) -> None:
        """Raise if the case is in use; call it inside `write_session`.

        Raises:
            StoreConflict: CASE_IN_USE, a file of it is being written, or it is being exported.
        """
        if case_id in self._in_use:
            raise StoreConflict(
                "CASE_IN_USE",
                f"the case {case_id} is in use by {self._in_use[case_id]} write or export operations",
                "Wait until they are done, or cancel them, then try again.",
                {"case_id": case_id, "in_use": self._in_use[case_id]},
            )

    def truncate_journal(self) -> None:
        """Truncate the journal, so that it contains no deleted data."""
        with self._write_lock, translate_errors(self.home.folder):
            truncate_journal(self._engine)

    def close(self) -> None:
        """Close the database; the home stays locked."""
        self._engine.dispose()
