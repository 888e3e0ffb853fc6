"""Reads are answered from memory until the next commit, and are never stale."""

import pytest
from sqlalchemy import event
from sqlalchemy.engine import Engine

from server.store import Case, CaseStore, Current, Document, DocumentKind, OutOfDate, Validity
from server.store.read_cache import ReadCache

KIND = DocumentKind.CAMERA


def _reads(store: CaseStore, document: Document) -> tuple[Case | None, Document | None, object, Validity]:
    latest, every = store.latest(document.case_id, KIND, "main"), store.all(document.case_id, KIND)
    return store.get_open_case(), latest, every, store.validity(document)


def test_a_repeated_read_asks_the_database_once_until_something_is_committed(store: CaseStore) -> None:
    case = store.open(store.create("L3").id)
    first = store.put(case.id, KIND, "main", {"rms_px": 0.2}, made_by="M. Ito")
    statements: list[object] = []

    def count(*arguments: object) -> None:
        statements.append(arguments)

    case = store.get(case.id)
    event.listen(Engine, "before_cursor_execute", count)
    try:
        before = _reads(store, first)
        assert len(statements) > 4
        statements.clear()
        assert _reads(store, first) == before == (case, first, (first,), Current())
        assert statements == []
    finally:
        event.remove(Engine, "before_cursor_execute", count)

    second = store.put(case.id, KIND, "main", {"rms_px": 0.1}, made_by="M. Ito")
    _, latest, every, validity = _reads(store, first)
    assert (latest, every) == (second, (second,))
    assert isinstance(validity, OutOfDate)
    store.withdraw(second, by="M. Ito", reason="the lens was turned")
    store.close()
    assert _reads(store, first)[:3] == (None, None, ())


def test_what_was_read_while_something_was_committed_is_read_again() -> None:
    cache, values = ReadCache(), [1]

    def read_slowly() -> int:
        before = values[0]
        values[0] = 2
        cache.clear()
        return before

    assert cache.get("number", read_slowly) == 1
    assert cache.get("number", lambda: values[0]) == 2


def test_an_error_is_not_stored() -> None:
    cache = ReadCache()

    def fail() -> int:
        raise OSError("the disk is gone")

    with pytest.raises(OSError, match="the disk is gone"):
        cache.get("number", fail)
    assert cache.get("number", lambda: 3) == 3
