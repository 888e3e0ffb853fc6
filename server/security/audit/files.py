"""Files of the audit log: its lines, and beside them the end of the chain."""

import json
import os
from pathlib import Path

from server.security.audit.chain import Fault, Head, Verdict
from server.security.audit.verification import LogVerifier, verify_content
from server.store.private_file import write_private

BLOCK_BYTES = 64 * 1024


def last_lines(file: Path, count: int) -> list[bytes]:
    """Return this many complete lines from the end, without line ends, or fewer.

    Raises:
        OSError: the file cannot be read.
    """
    with file.open("rb") as opened:
        start, block_bytes, read = opened.seek(0, os.SEEK_END), BLOCK_BYTES, b""
        while start > 0 and read.count(b"\n") <= count:
            begin = max(0, start - block_bytes)
            opened.seek(begin)
            read = opened.read(start - begin) + read
            start, block_bytes = begin, block_bytes * 2
    lines = read.split(b"\n")[:-1]
    return lines[-count:] if count else []


def verify_files(file: Path, head_file: Path | None) -> Verdict:
    """Verify a log: its chain, and its end where that is known.

    Raises:
        OSError: the file cannot be read.
    """
    # Read before the lines: a running server then adds lines, and never lacks them.
    known = None if head_file is None else read_head(head_file)
    content = file.read_bytes()
    verdict = verify_content(content, known, LogVerifier())
    if verdict.fault is None and head_file is not None and known is None:
        # A server's log has this file from its first start on: without it missing lines at the end are
        # undetectable.
        reason = f"where the log ended is not known: {head_file.name} beside it is missing or damaged"
        return Verdict(head=verdict.head, fault=Fault(line=max(verdict.head.count, 1), reason=reason))
    return verdict


def read_head(file: Path) -> Head | None:
    """Return the stored end of the chain; None without a usable file."""
    try:
        stored = json.loads(file.read_bytes())
        return Head(count=int(stored["count"]), sum=str(stored["sum"]))
    except (OSError, ValueError, KeyError, TypeError, OverflowError, RecursionError):
        return None


def read_head_of(home: Path) -> Head | None:
    """Return the stored end of the audit log of a home folder; None without one."""
    return read_head(home / "security" / "audit-head.json")


def write_head(file: Path, head: Head) -> None:
    """Store the end of the chain.

    Raises:
        OSError: it cannot be written.
    """
    write_private(file, json.dumps({"count": head.count, "sum": head.sum}).encode())
