"""Files of the audit log: its lines, and beside them the end of the chain."""

import errno
import json
import os
import secrets
from pathlib import Path

from server.security.audit.chain import Fault, Head, Verdict
from server.security.audit.verification import LogVerifier, verify_content
from server.store.home import sync_file

OWNER_ONLY = 0o600
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
    except (OSError, ValueError, KeyError, TypeError):
        return None


def write_head(file: Path, head: Head) -> None:
    """Store the end of the chain.

    Raises:
        OSError: it cannot be written.
    """
    write_private(file, json.dumps({"count": head.count, "sum": head.sum}).encode())


def write_private(file: Path, content: bytes) -> None:
    """Write a file that only its owner can read, atomically, and on the disk on return.

    Raises:
        OSError: it cannot be written.
    """
    part = file.with_name(f".{file.name}.{secrets.token_hex(4)}")
    descriptor = os.open(part, os.O_WRONLY | os.O_CREAT | os.O_EXCL, OWNER_ONLY)
    try:
        try:
            write_all(descriptor, content)
            sync_file(descriptor)
        finally:
            os.close(descriptor)
        part.replace(file)
    except OSError:
        part.unlink(missing_ok=True)
        raise


def write_all(descriptor: int, content: bytes) -> None:
    """Write every byte: on a nearly full disk one call writes only a part.

    Raises:
        OSError: not all can be written; a part may be.
    """
    left = memoryview(content)
    while left:
        written = os.write(descriptor, left)
        if written <= 0:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        left = left[written:]
