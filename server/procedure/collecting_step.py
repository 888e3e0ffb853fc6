"""Base of the steps that collect from live images, one collection at a time."""

import threading
from collections.abc import Callable
from typing import Generic, Protocol, TypeVar

from server.errors import SetupOrderError


class Stoppable(Protocol):
    """A collection that runs in its own thread."""

    def stop(self) -> None:
        """Stop collecting."""


Collection = TypeVar("Collection", bound=Stoppable)


class CollectingStep(Generic[Collection]):
    """A step with at most one active collection, until it is stored or discarded. Thread-safe.

    Args:
        what: Subject and verb of the error message if there is no collection, such as "sweep is".
        remedy: How to start a collection, one sentence.
    """

    def __init__(self, what: str, *, remedy: str) -> None:
        self._what = what
        self._remedy = remedy
        self._collection_lock = threading.Lock()
        self._collection: Collection | None = None

    def _start(self, make: Callable[[], Collection]) -> Collection:
        """Stop and discard the active collection, then start a new one."""
        with self._collection_lock:
            if self._collection is not None:
                self._collection.stop()
            self._collection = make()
            return self._collection

    @property
    def collection(self) -> Collection:
        """The active collection.

        Raises:
            SetupOrderError: COLLECTION_MISSING.
        """
        with self._collection_lock:
            if self._collection is None:
                raise SetupOrderError(
                    "COLLECTION_MISSING",
                    f"no {self._what} in progress",
                    self._remedy,
                    {"collection": self._what},
                )
            return self._collection

    @property
    def is_collecting(self) -> bool:
        """Whether there is an active collection."""
        with self._collection_lock:
            return self._collection is not None

    def end(self) -> None:
        """Stop the active collection and discard its data."""
        with self._collection_lock:
            if self._collection is not None:
                self._collection.stop()
            self._collection = None

    def _end(self, collection: Collection) -> None:
        """Stop this collection and discard its data; one that was started meanwhile goes on."""
        with self._collection_lock:
            collection.stop()
            if self._collection is collection:
                self._collection = None
