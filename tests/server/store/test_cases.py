"""Cases: create, find, open, rename, delete."""

from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

import pytest
from sqlalchemy.orm import Session

from server.store import CaseStore, DocumentKind, Home, NotFound, StoreConflict, StoreError
from server.store.case_database import CaseDatabase
from tracker.errors import InvalidInput


def test_a_case_is_found_again_by_the_next_server(tmp_path: Path) -> None:
    with Home(tmp_path) as home, CaseStore(home) as store:
        case = store.create("  Müller 😀/../x  ")
        assert case.name == "Müller 😀/../x"
        store.open(case.id)
    with Home(tmp_path) as home, CaseStore(home) as store:
        assert store.list() == (case,)
        assert store.get(case.id) == case
        assert store.get_open_case() == case
        store.close()
        assert store.get_open_case() is None
        store.close()


def test_no_name_becomes_a_part_of_a_path(store: CaseStore, home: Home) -> None:
    case = store.create("../../escape")
    with store.new_file(case.id, ".bin") as new:
        new.path.write_bytes(b"x")
    assert {path.name for path in home.cases.iterdir()} == {case.id}


def test_one_case_is_open_at_a_time(store: CaseStore) -> None:
    one, two = store.create("one"), store.create("two")
    assert store.get_open_case() is None
    store.open(one.id)
    assert store.open(two.id) == two
    assert store.get_open_case() == two
    with pytest.raises(NotFound):
        store.open("nothing")
    assert store.get_open_case() == two


def test_the_list_has_the_newest_first(store: CaseStore) -> None:
    made = [store.create(f"case {n}") for n in range(50)]
    assert store.list() == tuple(reversed(made))


def test_a_new_name_is_kept(store: CaseStore) -> None:
    case = store.create("one")
    renamed = store.rename(case.id, "two")
    assert (renamed.name, renamed.id) == ("two", case.id)
    assert renamed.changed_at > case.changed_at
    assert store.get(case.id) == renamed


@pytest.mark.parametrize("confirm", ["", "two", "ONE", "one two"])
def test_a_case_is_deleted_only_by_its_name(store: CaseStore, confirm: str) -> None:
    case = store.create("one")
    with pytest.raises(InvalidInput) as rejected:
        store.delete(case.id, confirm=confirm)
    assert rejected.value.code == "CONFIRMATION_WRONG"
    assert "one" not in rejected.value.message.split()
    assert store.list() == (case,)


def test_an_open_case_and_one_that_is_written_are_not_deleted(store: CaseStore) -> None:
    case = store.create("one")
    store.open(case.id)
    with pytest.raises(StoreConflict, match="is open"):
        store.delete(case.id, confirm="one")
    store.close()
    with store.new_file(case.id, ".bin") as new:
        new.path.write_bytes(b"x")
        with pytest.raises(StoreConflict) as rejected:
            store.delete(case.id, confirm="one")
    assert rejected.value.code == "CASE_IN_USE"
    store.delete(case.id, confirm="one")
    assert store.list() == ()


def test_on_a_full_disk_a_case_can_still_be_deleted(
    store: CaseStore, home: Home, monkeypatch: pytest.MonkeyPatch
) -> None:
    case = store.create("one")
    real, room = CaseDatabase.write_session, []

    @contextmanager
    def writing(database: CaseDatabase) -> Iterator[Session]:
        room.append(not home.reserve.exists())
        if not room[-1]:
            raise StoreError("STORE_FULL", "full", "Make room.")
        with real(database) as session:
            yield session

    monkeypatch.setattr(CaseDatabase, "write_session", writing)
    store.delete(case.id, confirm="one")
    assert room[:2] == [False, True]
    assert store.list() == ()
    assert home.reserve.stat().st_size == 2**20


def test_nothing_of_a_deleted_case_is_left_on_the_disk(store: CaseStore, home: Home) -> None:
    stored, case = store.create("kept"), store.create("Zaphod Beeblebrox")
    store.put(case.id, DocumentKind.PATIENT, "main", {"name": "Trillian McMillan"}, made_by="ito")
    with store.new_file(case.id, ".bin") as new:
        new.path.write_bytes(b"Marvin" * 1000)
    store.delete(case.id, confirm="Zaphod Beeblebrox")
    left = b"".join(path.read_bytes() for path in home.folder.rglob("*") if path.is_file())
    for word in (b"Zaphod", b"Trillian", b"Marvin"):
        assert word not in left
    assert b"kept" in left
    assert store.list() == (stored,)
    with pytest.raises(NotFound):
        store.get(case.id)
    with pytest.raises(NotFound):
        store.all(case.id, DocumentKind.PATIENT)
