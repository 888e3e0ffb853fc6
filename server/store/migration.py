"""Migration of the database to the current schema, by Alembic; an older database is backed up before."""

from collections.abc import Callable
from datetime import datetime
from pathlib import Path

from alembic import command
from alembic.config import Config
from alembic.runtime.migration import MigrationContext
from alembic.script import ScriptDirectory
from alembic.util.exc import CommandError
from sqlalchemy import Engine

from server.store.database import back_up, with_immediate_transactions
from server.store.errors import StoreError
from server.store.home import Home


def migrate(engine: Engine, home: Home, *, now: Callable[[], datetime], migrations: Path) -> None:
    """Migrate the database to the newest schema in this folder.

    Raises:
        StoreError: STORE_SCHEMA_UNKNOWN, the database is newer than this program or older than its first
            schema.
        DiskFull: STORE_FULL, before anything is changed.
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
        _reject_unknown(ScriptDirectory.from_config(config), revision, home)
        # For the backup, and for the journal, which can get every page of the database.
        home.reject_without_space(2 * home.database.stat().st_size)
        back_up(engine, home, name=f"coaxial-{revision}-{now():%Y%m%dT%H%M%SZ}.sqlite3")
    with with_immediate_transactions(engine).begin() as connection:
        config.attributes["connection"] = connection
        command.upgrade(config, "head")


def _reject_unknown(scripts: ScriptDirectory, revision: str, home: Home) -> None:
    try:
        scripts.get_revision(revision)
    except CommandError as error:
        raise StoreError(
            "STORE_SCHEMA_UNKNOWN",
            f"the database in {home.folder} has schema {revision}, this program supports schemas "
            f"{scripts.get_base()} to {scripts.get_current_head()}",
            "Start the version of Coaxial that made it, or set COAXIAL_HOME to another folder.",
            {
                "folder": str(home.folder),
                "found": revision,
                "first": scripts.get_base(),
                "newest": scripts.get_current_head(),
            },
        ) from error
