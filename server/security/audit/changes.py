"""Changes made by a request, collected for its audit entry."""

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar

_changes: ContextVar[list[dict[str, object]] | None] = ContextVar("coaxial_audit_changes", default=None)
MAX_CHANGES = 100


@contextmanager
def collect_changes() -> Iterator[list[dict[str, object]]]:
    """Collect the changes made in this context, in any thread; the list is extended in place."""
    changes: list[dict[str, object]] = []
    token = _changes.set(changes)
    try:
        yield changes
    finally:
        _changes.reset(token)


def note(change: dict[str, object]) -> bool:
    """Note a change; return False outside of a request."""
    changes = _changes.get()
    if changes is None:
        return False
    if len(changes) < MAX_CHANGES:
        changes.append(change)
    return True
