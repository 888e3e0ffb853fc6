"""What the disk changed in the database is named, and what depends on it is invalid; the rest can be used."""

import sqlite3
from contextlib import closing
from dataclasses import replace
from pathlib import Path

import pytest

from server.store import (
    CaseStore,
    Current,
    Document,
    DocumentKind,
    Entry,
    Home,
    OutOfDate,
    StoreConflict,
    StoreError,
)
from tests.server.store.bit_flips import fault_of, flip_bits

CT, PLAN, REGISTRATION = DocumentKind.CT, DocumentKind.PLAN, DocumentKind.REGISTRATION


def damage(home: Home, statement: str, *values: object) -> None:
    """Change the database as a disk does, which asks no trigger and makes no checksum."""
    with closing(sqlite3.connect(home.database)) as raw:
        for (name,) in raw.execute("SELECT name FROM sqlite_master WHERE type = 'trigger'").fetchall():
            raw.execute(f"DROP TRIGGER {name}")
        assert raw.execute(statement, values).rowcount == 1
        raw.commit()


def put(store: CaseStore, kind: DocumentKind, *on: Document, case: str, **content: object) -> Document:
    return store.put(case, kind, "main", content, made_by="ito", depends_on=[one.id for one in on])


@pytest.fixture
def chain(store: CaseStore) -> list[Document]:
    """A CT, two versions of a plan on it, and a registration on the second one."""
    case = store.create("one").id
    ct = put(store, CT, case=case)
    plans = [put(store, PLAN, ct, case=case, number=n) for n in (1, 2)]
    return [ct, *plans, put(store, REGISTRATION, plans[1], case=case)]


def entry_of(store: CaseStore, document: Document) -> Entry:
    (found,) = (
        one
        for one in store.outline(document.case_id)
        if (one.heading.kind, one.heading.version) == (document.kind, document.version)
    )
    return found


@pytest.mark.parametrize(
    ("column", "value"),
    [
        ("content", '{"number":3}'),
        ("content", b'{"number":2}'),
        ("content", None),
        ("kind", "plbn"),
        ("name", "mbin"),
        ("version", 3),
        ("version", 2**40),
        ("made_at", "2026-11-21T09:00:00.252Z"),
        ("made_by", "itn"),
        ("imported_by", "ito"),
        ("case_id", "0123456789abcdef"),
        ("id", "0123456789abcdef"),
        ("id", None),
    ],
)
def test_a_damaged_version_is_named_and_no_older_one_takes_its_place(
    home: Home, chain: list[Document], column: str, value: object
) -> None:
    _, old, plan, registration = chain
    with closing(sqlite3.connect(home.database)) as raw:
        # A disk knows no constraints either.
        raw.execute("PRAGMA writable_schema = ON")
        raw.execute("UPDATE sqlite_master SET sql = replace(sql, ' NOT NULL', '') WHERE name = 'documents'")
        raw.commit()
    damage(home, f"UPDATE documents SET {column} = ? WHERE id = ?", value, plan.id)  # noqa: S608  our own words
    with CaseStore(home) as store:
        assert store.latest(plan.case_id, PLAN, "main") is None
        assert store.all(plan.case_id, PLAN) == ()
        with pytest.raises(StoreError) as damaged:
            store.current(plan.case_id, PLAN, "main")
        assert damaged.value.code == "DOCUMENT_DAMAGED"
        found = entry_of(store, plan)
        assert found.heading.is_damaged
        assert isinstance(found.validity, OutOfDate)
        assert found.validity.reason == "plan 'main' version 2 is damaged on the disk"
        invalid = store.validity(registration)
        assert isinstance(invalid, OutOfDate)
        assert invalid.why.code == "BASIS_DAMAGED"
        assert isinstance(store.validity(old), OutOfDate)
        assert {one.problem for one in store.verify(plan.case_id)} == {"document"}
        with pytest.raises(StoreError, match="is damaged on the disk"):
            store.export_case(plan.case_id)
        # An import of the rest does not make an older version valid either.
        archive = store.export_case(plan.case_id, without_damaged=True)
        again = store.import_archive(archive.path, by="M. Ito").id
        assert store.latest(again, PLAN, "main") is None
        assert [one.heading.title for one in store.outline(again) if one.heading.is_damaged] == [plan.title]
        assert not store.is_current(replace(registration, case_id=again))


