"""The home folder and its database."""

import errno
import os
import shutil
import sqlite3
import subprocess
import sys
from contextlib import closing
from pathlib import Path

import alembic.autogenerate
import filelock
import pytest
from alembic.config import Config
from alembic.runtime.migration import MigrationContext
from alembic.script import ScriptDirectory
from sqlalchemy import create_engine

from server.clock import utc_now
from server.home_folder import home_folder
from server.store import CaseStore, DocumentKind, Home, StoreError
from server.store.database import CURRENT_REVISION, MIGRATIONS, open_database
from server.store.tables import Table

REPOSITORY = Path(__file__).parents[3]
HOLD = """
import sys
from pathlib import Path
from server.store import Home
with Home(Path(sys.argv[1])):
    print("mine", flush=True)
    sys.stdin.read()
"""


def test_the_environment_names_the_folder() -> None:
    assert home_folder({"COAXIAL_HOME": "/x/y"}) == Path("/x/y")
    assert home_folder({"COAXIAL_HOME": "y"}) == Path.cwd() / "y"
    assert home_folder({"COAXIAL_HOME": " "}).name == "coaxial"


def test_two_servers_never_share_a_folder(tmp_path: Path) -> None:
    with (
        subprocess.Popen(
            [sys.executable, "-c", HOLD, str(tmp_path)],
            env={**os.environ, "PYTHONPATH": str(REPOSITORY)},
            stdin=subprocess.PIPE,
            stdout=subprocess.PIPE,
        ) as other,
    ):
        assert other.stdout is not None
        assert other.stdout.readline() == b"mine\n"
        with pytest.raises(StoreError, match="another Coaxial is running with the folder") as rejected:
            Home(tmp_path)
        assert rejected.value.code == "HOME_IN_USE"
        other.kill()
    Home(tmp_path).close()


@pytest.mark.parametrize("said", [OSError(errno.ENOLCK, "No locks available"), NotImplementedError("flock")])
def test_a_disk_without_locks_is_rejected_with_a_remedy(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch, said: Exception
) -> None:
    def acquire(*_: object, **__: object) -> None:
        raise said

    monkeypatch.setattr(filelock.FileLock, "acquire", acquire)
    with pytest.raises(StoreError, match="does not support file locks") as rejected:
        Home(tmp_path)
    assert rejected.value.code == "HOME_NOT_LOCKABLE"
    assert "COAXIAL_HOME" in rejected.value.remedy


def test_a_rejected_second_server_does_not_touch_the_work_of_the_first(home: Home) -> None:
    work = home.temporary / "upload"
    work.write_bytes(b"half")
    with pytest.raises(StoreError):
        Home(home.folder)
    assert work.exists()


def test_temporary_work_is_gone_at_the_next_start(tmp_path: Path) -> None:
    with Home(tmp_path) as home:
        (home.temporary / "job").mkdir()
        (home.temporary / "job" / "half").write_bytes(b"x")
    with Home(tmp_path) as home:
        assert list(home.temporary.iterdir()) == []


def test_only_its_user_can_look_into_it(home: Home) -> None:
    for folder in (home.folder, home.cases, home.temporary, home.backups):
        assert folder.stat().st_mode & 0o077 == 0


def test_the_migrations_make_the_tables_that_the_program_has(store: CaseStore, home: Home) -> None:
    del store
    engine = create_engine(f"sqlite:///{home.database}")
    with engine.connect() as connection:
        context = MigrationContext.configure(connection, opts={"compare_server_default": True})
        assert alembic.autogenerate.compare_metadata(context, Table.metadata) == []
    engine.dispose()


def test_what_is_committed_is_on_the_disk_and_documents_do_not_change(store: CaseStore, home: Home) -> None:
    case = store.create("one")
    store.put(case.id, DocumentKind.PLAN, "a", {}, made_by="ito")
    with store._database.write_session() as session:
        pragmas = ("journal_mode", "synchronous", "foreign_keys", "secure_delete")
        got = [session.connection().exec_driver_sql(f"PRAGMA {one}").scalar() for one in pragmas]
    assert got == ["wal", 2, 1, 1]
    for column in ("content", "made_by", "imported_by", "imported_at"):
        with (
            closing(sqlite3.connect(home.database)) as raw,
            pytest.raises(sqlite3.IntegrityError, match="never changes"),
        ):
            raw.execute(f"UPDATE documents SET {column} = '{{}}'")  # noqa: S608  our own words


def with_a_fourth_form(folder: Path, upgrade: str) -> Path:
    """The migrations with an additional one."""
    shutil.copytree(MIGRATIONS, folder)
    (folder / "versions" / "form_4.py").write_text(
        f"from alembic import op\nrevision = '4'\ndown_revision = '3'\ndef upgrade():\n    {upgrade}\n"
    )
    return folder


def revision_of(database: Path) -> str:
    with closing(sqlite3.connect(database)) as raw:
        return str(raw.execute("SELECT version_num FROM alembic_version").fetchone()[0])


