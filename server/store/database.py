"""The database file: what is committed outlasts a power cut, and its form is that of this version."""

import sqlite3
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager
from datetime import datetime
from pathlib import Path

from alembic import command
from alembic.config import Config
from alembic.runtime.migration import MigrationContext
from alembic.script import ScriptDirectory
from alembic.util.exc import CommandError
from sqlalchemy import Connection, Engine, create_engine, event
from sqlalchemy.engine.interfaces import DBAPIConnection
from sqlalchemy.pool import ConnectionPoolEntry

from server.store.errors import StoreError, damaged, told
from server.store.home import Home, sync_folder

MIGRATIONS = Path(__file__).parent / "migrations"
BUSY_TIMEOUT_MS = 10_000
# Deleted patients are overwritten, not only forgotten.
PRAGMAS = (
    "PRAGMA journal_mode = WAL",
    "PRAGMA synchronous = FULL",
    "PRAGMA fullfsync = ON",
    "PRAGMA checkpoint_fullfsync = ON",
    "PRAGMA foreign_keys = ON",
    "PRAGMA secure_delete = ON",
    f"PRAGMA busy_timeout = {BUSY_TIMEOUT_MS}",
)


def open_database(home: Home, *, now: Callable[[], datetime], migrations: Path = MIGRATIONS) -> Engine:
    """The database of a home, sound and in this version's form.

    Raises:
        StoreError: STORE_DAMAGED, STORE_NEWER, or as the disk says.
    """
    engine = create_engine(f"sqlite:///{home.database}")
    event.listen(engine, "connect", _prepare)
    event.listen(engine, "begin", _begin)
    with told(home.folder):
        try:
            _check(engine, home)
            _migrate(engine, home, now=now, migrations=migrations)
            sync_folder(home.folder)
        except BaseException:
            engine.dispose()
            raise
    return engine


def for_writing(engine: Engine) -> Engine:
    """The same database; its transactions wait their turn at the beginning, so that none fails half way."""
    return engine.execution_options(begins="IMMEDIATE")


def empty_journal(engine: Engine) -> None:
    """Bring everything from the journal into the database, so that what was deleted is in neither."""
    with _bare(engine) as connection:
        connection.execute("PRAGMA wal_checkpoint(TRUNCATE)")


def _prepare(connection: DBAPIConnection, entry: ConnectionPoolEntry) -> None:
    del entry
    # Python begins transactions late, and not for changes of tables; ours begin where they are written.
    connection.isolation_level = None
    cursor = connection.cursor()
    for pragma in PRAGMAS:
        cursor.execute(pragma)
    cursor.close()


def _begin(connection: Connection) -> None:
    connection.exec_driver_sql(f"BEGIN {connection.get_execution_options().get('begins', 'DEFERRED')}")


@contextmanager
def _bare(engine: Engine) -> Iterator[sqlite3.Connection]:
    """A connection without a transaction around it."""
    proxied = engine.raw_connection()
    try:
        connection = proxied.driver_connection
        if not isinstance(connection, sqlite3.Connection):
            raise TypeError(f"not SQLite: {connection!r}")
        yield connection
    finally:
        proxied.close()


def _check(engine: Engine, home: Home) -> None:
    with _bare(engine) as connection:
        found = connection.execute("PRAGMA quick_check(1)").fetchone()[0]
    if found != "ok":
        raise damaged(home.folder, str(found))


def _migrate(engine: Engine, home: Home, *, now: Callable[[], datetime], migrations: Path) -> None:
    config = Config()
    config.set_main_option("script_location", str(migrations).replace("%", "%%"))
    config.set_main_option("path_separator", "os")
    wanted = ScriptDirectory.from_config(config).get_current_head()
    with engine.connect() as connection:
        revision = MigrationContext.configure(connection).get_current_revision()
    if revision == wanted:
        return
    if revision is not None:
        _reject_newer(ScriptDirectory.from_config(config), revision, home)
        _back_up(engine, home, name=f"coaxial-{revision}-{now():%Y%m%dT%H%M%SZ}.sqlite3")
    with for_writing(engine).begin() as connection:
        config.attributes["connection"] = connection
        command.upgrade(config, "head")


def _reject_newer(scripts: ScriptDirectory, revision: str, home: Home) -> None:
    try:
        scripts.get_revision(revision)
    except CommandError as error:
        raise StoreError(
            "STORE_NEWER",
            f"the database in {home.folder} was made by a newer Coaxial (its form is {revision}, this "
            f"program knows forms up to {scripts.get_current_head()})",
            "Start the newer program again, or name another folder with COAXIAL_HOME.",
            {"found": revision, "known": scripts.get_current_head()},
        ) from error


def _back_up(engine: Engine, home: Home, *, name: str) -> None:
    """A whole copy of the database beside it, on the disk before anything is changed."""
    part = home.backups / f"{name}.part"
    with _bare(engine) as source, closing(sqlite3.connect(part)) as target:
        target.execute("PRAGMA synchronous = FULL")
        source.backup(target)
    part.replace(home.backups / name)
    sync_folder(home.backups)