@pytest.mark.parametrize(
    "statement",
    [
        "DELETE FROM newest_versions WHERE kind = 'plan'",
        "UPDATE newest_versions SET version = 3 WHERE kind = 'plan'",
        "UPDATE newest_versions SET name = 'mbin' WHERE kind = 'plan'",
        "DELETE FROM documents WHERE kind = 'plan' AND version = 2",
        "DELETE FROM bases WHERE document_id = (SELECT id FROM documents WHERE version = 2)",
    ],
)
def test_a_version_that_may_be_lost_is_not_replaced_by_an_older_one(
    home: Home, chain: list[Document], statement: str
) -> None:
    case = chain[0].case_id
    damage(home, statement)
    with CaseStore(home) as store:
        assert store.latest(case, PLAN, "main") is None
        assert not any(
            store.is_current(one.heading) for one in store.outline(case) if one.heading.kind is PLAN
        )
        again = put(store, PLAN, chain[0], case=case, number=4)
        assert store.latest(case, PLAN, "main") == again
        assert store.validity(again) == Current()


def test_a_withdrawal_that_the_disk_removed_does_not_make_the_document_valid(
    store: CaseStore, home: Home, chain: list[Document]
) -> None:
    plan = store.withdraw(chain[2], by="ito", reason="wrong level")
    damage(home, "UPDATE documents SET withdrawn_at = NULL WHERE id = ?", plan.id)
    with CaseStore(home) as again:
        assert again.latest(plan.case_id, PLAN, "main") is None
        assert entry_of(again, plan).heading.is_damaged


def test_the_last_intact_version_is_used_again_only_on_request(home: Home, chain: list[Document]) -> None:
    ct, old, plan, registration = chain
    damage(home, "UPDATE documents SET content = '{\"number\":3}' WHERE id = ?", plan.id)
    with CaseStore(home) as store:
        changes = []
        store.set_change_listener(changes.append)
        restored = store.restore(old, by="abe")
        assert (restored.version, restored.made_by, restored.content) == (3, "abe", {"number": 1})
        assert restored.depends_on == (ct.id,)
        assert store.current(plan.case_id, PLAN, "main") == restored
        assert not store.is_current(registration)
        assert [(one.before, one.after, one.by) for one in changes] == [(1, 3, "abe")]
        # No longer damaged, and never for another version.
        for other in (old, ct):
            with pytest.raises(StoreConflict) as rejected:
                store.restore(other, by="abe")
            assert rejected.value.code == "NOT_RESTORABLE"


def test_damage_between_two_reads_is_found_when_the_content_is_read(
    store: CaseStore, home: Home, chain: list[Document]
) -> None:
    plan, registration = chain[2:]
    store.outline(plan.case_id)
    damage(home, "UPDATE documents SET content = '{\"number\":3}' WHERE id = ?", plan.id)
    with pytest.raises(StoreError, match="is damaged on the disk"):
        store.document(plan.case_id, plan.id)
    assert not store.is_current(registration)
    with pytest.raises(StoreError, match="is damaged on the disk"):
        store.withdraw(plan, by="ito", reason="damaged")


