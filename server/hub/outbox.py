"""The outbox: entries on the theatre's disk until JetStream has stored them, and for some days after.

The web process appends, the publisher's process reads. What JetStream has stored is known from the last
message of each subject in the stream, not from here: a server that lost what it had acknowledged therefore
gets it again, as long as it is in the outbox.
"""

import secrets
import sqlite3
import threading
import time
from collections.abc import Sequence
from contextlib import closing
from dataclasses import dataclass
from pathlib import Path

from server.hub.subjects import Leaf

OUTBOX_FILE = "hub-outbox.sqlite"
# Less than the stream's retention, so that what is sent again is not what the stream has let go.
KEPT_S = 7 * 24 * 3600.0
BUSY_TIMEOUT_S = 5.0
SCHEMA = """
CREATE TABLE IF NOT EXISTS outbox (id TEXT NOT NULL);
CREATE TABLE IF NOT EXISTS entry (
    number INTEGER PRIMARY KEY AUTOINCREMENT,
    leaf TEXT NOT NULL,
    content TEXT NOT NULL,
    acknowledged_at REAL
);
CREATE INDEX IF NOT EXISTS entry_by_leaf ON entry (leaf, number);
"""


@dataclass(frozen=True, slots=True, kw_only=True)
class OutboxEntry:
    """One entry. Numbers increase over all subjects and restarts."""

    number: int
    leaf: Leaf
    content: str


class Outbox:
    """The outbox of a home folder. Thread-safe; waits for the disk.

    Raises:
        sqlite3.Error: the file cannot be used; so do all methods.
    """

    def __init__(self, folder: Path) -> None:
        self.file = folder / OUTBOX_FILE
        self._lock = threading.Lock()
        self._database = sqlite3.connect(self.file, timeout=BUSY_TIMEOUT_S, check_same_thread=False)
        self.file.chmod(0o600)
        self._database.execute("PRAGMA journal_mode=WAL")
        # What was appended is on the disk, also after a power failure.
        self._database.execute("PRAGMA synchronous=FULL")
        with self._lock, self._database:
            self._database.executescript(SCHEMA)
            self._database.execute("BEGIN IMMEDIATE")
            if self._database.execute("SELECT id FROM outbox").fetchone() is None:
                self._database.execute("INSERT INTO outbox VALUES (?)", (secrets.token_hex(8),))
        self.id: str = self._database.execute("SELECT id FROM outbox").fetchone()[0]
        """Differs from that of every other outbox, also of one that replaced it."""

    def close(self) -> None:
        """Close the file."""
        with self._lock:
            self._database.close()

    def append(self, leaf: Leaf, contents: Sequence[str]) -> None:
        """Append entries; they are on the disk on return. Old acknowledged ones are deleted."""
        with self._lock, self._database:
            self._database.executemany(
                "INSERT INTO entry (leaf, content) VALUES (?, ?)", [(leaf.value, one) for one in contents]
            )
            self._database.execute("DELETE FROM entry WHERE acknowledged_at < ?", (time.time() - KEPT_S,))

    def after(self, leaf: Leaf, number: int, *, count: int) -> list[OutboxEntry]:
        """Return the next entries of a subject after a number, oldest first."""
        with self._lock, closing(self._database.cursor()) as cursor:
            rows = cursor.execute(
                "SELECT number, content FROM entry WHERE leaf = ? AND number > ? ORDER BY number LIMIT ?",
                (leaf.value, number, count),
            ).fetchall()
        return [OutboxEntry(number=row[0], leaf=leaf, content=row[1]) for row in rows]

    def acknowledge(self, leaf: Leaf, number: int) -> None:
        """Record that JetStream has stored the entries of a subject up to a number."""
        with self._lock, self._database:
            self._database.execute(
                "UPDATE entry SET acknowledged_at = ? "
                "WHERE leaf = ? AND number <= ? AND acknowledged_at IS NULL",
                (time.time(), leaf.value, number),
            )

    @property
    def waiting(self) -> int:
        """Number of entries that JetStream has not stored yet."""
        with self._lock, closing(self._database.cursor()) as cursor:
            count: int = cursor.execute(
                "SELECT count(*) FROM entry WHERE acknowledged_at IS NULL"
            ).fetchone()[0]
        return count
