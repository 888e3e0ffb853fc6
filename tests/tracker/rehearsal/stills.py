"""Static scenery of rehearsals that many tests share: rendering it takes about a second."""

from tracker.rehearsal.backdrop import Still

# Each takes some megabytes.
MAX_STILLS = 12


class RecentStills:
    """The newest renders of this process, as `StillStore`."""

    def __init__(self) -> None:
        self._stills: dict[bytes, Still] = {}

    def load(self, key: bytes) -> Still | None:
        """Return the render stored under this key; None if it is missing."""
        return self._stills.get(key)

    def save(self, key: bytes, still: Still) -> None:
        """Store the render in place of the oldest one."""
        if len(self._stills) == MAX_STILLS:
            del self._stills[next(iter(self._stills))]
        self._stills[key] = still


STILLS = RecentStills()