@pytest.mark.parametrize(("column", "value"), [("name", "onf"), ("state", "leaving"), ("created_at", None)])
def test_a_damaged_case_is_listed_and_not_deleted_and_used_again_under_a_new_name(
    home: Home, chain: list[Document], column: str, value: str | None
) -> None:
    case = chain[0].case_id
    with closing(sqlite3.connect(home.database)) as raw:
        raw.execute("PRAGMA writable_schema = ON")
        raw.execute("UPDATE sqlite_master SET sql = replace(sql, ' NOT NULL', '') WHERE name = 'cases'")
        raw.commit()
    damage(home, f"UPDATE cases SET {column} = ? WHERE id = ?", value, case)  # noqa: S608  our own words
    with CaseStore(home) as store:
        other = store.create("other")
        assert [one.is_damaged for one in store.list() if one.id == case] == [True]
        with pytest.raises(StoreError) as damaged:
            store.open(case)
        assert damaged.value.code == "CASE_DAMAGED"
        assert store.outline(other.id) == ()
        assert not store.rename(case, "one").is_damaged
        assert [store.document(case, one.id) for one in chain] == chain


def test_a_damaged_open_case_is_not_open_after_a_start(store: CaseStore, home: Home) -> None:
    case = store.open(store.create("one").id)
    damage(home, "UPDATE cases SET name = 'onf'")
    with CaseStore(home) as again:
        assert again.get_open_case() is None
        again.rename(case.id, "one")
        assert again.get_open_case() == again.get(case.id)


@pytest.mark.parametrize("column", ["sha256", "size_bytes", "state"])
def test_a_damaged_entry_of_a_file_is_reported_and_its_file_kept(home: Home, column: str) -> None:
    with CaseStore(home) as store:
        case = store.create("one").id
        with store.new_file(case, ".npy") as new:
            new.path.write_bytes(b"volume")
        file = new.stored
        ct = store.put(case, CT, "main", {}, made_by="ito", files=[file.id])
    damage(home, f"UPDATE files SET {column} = 'coming'")  # noqa: S608  our own words
    with CaseStore(home) as store:
        with pytest.raises(StoreError) as damaged:
            store.file(case, file.id)
        assert damaged.value.code == "FILE_DAMAGED"
        (found,) = store.verify(case)
        assert (found.file_id, found.documents) == (file.id, (ct.title_text,))
    assert file.path.read_bytes() == b"volume"


def test_an_index_that_differs_from_its_table_is_made_again_after_a_backup(
    store: CaseStore, home: Home, chain: list[Document]
) -> None:
    plan = chain[2]
    store.dispose()
    content = home.database.read_bytes()
    copies = [at for at in range(len(content)) if content.startswith(plan.id.encode(), at)]
    for at in copies:
        changed = bytearray(content)
        changed[at] ^= 1
        home.database.write_bytes(changed)
        with CaseStore(home) as again:
            headings = {one.heading.id: one.heading for one in again.outline(plan.case_id)}
            # Only the copies in the tables are part of a document: its own, and that of the registration.
            named = [one.kind for one in headings.values() if one.is_damaged]
            assert named in ([], [PLAN], [REGISTRATION])
    assert len(copies) > 3
    assert list(home.backups.iterdir())


def test_a_flipped_bit_is_without_effect_or_named(tmp_path: Path) -> None:
    result = flip_bits(tmp_path, flips=30, seed=13)
    assert result.silent == []
    assert result.outcomes["named"]


def test_a_flipped_bit_of_the_journal_after_a_crash_loses_no_confirmed_change_silently(
    tmp_path: Path,
) -> None:
    result = flip_bits(tmp_path / "a", flips=6, seed=1, in_journal=True)
    assert (result.silent, result.outcomes) == ([], {"named": 6})
    with fault_of("no-audit"):
        assert flip_bits(tmp_path / "b", flips=1, seed=1, in_journal=True).silent


@pytest.mark.parametrize("fault", ["no-checksum", "no-newest-version"])
def test_flips_find_a_store_without_checksums(tmp_path: Path, fault: str) -> None:
    with fault_of(fault):
        # Of these, five are in contents.
        assert flip_bits(tmp_path, flips=12, seed=13).silent
