"""What the audit log has and the database lacks; losses by flipped bits are in `tests/server/store`."""

import sqlite3
from contextlib import closing
from pathlib import Path

import pytest

from server.cli.access_control import AccessControl
from server.config import Config
from server.security.audit import AuditLog, Entry, mark_lost_changes
from server.security.person import SERVER
from server.store import CaseStore, DocumentKind, Home

PLAN = DocumentKind.PLAN


@pytest.fixture
def written(tmp_path: Path) -> Path:
    """A home with two versions of a plan, and the database as it was after the first one."""
    with Home(tmp_path) as home:
        audit = AuditLog(tmp_path / "security")
        for version in (1, 2):
            with CaseStore(home) as store:
                store.set_change_listener(audit.record_change)
                case = store.list()[0] if store.list() else store.create("L4")
                store.put(case.id, PLAN, "main", {"number": version}, made_by="M. Ito")
                gone = store.create("gone").id
                store.put(gone, PLAN, "main", {}, made_by="M. Ito")
                store.delete(gone, confirm="gone")
            if version == 1:
                older = home.database.read_bytes()
        home.database.write_bytes(older)
    return tmp_path


def started(folder: Path) -> list[tuple[int, bool, bool]]:
    """Version, damage and validity of all documents after the next start."""
    with Home(folder) as home, CaseStore(home) as store:
        AccessControl.of(Config(), store.home.folder, new_operator_link=False).follow(store)
        (case,) = store.list()
        headings = [one.heading for one in store.outline(case.id)]
        return [(one.version, one.is_damaged, store.is_current(one)) for one in headings]


def test_a_lost_version_is_listed_as_damaged_and_the_older_one_is_not_valid(written: Path) -> None:
    for _ in range(2):
        assert started(written) == [(1, False, False), (2, True, False)]
    logged = (written / "security" / "audit.jsonl").read_text(encoding="utf-8")
    assert logged.count("version 2 lost on the disk") == 1


def test_a_changed_line_of_the_log_is_not_believed(written: Path) -> None:
    log = written / "security" / "audit.jsonl"
    changed = log.read_text(encoding="utf-8").replace('"from":1,"to":2', '"from":1,"to":9')
    log.write_text(changed, encoding="utf-8")
    assert started(written) == [(1, False, True)]


def test_a_document_whose_record_is_damaged_is_not_made_valid_by_the_log(written: Path) -> None:
    """The log may lack newer versions, if the disk was full."""
    log = written / "security" / "audit.jsonl"
    # Those of the first version.
    lines = log.read_text(encoding="utf-8").splitlines(keepends=True)
    log.write_text("".join(lines[:3]), encoding="utf-8")
    with closing(sqlite3.connect(written / "coaxial.sqlite3")) as raw:
        raw.execute("DELETE FROM newest_versions")
        raw.commit()
    assert (1, False, False) in started(written)


def test_what_is_as_it_was_confirmed_stays_so(tmp_path: Path) -> None:
    with Home(tmp_path) as home, CaseStore(home) as store:
        audit = AuditLog(tmp_path / "security")
        store.set_change_listener(audit.record_change)
        case = store.create("L4")
        store.open(case.id)
        plan = store.put(case.id, PLAN, "main", {}, made_by="M. Ito")
        store.withdraw(store.put(case.id, PLAN, "left", {}, made_by="M. Ito"), by="M. Ito", reason="left")
        audit.append(Entry(who=SERVER, what="start"))
        before = audit.head, store.outline(case.id)
        assert mark_lost_changes(store, audit) == 0
        assert (audit.head, store.outline(case.id)) == before
        assert store.is_current(plan)
        assert store.get_open_case() == store.get(case.id)
