"""What a request changes, noted by whoever changes it, for the audit log's line of that request."""

from collections.abc import Iterator
from contextlib import contextmanager
from contextvars import ContextVar

_noted: ContextVar[list[dict[str, object]] | None] = ContextVar("coaxial_audit_noted", default=None)
MAX_CHANGES = 100


@contextmanager
def noting() -> Iterator[list[dict[str, object]]]:
    """What is noted by this request, in whatever thread it works; the list grows while it does."""
    changes: list[dict[str, object]] = []
    token = _noted.set(changes)
    try:
        yield changes
    finally:
        _noted.reset(token)


def note(change: dict[str, object]) -> bool:
    """Say what is being changed; False where no request is being worked on."""
    changes = _noted.get()
    if changes is None:
        return False
    if len(changes) < MAX_CHANGES:
        changes.append(change)
    return True
