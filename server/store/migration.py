"""Migration of the database to the current schema, by Alembic; an older database is backed up before."""

import sqlite3
from collections.abc import Callable
from contextlib import closing
from datetime import datetime
from pathlib import Path

from alembic import command
from alembic.config import Config
from alembic.runtime.migration import MigrationContext
from alembic.script import ScriptDirectory
from alembic.util.exc import CommandError
from sqlalchemy import Engine

from server.store.database import raw_connection, with_immediate_transactions
from server.store.errors import StoreError
from server.store.home import Home, sync_folder


def migrate(engine: Engine, home: Home, *, now: Callable[[], datetime], migrations: Path) -> None:
    """Migrate the database to the newest schema in this folder.

    Raises:
        StoreError: STORE_NEWER.
    """
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
            "Start the newer program, or set COAXIAL_HOME to another folder.",
            {"found": revision, "known": scripts.get_current_head()},
        ) from error


def _back_up(engine: Engine, home: Home, *, name: str) -> None:
    """Make a durable backup of the database before the migration."""
    part = home.backups / f"{name}.part"
    with raw_connection(engine) as source, closing(sqlite3.connect(part)) as target:
        target.execute("PRAGMA synchronous = FULL")
        source.backup(target)
    part.replace(home.backups / name)
    sync_folder(home.backups)
