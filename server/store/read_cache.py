"""Cache of read results until the next commit.

Only one server writes to a folder, so that read results stay valid until this process commits again. The
state of the procedure is polled, and reads the same few documents and their validity dozens of times.
"""

import threading
from collections.abc import Callable, Hashable
from typing import TypeVar, cast

T = TypeVar("T")


class ReadCache:
    """Immutable results of reads by their arguments. Thread-safe."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._commits = 0
        self._results: dict[Hashable, object] = {}

    def get(self, key: Hashable, read: Callable[[], T]) -> T:
        """Return the stored result of a read, or read it; an exception is not stored."""
        with self._lock:
            if key in self._results:
                return cast("T", self._results[key])
            commits = self._commits
        result = read()
        with self._lock:
            # Otherwise the result may be older than a commit during the read.
            if commits == self._commits:
                self._results[key] = result
        return result

    def clear(self) -> None:
        """Clear the cache after a commit."""
        with self._lock:
            self._commits += 1
            self._results.clear()
