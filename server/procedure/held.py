"""What is being collected for a step: one thing at a time, until it is kept or thrown away."""

import threading
from collections.abc import Callable
from typing import Generic, Protocol, TypeVar

from server.errors import SetupOrderError


class Stoppable(Protocol):
    """Something that collects in a thread of its own."""

    def stop(self) -> None:
        """Collect no more."""


Collection = TypeVar("Collection", bound=Stoppable)


class Held(Generic[Collection]):
    """Holds one collection. Safe to use from any thread.

    Args:
        what: is being collected, in words.
        remedy: how one begins to, in a sentence.
    """

    def __init__(self, what: str, *, remedy: str) -> None:
        self._what = what
        self._remedy = remedy
        self._lock = threading.Lock()
        self._collection: Collection | None = None

    def begin(self, make: Callable[[], Collection]) -> Collection:
        """Begin another one; what was collected before is thrown away."""
        with self._lock:
            if self._collection is not None:
                self._collection.stop()
            self._collection = make()
            return self._collection

    def get(self) -> Collection:
        """The one that is held.

        Raises:
            SetupOrderError: COLLECTION_MISSING.
        """
        with self._lock:
            if self._collection is None:
                raise SetupOrderError("COLLECTION_MISSING", f"no {self._what} being collected", self._remedy)
            return self._collection

    @property
    def is_there(self) -> bool:
        """Whether one is held."""
        with self._lock:
            return self._collection is not None

    def end(self) -> None:
        """Collect no more, and throw away what was collected."""
        with self._lock:
            if self._collection is not None:
                self._collection.stop()
            self._collection = None
