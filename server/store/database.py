"""The SQLite database: durable commits, and an integrity check when it is opened.

SQLite checks the structure of its file. What rows contain is checked by their checksums when they are read,
so that a damaged row costs only what depends on it; the start fails only if the structure is damaged.
"""

import re
import sqlite3
from collections.abc import Callable, Iterator
from contextlib import closing, contextmanager, suppress
from datetime import datetime
from pathlib import Path

import structlog
from sqlalchemy import Connection, Engine, create_engine, event, inspect, text
from sqlalchemy.engine.interfaces import DBAPIConnection
from sqlalchemy.pool import ConnectionPoolEntry

from server.disk import sync_path
from server.store.errors import damaged_database, translate_errors
from server.store.home import Home

log = structlog.get_logger(__name__)

MIGRATIONS = Path(__file__).parent / "migrations"
# Revision of the newest file in `MIGRATIONS`.
CURRENT_REVISION = "3"
BUSY_TIMEOUT_MS = 10_000
# Complaints of the integrity check about values in rows, which their checksums find.
OF_VALUES = re.compile(r"(NULL|TEXT|NUMERIC|NON-\w+) value in |CHECK constraint failed in ")
# Complaints about an index that differs from its table, from which it can be made again.
OF_INDEXES = re.compile(
    r"(row \d+ missing from|wrong # of entries in|non-unique entry in) index |rowid not at end-of-record "
)
MAX_COMPLAINTS = 100
# secure_delete overwrites deleted patient data; cell_size_check finds some damaged pages before their use.
PRAGMAS = (
    "PRAGMA cell_size_check = ON",
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
            _check(engine, home, now)
            if migrations != MIGRATIONS or _revision(engine) != CURRENT_REVISION:
                # Imported on demand: Alembic takes half a second, and most starts need no migration.
                from server.store.migration import migrate  # noqa: PLC0415

                migrate(engine, home, now=now, migrations=migrations)
            sync_path(home.folder)
        except UnicodeDecodeError as error:
            # A complaint of SQLite can quote a damaged name that is no text.
            engine.dispose()
            raise damaged_database(home.folder, str(error)) from error
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
    # A damaged text must not make the whole case unreadable; it does not match its checksum.
    connection.text_factory = lambda content: content.decode("utf-8", "replace")
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


def _check(engine: Engine, home: Home, now: Callable[[], datetime]) -> None:
    """Check the structure of the database, and make indexes that differ from their tables again.

    Raises:
        StoreError: STORE_DAMAGED.
    """
    with raw_connection(engine) as connection:
        complaints = _complaints(connection)
        if complaints and all(OF_INDEXES.match(one) for one in complaints):
            back_up(engine, home, name=f"coaxial-damaged-{now():%Y%m%dT%H%M%SZ}.sqlite3")
            with suppress(sqlite3.IntegrityError):
                connection.execute("REINDEX")
            log.warning(
                "the disk has damaged the database, and its indexes were made again",
                code="STORE_REPAIRED",
                complaints=complaints[:10],
                remedy="Check the disk. Damaged documents are named in the list of documents of their case.",
            )
            complaints = _complaints(connection)
    if complaints:
        raise damaged_database(home.folder, complaints[0])


def _complaints(connection: sqlite3.Connection) -> list[str]:
    rows = connection.execute(f"PRAGMA integrity_check({MAX_COMPLAINTS})").fetchall()
    return [complaint for (complaint,) in rows if complaint != "ok" and not OF_VALUES.match(complaint)]


def back_up(engine: Engine, home: Home, *, name: str) -> None:
    """Make a durable backup of the database."""
    part = home.backups / f"{name}.part"
    with raw_connection(engine) as source, closing(sqlite3.connect(part)) as target:
        target.execute("PRAGMA synchronous = FULL")
        source.backup(target)
    part.replace(home.backups / name)
    sync_path(home.backups)


def _revision(engine: Engine) -> str | None:
    """Return the revision of the schema; None for an empty database."""
    with engine.connect() as connection:
        if not inspect(connection).has_table("alembic_version"):
            return None
        return connection.execute(text("SELECT version_num FROM alembic_version")).scalar()
