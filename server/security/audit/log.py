"""The audit log of a home: an entry is on the disk on return, or an error is raised."""

import os
import secrets
import threading
from collections import deque
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path

import structlog

from server.clock import Clock, utc_now, utc_text
from server.disk import sync_file, sync_path
from server.security.audit.chain import BROKEN, Fault, Head, Verdict, chained_line
from server.security.audit.changes import note
from server.security.audit.entries import Entry
from server.security.audit.files import last_lines, read_head, write_head
from server.security.audit.verification import LogVerifier, end_fault, verify_content
from server.security.person import SERVER
from server.store import Change, translate_errors
from server.store.private_file import OWNER_ONLY, write_all, write_private
from tracker.errors import NavigationError

AUDIT_FILE, HEAD_FILE, RESERVE_FILE = "audit.jsonl", "audit-head.json", "audit-reserve"
# Space for some hundred entries on a full disk: freeing space is logged, too.
RESERVE_BYTES = 128 * 1024
MAX_PENDING = 2000
MAX_REJECTIONS_PER_MINUTE = 60
log = structlog.get_logger(__name__)


class AuditLog:
    """Append-only log. Thread-safe; waits for the disk, so it must not be called in an event loop.

    Args:
        folder: folder of the log; created if missing.
        clock: wall clock, in UTC.

    Raises:
        StoreError: the folder cannot be used.
    """

    def __init__(self, folder: Path, *, clock: Clock = utc_now) -> None:
        self.folder = folder
        self.file = folder / AUDIT_FILE
        self._head_file = folder / HEAD_FILE
        self._reserve = folder / RESERVE_FILE
        self._clock = clock
        self._lock = threading.Lock()
        self._pending: deque[Mapping[str, object]] = deque()
        self._head = Head()
        self._is_writable = True
        self._verifier = LogVerifier()
        self._rejections_in_minute: tuple[str, int] = ("", 0)
        with translate_errors(folder):
            folder.mkdir(mode=0o700, parents=True, exist_ok=True)
            self._begin()

    @property
    def head(self) -> Head:
        """End of the chain."""
        return self._head

    @property
    def is_writable(self) -> bool:
        """Whether the last write succeeded; does not block."""
        return self._is_writable

    def append(self, entry: Entry) -> None:
        """Write one entry, after all pending ones.

        Raises:
            StoreError: It cannot be written now; it is written before any other entry once that is possible.
        """
        line = {"at": self._now(), **entry.to_json()}
        with self._lock:
            if len(self._pending) < MAX_PENDING:
                self._pending.append(line)
            with translate_errors(self.folder):
                self._write_pending()

    def append_rejection(self, entry: Entry) -> None:
        """Write a rejection; limited per minute, so that nobody fills the disk."""
        minute = self._now()[:16]
        with self._lock:
            in_minute = self._rejections_in_minute[1] + 1 if self._rejections_in_minute[0] == minute else 1
            self._rejections_in_minute = (minute, in_minute)
        if in_minute > MAX_REJECTIONS_PER_MINUTE:
            return
        if in_minute == MAX_REJECTIONS_PER_MINUTE:
            entry = Entry(who=SERVER, what="more requests were rejected in this minute than are logged")
        try:
            self.append(entry)
        except NavigationError as error:
            log.warning("a rejection could not be written to the audit log", code=error.code)

    def catch_up(self) -> None:
        """Write all pending entries.

        Raises:
            StoreError: it cannot be written.
        """
        with self._lock, translate_errors(self.folder):
            self._write_pending()

    def record_change(self, change: Change) -> None:
        """Record a change of the store: in the entry of its request, or in one of its own."""
        if change.kind == "alarm":
            # Alarms have a log of their own, with more detail.
            return
        if not note(change.to_json()):
            try:
                self.append(Entry(who=SERVER, what="store", changes=(change.to_json(),)))
            except NavigationError as error:
                log.warning("a change could not be written to the audit log", code=error.code)

    def newest(self, count: int, *, before: int | None = None) -> list[bytes]:
        """Return the last lines, or the last ones before a number; oldest first, as stored.

        Raises:
            StoreError: the log cannot be read.
        """
        back = count if before is None else max(0, self._head.count - before + 1) + count
        with translate_errors(self.folder):
            lines = last_lines(self.file, back)
        lines = lines if before is None else lines[: max(0, len(lines) - back + count)]
        return lines[-count:]

    def complete_lines(self) -> bytes:
        """Return every complete line, as stored.

        Raises:
            StoreError: the log cannot be read.
        """
        with translate_errors(self.folder):
            content = self.file.read_bytes()
        return content[: content.rfind(b"\n") + 1]

    def verify(self) -> Verdict:
        """Verify the whole log, and return the first fault. Writers do not wait for it.

        Raises:
            StoreError: the log cannot be read.
        """
        with translate_errors(self.folder):
            # The end is read before the lines: a concurrent write then adds lines, and never lacks them.
            known, content = self._head, self.file.read_bytes()
            if content and not content.endswith(b"\n"):
                # A write may be in progress.
                with self._lock:
                    known, content = self._head, self.file.read_bytes()
            return verify_content(content, known, self._verifier)

    def _now(self) -> str:
        return utc_text(self._clock())

    def _begin(self) -> None:
        """Remove a partial last line, report changes by others, and find the end of the chain."""
        if not self.file.exists():
            os.close(os.open(self.file, os.O_WRONLY | os.O_CREAT, OWNER_ONLY))
            sync_path(self.folder)
        content = self.file.read_bytes()
        *lines, rest = content.split(b"\n")
        known, verdict = read_head(self._head_file), self._verifier.verify(content)
        fault = verdict.fault or (end_fault(content, verdict.head, known) if known is not None else None)
        if known is None and lines:
            fault = fault or Fault(line=len(lines), reason="the end of the log was not stored beside it")
        if rest:
            with self.file.open("r+b") as opened:
                opened.truncate(self.file.stat().st_size - len(rest))
                sync_file(opened.fileno())
        self._head = verdict.head
        self._keep_reserve()
        if fault is not None and not _is_reported(lines, fault):
            log.error("the audit log is damaged", line=fault.line, said=fault.reason)
            change = {"what": "audit log", "line": fault.line, "said": fault.reason}
            self._pending.append(
                {
                    "at": self._now(),
                    **Entry(who=SERVER, what="start", code=BROKEN, changes=(change,)).to_json(),
                }
            )
        if rest:
            log.warning("a line of the audit log was truncated by a crash", bytes=len(rest))
            change = {
                "what": "audit log",
                "said": "the last line was truncated by a crash",
                "bytes": len(rest),
            }
            self._pending.append(
                {"at": self._now(), **Entry(who=SERVER, what="start", changes=(change,)).to_json()}
            )
        with suppress(OSError):
            self._write_pending()

    def _write_pending(self) -> None:
        try:
            self._write_all_pending()
        except OSError:
            self._is_writable = False
            raise
        self._is_writable = True

    def _write_all_pending(self) -> None:
        while self._pending:
            raw, head = chained_line(self._head, self._pending[0])
            try:
                self._write(raw + b"\n")
            except OSError:
                if not self._reserve.exists():
                    raise
                self._reserve.unlink(missing_ok=True)
                self._write(raw + b"\n")
            self._head = head
            self._pending.popleft()
            write_head(self._head_file, head)
        if not self._reserve.exists():
            self._keep_reserve()

    def _write(self, raw: bytes) -> None:
        """Append one complete line, or nothing."""
        descriptor = os.open(self.file, os.O_WRONLY | os.O_APPEND)
        try:
            size_bytes = os.fstat(descriptor).st_size
            try:
                write_all(descriptor, raw)
                sync_file(descriptor)
            except OSError:
                with suppress(OSError):
                    os.ftruncate(descriptor, size_bytes)
                raise
        finally:
            os.close(descriptor)

    def _keep_reserve(self) -> None:
        with suppress(OSError):
            if not self._reserve.exists():
                # Random bytes, because some file systems compress zeros.
                write_private(self._reserve, secrets.token_bytes(RESERVE_BYTES))


def _is_reported(lines: list[bytes], fault: Fault) -> bool:
    """Return whether an earlier start has reported this fault already, in the line of the fault."""
    return fault.line <= len(lines) and f'"code":"{BROKEN}"'.encode() in lines[fault.line - 1]
