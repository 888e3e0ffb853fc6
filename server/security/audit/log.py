"""The audit log of a home: what is said here is on the disk, or is told that it is not."""

import os
import secrets
import threading
from collections import deque
from collections.abc import Mapping
from contextlib import suppress
from pathlib import Path

import structlog

from server.clock import Clock, utc_now, utc_text
from server.security.audit.chain import BROKEN, Fault, Head, Verdict, sealed
from server.security.audit.checked import Checked, end_fault, verdict_on
from server.security.audit.entries import Entry
from server.security.audit.noted import note
from server.security.audit.whole import (
    OWNER_ALONE,
    last_lines,
    read_head,
    write_all,
    write_head,
    write_private,
)
from server.security.person import SERVER
from server.store import Change, told
from server.store.home import sync_file, sync_folder
from tracker.errors import NavigationError

AUDIT_FILE, HEAD_FILE, RESERVE_FILE = "audit.jsonl", "audit-head.json", "audit-reserve"
# Room for some hundred lines on a full disk: whoever makes room there is in the log, too.
RESERVE_BYTES = 128 * 1024
MAX_WAITING = 2000
REJECTED_A_MINUTE = 60
log = structlog.get_logger(__name__)


class AuditLog:
    """Lines that only grow. Safe to use from any thread; waits for the disk, so never in an event loop.

    Args:
        folder: where the log lies; made if need be.
        clock: the wall clock, in UTC.

    Raises:
        StoreError: the folder cannot be used.
    """

    def __init__(self, folder: Path, *, clock: Clock = utc_now) -> None:
        self.folder = folder
        self.file = folder / AUDIT_FILE
        self._head_file = folder / HEAD_FILE
        self._reserve = folder / RESERVE_FILE
        self._clock = clock
        self._turn = threading.Lock()
        self._waiting: deque[Mapping[str, object]] = deque()
        self._head = Head()
        self._is_well = True
        self._checked = Checked()
        self._rejected_in: tuple[str, int] = ("", 0)
        with told(folder):
            folder.mkdir(mode=0o700, parents=True, exist_ok=True)
            self._begin()

    @property
    def head(self) -> Head:
        """Where the chain ends now."""
        return self._head

    @property
    def is_well(self) -> bool:
        """Whether the last writing went well; waits for nothing, so that the event loop may ask."""
        return self._is_well

    def append(self, entry: Entry) -> None:
        """Write one line, and all that waited before it.

        Raises:
            StoreError: it cannot be written now; it is, before anything else, once that goes again.
        """
        line = {"at": self._now(), **entry.told()}
        with self._turn:
            if len(self._waiting) < MAX_WAITING:
                self._waiting.append(line)
            with told(self.folder):
                self._write_waiting()

    def rejected(self, entry: Entry) -> None:
        """Write that something was refused; no more than so many a minute, so that nobody fills the disk."""
        minute = self._now()[:16]
        with self._turn:
            in_minute = self._rejected_in[1] + 1 if self._rejected_in[0] == minute else 1
            self._rejected_in = (minute, in_minute)
        if in_minute > REJECTED_A_MINUTE:
            return
        if in_minute == REJECTED_A_MINUTE:
            entry = Entry(who=SERVER, what="more was refused in this minute than is written down")
        try:
            self.append(entry)
        except NavigationError as error:
            log.warning("a refusal could not be written into the audit log", code=error.code)

    def catch_up(self) -> None:
        """Write what waits.

        Raises:
            StoreError: it cannot be written.
        """
        with self._turn, told(self.folder):
            self._write_waiting()

    def changed(self, change: Change) -> None:
        """What the store changed: part of the line of its request, or a line of its own."""
        if change.kind == "alarm":
            # They have a log of their own, which says more.
            return
        if not note(change.told()):
            try:
                self.append(Entry(who=SERVER, what="store", changes=(change.told(),)))
            except NavigationError as error:
                log.warning("a change could not be written into the audit log", code=error.code)

    def newest(self, count: int, *, before: int | None = None) -> list[bytes]:
        """The last lines, or the last ones before a number; the oldest first, as they lie on the disk.

        Raises:
            StoreError: the log cannot be read.
        """
        back = count if before is None else max(0, self._head.count - before + 1) + count
        with told(self.folder):
            lines = last_lines(self.file, back)
        lines = lines if before is None else lines[: max(0, len(lines) - back + count)]
        return lines[-count:]

    def whole(self) -> bytes:
        """Every whole line, as they lie on the disk.

        Raises:
            StoreError: the log cannot be read.
        """
        with told(self.folder):
            content = self.file.read_bytes()
        return content[: content.rfind(b"\n") + 1]

    def verify(self) -> Verdict:
        """Read the whole log, and tell the first fault. Nobody who writes waits for it.

        Raises:
            StoreError: the log cannot be read.
        """
        with told(self.folder):
            # The end before the lines: what is added meanwhile is then more, and never less.
            known, content = self._head, self.file.read_bytes()
            if content and not content.endswith(b"\n"):
                # Perhaps it is just being written.
                with self._turn:
                    known, content = self._head, self.file.read_bytes()
            return verdict_on(content, known, self._checked)

    def _now(self) -> str:
        return utc_text(self._clock())

    def _begin(self) -> None:
        """Heal what a crash cut, tell what somebody changed, and know where to go on."""
        if not self.file.exists():
            os.close(os.open(self.file, os.O_WRONLY | os.O_CREAT, OWNER_ALONE))
            sync_folder(self.folder)
        content = self.file.read_bytes()
        *lines, rest = content.split(b"\n")
        known, verdict = read_head(self._head_file), self._checked.verify(content)
        fault = verdict.fault or (end_fault(content, verdict.head, known) if known is not None else None)
        if known is None and lines:
            fault = fault or Fault(line=len(lines), said="where the log ended was not kept beside it")
        if rest:
            with self.file.open("r+b") as opened:
                opened.truncate(self.file.stat().st_size - len(rest))
                sync_file(opened.fileno())
        self._head = verdict.head
        self._keep_reserve()
        if fault is not None and not _is_told(lines, fault):
            log.error("the audit log is not whole", line=fault.line, said=fault.said)
            change = {"what": "audit log", "line": fault.line, "said": fault.said}
            self._waiting.append(
                {"at": self._now(), **Entry(who=SERVER, what="start", code=BROKEN, changes=(change,)).told()}
            )
        if rest:
            log.warning("a line of the audit log was cut by a crash", bytes=len(rest))
            change = {"what": "audit log", "said": "the last line was cut by a crash", "bytes": len(rest)}
            self._waiting.append(
                {"at": self._now(), **Entry(who=SERVER, what="start", changes=(change,)).told()}
            )
        with suppress(OSError):
            self._write_waiting()

    def _write_waiting(self) -> None:
        try:
            self._write_all_waiting()
        except OSError:
            self._is_well = False
            raise
        self._is_well = True

    def _write_all_waiting(self) -> None:
        while self._waiting:
            raw, head = sealed(self._head, self._waiting[0])
            try:
                self._write(raw + b"\n")
            except OSError:
                if not self._reserve.exists():
                    raise
                self._reserve.unlink(missing_ok=True)
                self._write(raw + b"\n")
            self._head = head
            self._waiting.popleft()
            write_head(self._head_file, head)
        if not self._reserve.exists():
            self._keep_reserve()

    def _write(self, raw: bytes) -> None:
        """Add one line, whole or nothing of it."""
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
                # Noise, because some disks need no room for zeros.
                write_private(self._reserve, secrets.token_bytes(RESERVE_BYTES))


def _is_told(lines: list[bytes], fault: Fault) -> bool:
    """Whether an earlier start has said it already, at the line that is the fault now."""
    return fault.line <= len(lines) and f'"code":"{BROKEN}"'.encode() in lines[fault.line - 1]
