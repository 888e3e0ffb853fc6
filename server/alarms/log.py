"""The alarm log: only ever added to, and on the disk within a moment, whatever becomes of the server.

It belongs to the case that is open, as documents of it; without one, to the folder of all cases. A thread
writes, so that a slow disk delays no picture; whoever must be sure waits for it.

So it is copied and deleted with its case, and what a person acknowledged is on the disk before the answer.
"""

import json
import os
import shutil
import threading
from collections import deque
from collections.abc import Sequence
from contextlib import suppress
from math import isfinite
from pathlib import Path
from typing import Protocol

import structlog

from server.alarms.entries import Entry, Line
from server.store import CaseStore, DocumentKind, StoreError, says_archive, told
from tracker.errors import InvalidInput, NavigationError

NAME = "log"
FILE_NAME = "alarms.jsonl"
NOBODY = "Coaxial"
MAX_WAITING = 10_000
MAX_A_DOCUMENT = 200
TRY_AGAIN_S = 2.0
FLUSH_TIMEOUT_S = 5.0

log = structlog.get_logger(__name__)


class AlarmLog(Protocol):
    """Where alarms are kept."""

    @property
    def is_well(self) -> bool:
        """Whether everything is written so far, or just being written."""
        ...

    @property
    def free_mb(self) -> float | None:
        """Room on its disk; None where that is not known."""
        ...

    def append(self, entries: Sequence[Entry]) -> None:
        """Keep these; returns at once."""
        ...

    def flush(self) -> None:
        """Return when everything that was appended before is on the disk.

        Raises:
            StoreError: it cannot be written.
        """
        ...

    def newest(self, count: int) -> list[Line]:
        """The last of them, the oldest first."""
        ...


class NoLog:
    """Where nothing is kept: a server without a folder."""

    is_well = True
    free_mb: float | None = None

    def append(self, entries: Sequence[Entry]) -> None:
        """Forget them."""

    def flush(self) -> None:
        """Nothing waits."""

    def newest(self, count: int) -> list[Line]:
        """None are kept."""
        del count
        return []


class StoredAlarmLog:
    """The log of a server with cases. Safe to use from any thread."""

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
        self._thread = threading.Thread(target=self._run, name="alarm log", daemon=True)
        self._thread.start()

    @property
    def is_well(self) -> bool:
        """Whether the last writing went well."""
        return self._problem is None

    @property
    def free_mb(self) -> float | None:
        """Room on the disk, looked at every few seconds."""
        return self._free_mb

    def append(self, entries: Sequence[Entry]) -> None:
        """Keep these; returns at once."""
        if not entries:
            return
        with self._changed:
            if len(self._waiting) >= MAX_WAITING:
                # The disk has been away for hours; what was first is the more telling.
                return
            self._waiting.extend(entries)
            self._appended += len(entries)
            self._changed.notify_all()

    def flush(self) -> None:
        """Return when everything that was appended before is on the disk.

        Raises:
            StoreError: it cannot be written; it is tried again by itself.
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
            f"it could not be written into the alarm log within {FLUSH_TIMEOUT_S:g} s",
            "It was done, and is tried to be written on; look at the disk.",
        )

    def newest(self, count: int) -> list[Line]:
        """The last of the open case, or, where none is open, of the folder; the oldest first."""
        case = self._store.opened()
        if case is None:
            return lines_of(self._folder / FILE_NAME)[-count:]
        documents = self._store.history(case.id, DocumentKind.ALARM, NAME)
        lines: list[Line] = []
        for document in documents:
            kept = document.content.get("lines")
            told_lines = [line for line in kept if isinstance(line, dict)] if isinstance(kept, list) else []
            lines += told_lines if document.imported is None else [_doubted(line) for line in told_lines]
        return lines[-count:]

    def stop(self) -> None:
        """Write what waits, and no more."""
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
            problem = None
        except NavigationError as error:
            problem = error
        except Exception as error:
            # This thread must not end: alarms would then be lost without a word.
            problem = StoreError("ALARM_NOT_LOGGED", f"the alarm log failed: {error}", "Look at the log.")
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
        case = self._store.opened()
        lines = [sound_line(entry.line) for entry in batch]
        if case is None:
            with told(self._folder):
                append_lines(self._folder / FILE_NAME, lines)
            return
        names = {entry.by for entry in batch if entry.by}
        made_by = names.pop() if len(names) == 1 else NOBODY
        try:
            self._store.put(case.id, DocumentKind.ALARM, NAME, {"lines": lines}, made_by=made_by)
        except InvalidInput as rejected:
            if rejected.code != "NAME_INVALID" or made_by == NOBODY:
                raise
            # Who it was is told in the line: for a name that the store does not take, no alarm is lost.
            self._store.put(case.id, DocumentKind.ALARM, NAME, {"lines": lines}, made_by=NOBODY)


def _doubted(line: Line) -> Line:
    """A line that came in with an archive: nobody signed in here to do what it says."""
    return {**line, "by": says_archive(str(line["by"]))} if line.get("by") else line


def sound_line(line: Line) -> Line:
    """The line without what JSON has no word for."""
    return {
        key: None if isinstance(value, float) and not isfinite(value) else value
        for key, value in line.items()
    }


def append_lines(file: Path, lines: Sequence[Line]) -> None:
    """Add lines to the end of a file, one JSON a line, and have them on the disk."""
    text = "".join(json.dumps(line, ensure_ascii=False) + "\n" for line in lines)
    with file.open("ab+") as written:
        written.seek(0, os.SEEK_END)
        if written.tell() > 0:
            written.seek(-1, os.SEEK_END)
            if written.read(1) != b"\n":
                # The last one was cut by a power cut: it stays cut, and does not spoil this one.
                text = "\n" + text
        written.write(text.encode("utf-8"))
        written.flush()
        os.fsync(written.fileno())


def lines_of(file: Path) -> list[Line]:
    """The lines of such a file; one that was cut is left out."""
    try:
        content = file.read_bytes()
    except FileNotFoundError:
        return []
    lines: list[Line] = []
    for row in content.split(b"\n"):
        with suppress(ValueError):
            line = json.loads(row)
            if isinstance(line, dict):
                lines.append(line)
    return lines