def test_an_older_database_is_kept_before_it_is_changed_and_a_newer_one_rejected(tmp_path: Path) -> None:
    migrations = with_a_fourth_form(tmp_path / "m", "op.execute('ALTER TABLE cases ADD COLUMN more TEXT')")
    with Home(tmp_path / "h") as home:
        with CaseStore(home) as store:
            store.create("one")
        open_database(home, now=utc_now, migrations=migrations).dispose()
        assert revision_of(home.database) == "4"
        (backup,) = home.backups.iterdir()
        assert revision_of(backup) == "3"
        with closing(sqlite3.connect(backup)) as raw:
            assert raw.execute("SELECT name FROM cases").fetchall() == [("one",)]
        with pytest.raises(StoreError, match="has schema 4, this program supports schemas 3 to 3") as newer:
            CaseStore(home)
        assert newer.value.code == "STORE_SCHEMA_UNKNOWN"


def test_a_disk_too_full_for_a_migration_is_reported_before_anything_is_changed(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    migrations = with_a_fourth_form(tmp_path / "m", "op.execute('ALTER TABLE cases ADD COLUMN more TEXT')")
    with Home(tmp_path / "h") as home:
        CaseStore(home).dispose()
        asked = []
        monkeypatch.setattr(home, "reject_without_space", asked.append)
        open_database(home, now=utc_now, migrations=migrations).dispose()
        assert asked == [2 * next(home.backups.iterdir()).stat().st_size]


def test_a_migration_that_fails_changes_nothing(tmp_path: Path) -> None:
    migrations = with_a_fourth_form(
        tmp_path / "m",
        "op.execute('ALTER TABLE cases ADD COLUMN more TEXT'); op.execute('DROP TABLE no_such')",
    )
    with Home(tmp_path / "h") as home:
        with CaseStore(home) as store:
            case = store.create("one")
        with pytest.raises(StoreError, match="no such table"):
            open_database(home, now=utc_now, migrations=migrations)
        assert revision_of(home.database) == "3"
        with CaseStore(home) as store:
            assert store.list() == (case,)


def test_a_database_older_than_the_first_migration_is_rejected_and_not_changed(tmp_path: Path) -> None:
    with Home(tmp_path / "h") as home:
        with CaseStore(home):
            pass
        with closing(sqlite3.connect(home.database)) as raw:
            raw.execute("UPDATE alembic_version SET version_num = '2'")
            raw.commit()
        with pytest.raises(StoreError, match="has schema 2, this program supports schemas 3 to 3") as older:
            CaseStore(home)
        assert older.value.code == "STORE_SCHEMA_UNKNOWN"
        assert revision_of(home.database) == "2"
        assert list(home.backups.iterdir()) == []


def test_a_damaged_database_stops_the_start_with_a_sentence(tmp_path: Path) -> None:
    with Home(tmp_path) as home:
        with CaseStore(home) as store:
            for n in range(50):
                store.create(f"{n}")
        content = bytearray(home.database.read_bytes())
        for at in range(4096, len(content), 512):
            content[at : at + 256] = b"\x5a" * 256
        home.database.write_bytes(content)
        with pytest.raises(StoreError) as broken:
            CaseStore(home)
        assert broken.value.code == "STORE_DAMAGED"
        home.database.write_bytes(b"this is a letter, no database" * 500)
        with pytest.raises(StoreError) as strange:
            CaseStore(home)
        assert strange.value.code == "STORE_DAMAGED"
        assert "backups" in strange.value.remedy


def test_a_full_disk_is_reported_and_costs_nothing_that_was_confirmed(store: CaseStore) -> None:
    case = store.create("one")
    stored = store.put(case.id, DocumentKind.PLAN, "a", {}, made_by="ito")
    with store._database.write_session() as session:
        # SQLite's own limit fails with the error of a full disk.
        pages = session.connection().exec_driver_sql("PRAGMA page_count").scalar()
    pool = store._database._engine.raw_connection()
    pool.driver_connection.execute(f"PRAGMA max_page_count = {pages}")  # pyrefly: ignore[missing-attribute]  # SQLite's own
    pool.close()
    with pytest.raises(StoreError) as full:
        store.put(case.id, DocumentKind.PLAN, "a", {"much": "x" * 100_000}, made_by="ito")
    assert full.value.code == "STORE_FULL"
    assert store.history(case.id, DocumentKind.PLAN, "a") == (stored,)


@pytest.mark.skipif(os.geteuid() == 0, reason="root may write everywhere")
def test_a_folder_that_may_not_be_written_is_reported(tmp_path: Path) -> None:
    tmp_path.chmod(0o500)
    with pytest.raises(StoreError) as rejected:
        Home(tmp_path)
    assert rejected.value.code == "STORE_READ_ONLY"
    assert "COAXIAL_HOME" in rejected.value.remedy


def test_a_database_that_may_not_be_written_is_reported(store: CaseStore) -> None:
    pool = store._database._engine.raw_connection()
    pool.driver_connection.execute("PRAGMA query_only = ON")  # pyrefly: ignore[missing-attribute]  # SQLite's own
    pool.close()
    with pytest.raises(StoreError) as rejected:
        store.create("one")
    assert rejected.value.code == "STORE_READ_ONLY"


def test_a_home_that_is_a_file_is_reported(tmp_path: Path) -> None:
    (tmp_path / "home").write_text("x")
    with pytest.raises(StoreError) as rejected:
        Home(tmp_path / "home")
    assert rejected.value.code == "STORE_FAILED"


def test_the_current_revision_is_that_of_the_newest_migration() -> None:
    config = Config()
    config.set_main_option("script_location", str(MIGRATIONS))
    config.set_main_option("path_separator", "os")
    assert ScriptDirectory.from_config(config).get_current_head() == CURRENT_REVISION
