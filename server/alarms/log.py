"""The append-only alarm log.

Entries are stored as documents of the open case, so that they are exported and deleted with it; without an
open case they go to a file in the home folder. A thread writes, so that a slow disk does not delay images;
`flush` waits until an acknowledgement is on the disk.
"""

import json
import os
import shutil
import threading
from collections import deque
from collections.abc import Callable, Sequence
from contextlib import suppress
from pathlib import Path
from typing import Protocol

import structlog

from server.alarms.entries import Entry, Line
from server.number_format import finite
from server.store import CaseStore, DocumentKind, StoreError, says_archive, translate_errors
from tracker.errors import InvalidInput, NavigationError

NAME = "log"
FILE_NAME = "alarms.jsonl"
NOBODY = "Coaxial"
MAX_PENDING = 10_000
MAX_A_DOCUMENT = 200
TRY_AGAIN_S = 2.0
FLUSH_TIMEOUT_S = 5.0

log = structlog.get_logger(__name__)


class AlarmLog(Protocol):
    """Interface of an alarm log."""

    @property
    def is_well(self) -> bool:
        """Whether writing works."""
        ...

    @property
    def free_mb(self) -> float | None:
        """Free disk space; None if unknown."""
        ...

    def append(self, entries: Sequence[Entry]) -> None:
        """Append entries; does not wait for the disk."""
        ...

    def flush(self) -> None:
        """Wait until all appended entries are on the disk.

        Raises:
            StoreError: The log cannot be written.
        """
        ...

    def newest(self, count: int) -> list[Line]:
        """Return the last lines, oldest first."""
        ...


class NoLog:
    """Alarm log of a server without a home folder; discards all entries."""

    is_well = True
    free_mb: float | None = None

    def append(self, entries: Sequence[Entry]) -> None:
        """Discard the entries."""

    def flush(self) -> None:
        """Return at once."""

    def newest(self, count: int) -> list[Line]:
        """Return no lines."""
        del count
        return []


