"""Reads are answered from memory until the next commit, are never stale, and read only what is new."""

import threading
from collections.abc import Iterator
from contextlib import contextmanager

import pytest
from sqlalchemy import event
from sqlalchemy.engine import Engine

from server.store import (
    Case,
    CaseStore,
    Current,
    Document,
    DocumentKind,
    NotFound,
    OutOfDate,
    StoreError,
    Validity,
)

KIND = DocumentKind.CAMERA


@contextmanager
def statements() -> Iterator[list[str]]:
    """The SQL that is executed meanwhile."""
    executed: list[str] = []

    def note(*arguments: object) -> None:
        executed.append(str(arguments[2]))

    event.listen(Engine, "before_cursor_execute", note)
    try:
        yield executed
    finally:
        event.remove(Engine, "before_cursor_execute", note)


def _reads(store: CaseStore, document: Document) -> tuple[Case | None, Document | None, object, Validity]:
    latest, every = store.latest(document.case_id, KIND, "main"), store.all(document.case_id, KIND)
    return store.get_open_case(), latest, every, store.validity(document)


def test_a_repeated_read_asks_the_database_once_until_something_is_committed(store: CaseStore) -> None:
    case = store.open(store.create("L3").id)
    first = store.put(case.id, KIND, "main", {"rms_px": 0.2}, made_by="M. Ito")
    case = store.get(case.id)
    with statements() as executed:
        before = _reads(store, first)
        assert executed
        executed.clear()
        assert _reads(store, first) == before == (case, first, (first,), Current())
        assert executed == []

    second = store.put(case.id, KIND, "main", {"rms_px": 0.1}, made_by="M. Ito")
    _, latest, every, validity = _reads(store, first)
    assert (latest, every) == (second, (second,))
    assert isinstance(validity, OutOfDate)
    store.withdraw(second, by="M. Ito", reason="the lens was turned")
    store.close()
    assert _reads(store, first)[:3] == (None, None, ())


def test_after_a_change_only_new_contents_are_read(store: CaseStore) -> None:
    case_id = store.create("L3").id
    put = [store.put(case_id, KIND, f"camera {k}", {"k": k}, made_by="M. Ito") for k in range(20)]
    assert store.all(case_id, KIND) == tuple(sorted(put, key=lambda one: one.name))
    new = store.put(case_id, KIND, "camera 5", {"k": -5}, made_by="M. Ito")
    with statements() as executed:
        assert new in store.all(case_id, KIND)
        assert [isinstance(store.validity(one), OutOfDate) for one in put] == [k == 5 for k in range(20)]
    assert sum("documents.content" in one for one in executed) == 1
    # The case, new headings with their dependencies and files, and the one content with its case.
    assert len(executed) < 10


@pytest.mark.parametrize("change", ["withdrawn", "deleted"])
def test_a_listener_of_the_commit_already_sees_it(store: CaseStore, change: str) -> None:
    case = store.create("L3")
    document = store.put(case.id, KIND, "main", {}, made_by="M. Ito")
    assert store.latest(case.id, KIND, "main") == document
    seen: list[object] = []

    def read() -> None:
        try:
            seen.append(store.latest(case.id, KIND, "main"))
        except NotFound as error:
            seen.append(error.code)

    store.add_commit_listener(read)
    if change == "withdrawn":
        store.withdraw(document, by="M. Ito", reason="the lens was turned")
        assert seen == [None]
    else:
        store.delete(case.id, confirm="L3")
        assert set(seen) == {"CASE_UNKNOWN"}


def test_a_withdrawal_is_not_lost_to_a_reader_that_reads_at_the_same_time(store: CaseStore) -> None:
    case_id = store.create("L3").id
    documents = [store.put(case_id, KIND, f"camera {k}", {}, made_by="M. Ito") for k in range(10)]
    done = threading.Event()

    def read() -> None:
        while not done.is_set():
            store.all(case_id, KIND)

    readers = [threading.Thread(target=read) for _ in range(3)]
    for reader in readers:
        reader.start()
    try:
        for k, document in enumerate(documents):
            store.withdraw(document, by="M. Ito", reason="the lens was turned")
            assert len(store.all(case_id, KIND)) == 10 - k - 1
    finally:
        done.set()
        for reader in readers:
            reader.join()


def test_two_cases_are_not_mixed(store: CaseStore) -> None:
    ids = [store.create(name).id for name in ("L3", "L4")]
    put = [store.put(one, KIND, "main", {"case": one}, made_by="M. Ito") for one in ids]
    for _ in range(2):
        assert [store.latest(one, KIND, "main") for one in ids] == put
    with pytest.raises(NotFound, match="there is no document"):
        store.document(ids[0], put[1].id)


def test_an_error_is_not_stored(store: CaseStore, monkeypatch: pytest.MonkeyPatch) -> None:
    case_id = store.create("L3").id
    document = store.put(case_id, KIND, "main", {}, made_by="M. Ito")

    def fail(*_: object) -> None:
        raise OSError("the disk is gone")

    monkeypatch.setattr("server.store.case_index.new_documents", fail)
    with pytest.raises(StoreError, match="the disk is gone"):
        store.latest(case_id, KIND, "main")
    monkeypatch.undo()
    assert store.latest(case_id, KIND, "main") == document


def test_of_many_documents_all_are_read(store: CaseStore, monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("server.store.case_index.MAX_CONTENTS", 3)
    case_id = store.create("L3").id
    put = [store.put(case_id, KIND, f"camera {k}", {"k": k}, made_by="M. Ito") for k in range(5)]
    assert store.all(case_id, KIND) == tuple(put)
    assert [store.document(case_id, one.id) for one in put] == put
