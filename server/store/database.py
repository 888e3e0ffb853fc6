"""The SQLite database: durable commits, and an integrity check when it is opened."""

import sqlite3
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from datetime import datetime
from pathlib import Path

from sqlalchemy import Connection, Engine, create_engine, event, inspect, text
from sqlalchemy.engine.interfaces import DBAPIConnection
from sqlalchemy.pool import ConnectionPoolEntry

from server.store.errors import damaged_database, translate_errors
from server.store.home import Home, sync_folder

MIGRATIONS = Path(__file__).parent / "migrations"
# Revision of the newest file in `MIGRATIONS`.
CURRENT_REVISION = "2"
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
        StoreError: STORE_DAMAGED, STORE_SCHEMA_UNKNOWN, or the code of a disk error.
    """
    engine = create_engine(f"sqlite:///{home.database}")
    event.listen(engine, "connect", _prepare)
    event.listen(engine, "begin", _begin)
    with translate_errors(home.folder):
        try:
            _check(engine, home)
            if migrations != MIGRATIONS or _revision(engine) != CURRENT_REVISION:
                # Imported on demand: Alembic takes half a second, and most starts need no migration.
                from server.store.migration import migrate  # noqa: PLC0415

                migrate(engine, home, now=now, migrations=migrations)
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
    with raw_connection(engine) as connection:
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
def raw_connection(engine: Engine) -> Iterator[sqlite3.Connection]:
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
    with raw_connection(engine) as connection:
        found = connection.execute("PRAGMA quick_check(1)").fetchone()[0]
    if found != "ok":
        raise damaged_database(home.folder, str(found))


def _revision(engine: Engine) -> str | None:
    """Return the revision of the schema; None for an empty database."""
    with engine.connect() as connection:
        if not inspect(connection).has_table("alembic_version"):
            return None
        return connection.execute(text("SELECT version_num FROM alembic_version")).scalar()