class StoredAlarmLog:
    """Alarm log in the case store. Thread-safe."""

    def __init__(self, store: CaseStore) -> None:
        self._store = store
        self._folder = store.home.folder
        self._waiting: deque[Entry] = deque()
        self._changed = threading.Condition()
        self._appended = 0
        self._written = 0
        self._problem: NavigationError | None = None
        self._stopped = False
        self._free_mb: float | None = None
        self.on_stored: Callable[[Sequence[Line]], None] = lambda _lines: None
        """Called from the log's thread with lines that were stored, before `flush` returns for them."""
        self._thread = threading.Thread(target=self._run, name="alarm log", daemon=True)
        self._thread.start()

    @property
    def is_well(self) -> bool:
        """Whether the last write succeeded."""
        return self._problem is None

    @property
    def free_mb(self) -> float | None:
        """Free disk space, updated every few seconds."""
        return self._free_mb

    def append(self, entries: Sequence[Entry]) -> None:
        """Append entries; does not wait for the disk."""
        if not entries:
            return
        with self._changed:
            if len(self._waiting) >= MAX_PENDING:
                # The disk has failed for hours; the first entries are the more informative ones.
                return
            self._waiting.extend(entries)
            self._appended += len(entries)
            self._changed.notify_all()

    def flush(self) -> None:
        """Wait until all appended entries are on the disk.

        Raises:
            StoreError: The log cannot be written; writing is retried.
        """
        with self._changed:
            wanted = self._appended
            self._changed.wait_for(
                lambda: self._written >= wanted or self._problem is not None, timeout=FLUSH_TIMEOUT_S
            )
            if self._written >= wanted:
                return
            problem = self._problem
        if problem is not None:
            raise problem
        raise StoreError(
            "ALARM_NOT_LOGGED",
            f"the action could not be written to the alarm log within {FLUSH_TIMEOUT_S:g} s",
            "The action took effect and writing is retried; check the disk.",
            {"timeout_s": FLUSH_TIMEOUT_S},
        )

    def newest(self, count: int) -> list[Line]:
        """Return the last lines of the open case, or of the home folder without one, oldest first."""
        case = self._store.get_open_case()
        if case is None:
            return lines_of(self._folder / FILE_NAME)[-count:]
        documents = self._store.history(case.id, DocumentKind.ALARM, NAME)
        lines: list[Line] = []
        for document in documents:
            stored = document.content.get("lines")
            valid_lines = (
                [line for line in stored if isinstance(line, dict)] if isinstance(stored, list) else []
            )
            lines += valid_lines if document.imported is None else [_doubted(line) for line in valid_lines]
        return lines[-count:]

    def stop(self) -> None:
        """Write the pending entries and stop the thread."""
        with self._changed:
            self._stopped = True
            self._changed.notify_all()
        self._thread.join(FLUSH_TIMEOUT_S)

    def _run(self) -> None:
        while True:
            with self._changed:
                self._changed.wait_for(self._has_work, timeout=TRY_AGAIN_S)
                batch = list(self._waiting)[:MAX_A_DOCUMENT]
            with suppress(OSError):
                self._free_mb = shutil.disk_usage(self._folder).free / 1e6
            if batch:
                self._write(batch)
            if self._stopped and (not batch or self._problem is not None):
                return

    def _has_work(self) -> bool:
        return self._stopped or (bool(self._waiting) and self._problem is None)

    def _write(self, batch: list[Entry]) -> None:
        try:
            self._keep(batch)
            self.on_stored([finite_line(entry.line) for entry in batch])
            problem = None
        except NavigationError as error:
            problem = error
        except Exception as error:
            # This thread must not end, because later alarms would be lost silently.
            problem = StoreError(
                "ALARM_NOT_LOGGED",
                f"the alarm log failed: {error}",
                "See the server log.",
                {"cause": str(error)},
            )
            log.exception("the alarm log cannot be written")
        if problem is not None and self._problem is None:
            log.error(problem.message, code=problem.code, remedy=problem.remedy)
        with self._changed:
            self._problem = problem
            if problem is None:
                for _ in batch:
                    self._waiting.popleft()
                self._written += len(batch)
            self._changed.notify_all()

    def _keep(self, batch: list[Entry]) -> None:
        case = self._store.get_open_case()
        lines = [finite_line(entry.line) for entry in batch]
        if case is None:
            with translate_errors(self._folder):
                append_lines(self._folder / FILE_NAME, lines)
            return
        names = {entry.by for entry in batch if entry.by}
        made_by = names.pop() if len(names) == 1 else NOBODY
        try:
            self._store.put(case.id, DocumentKind.ALARM, NAME, {"lines": lines}, made_by=made_by)
        except InvalidInput as rejected:
            if rejected.code != "NAME_INVALID" or made_by == NOBODY:
                raise
            # The name is part of the line, so that an alarm is stored even if the store rejects the name.
            self._store.put(case.id, DocumentKind.ALARM, NAME, {"lines": lines}, made_by=NOBODY)


def _doubted(line: Line) -> Line:
    """Mark the person in an imported line as claimed by the archive."""
    return {**line, "by": says_archive(str(line["by"]))} if line.get("by") else line


def finite_line(line: Line) -> Line:
    """Return the line with null for values that JSON cannot represent."""
    return {key: finite(value) if isinstance(value, float) else value for key, value in line.items()}


def append_lines(file: Path, lines: Sequence[Line]) -> None:
    """Append JSON lines to a file and sync it to the disk."""
    text = "".join(json.dumps(line, ensure_ascii=False) + "\n" for line in lines)
    with file.open("ab+") as written:
        written.seek(0, os.SEEK_END)
        if written.tell() > 0:
            written.seek(-1, os.SEEK_END)
            if written.read(1) != b"\n":
                # A power failure truncated the last line; keep it apart from this one.
                text = "\n" + text
        written.write(text.encode("utf-8"))
        written.flush()
        os.fsync(written.fileno())


def lines_of(file: Path) -> list[Line]:
    """Return the lines of such a file, without truncated ones."""
    try:
        content = file.read_bytes()
    except FileNotFoundError:
        return []
    lines: list[Line] = []
    for row in content.split(b"\n"):
        with suppress(ValueError, RecursionError):
            line = json.loads(row)
            if isinstance(line, dict):
                lines.append(line)
    return lines
