"""The SQLite database: durable commits, integrity check, and migration to the current schema."""

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

from server.store.errors import StoreError, damaged_database, translate_errors
from server.store.home import Home, sync_folder

MIGRATIONS = Path(__file__).parent / "migrations"
BUSY_TIMEOUT_MS = 10_000
# secure_delete overwrites deleted patient data.
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
    """Open the database of a home, after an integrity check and migration to the current schema.

    Raises:
        StoreError: STORE_DAMAGED, STORE_NEWER, or as the disk says.
    """
    engine = create_engine(f"sqlite:///{home.database}")
    event.listen(engine, "connect", _prepare)
    event.listen(engine, "begin", _begin)
    with translate_errors(home.folder):
        try:
            _check(engine, home)
            _migrate(engine, home, now=now, migrations=migrations)
            sync_folder(home.folder)
        except BaseException:
            engine.dispose()
            raise
    return engine


def with_immediate_transactions(engine: Engine) -> Engine:
    """Return an engine with BEGIN IMMEDIATE, so that write transactions wait at their start."""
    return engine.execution_options(begins="IMMEDIATE")


def truncate_journal(engine: Engine) -> None:
    """Checkpoint and truncate the write-ahead log, so that no deleted data remains in it."""
    with _raw_connection(engine) as connection:
        connection.execute("PRAGMA wal_checkpoint(TRUNCATE)")


def _prepare(connection: DBAPIConnection, entry: ConnectionPoolEntry) -> None:
    del entry
    # The sqlite3 module starts transactions late, and not for DDL; they are started explicitly in `_begin`.
    connection.isolation_level = None
    cursor = connection.cursor()
    for pragma in PRAGMAS:
        cursor.execute(pragma)
    cursor.close()


def _begin(connection: Connection) -> None:
    connection.exec_driver_sql(f"BEGIN {connection.get_execution_options().get('begins', 'DEFERRED')}")


@contextmanager
def _raw_connection(engine: Engine) -> Iterator[sqlite3.Connection]:
    """Context manager for a connection without a transaction."""
    proxied = engine.raw_connection()
    try:
        connection = proxied.driver_connection
        if not isinstance(connection, sqlite3.Connection):
            raise TypeError(f"not SQLite: {connection!r}")
        yield connection
    finally:
        proxied.close()


def _check(engine: Engine, home: Home) -> None:
    with _raw_connection(engine) as connection:
        found = connection.execute("PRAGMA quick_check(1)").fetchone()[0]
    if found != "ok":
        raise damaged_database(home.folder, str(found))


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
    with with_immediate_transactions(engine).begin() as connection:
        config.attributes["connection"] = connection
        command.upgrade(config, "head")


def _reject_newer(scripts: ScriptDirectory, revision: str, home: Home) -> None:
    try:
        scripts.get_revision(revision)
    except CommandError as error:
        raise StoreError(
            "STORE_NEWER",
            f"the database in {home.folder} was made by a newer Coaxial (its schema is {revision}, this "
            f"program supports schemas up to {scripts.get_current_head()})",
            "Start the newer program again, or name another folder with COAXIAL_HOME.",
            {"found": revision, "known": scripts.get_current_head()},
        ) from error


def _back_up(engine: Engine, home: Home, *, name: str) -> None:
    """Make a durable backup of the database before the migration."""
    part = home.backups / f"{name}.part"
    with _raw_connection(engine) as source, closing(sqlite3.connect(part)) as target:
        target.execute("PRAGMA synchronous = FULL")
        source.backup(target)
    part.replace(home.backups / name)
    sync_folder(home.backups)
