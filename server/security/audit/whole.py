"""The whole log as it lies on the disk: its lines, and beside them where the chain ended."""

import errno
import json
import os
import secrets
from pathlib import Path

from server.security.audit.chain import Fault, Head, Verdict
from server.security.audit.checked import Checked, verdict_on
from server.store.home import sync_file

OWNER_ALONE = 0o600
BLOCK_BYTES = 64 * 1024


def last_lines(file: Path, count: int) -> list[bytes]:
    """So many whole lines from the end, without their ends; fewer where fewer are there.

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
    """Whether the log is whole: its chain, and, where that is known, its end.

    Raises:
        OSError: the file cannot be read.
    """
    # Before the lines: what a running server adds meanwhile is then more, and never less.
    known = None if head_file is None else read_head(head_file)
    content = file.read_bytes()
    verdict = verdict_on(content, known, Checked())
    if verdict.fault is None and head_file is not None and known is None:
        # A log that a server keeps has one from its first start on: without it nobody knows what is missing.
        said = f"where the log ended is not known: {head_file.name} beside it is missing or damaged"
        return Verdict(head=verdict.head, fault=Fault(line=max(verdict.head.count, 1), said=said))
    return verdict


def read_head(file: Path) -> Head | None:
    """Where the chain ended, as it was kept beside it; None where nothing usable was."""
    try:
        kept = json.loads(file.read_bytes())
        return Head(count=int(kept["count"]), sum=str(kept["sum"]))
    except (OSError, ValueError, KeyError, TypeError):
        return None


def write_head(file: Path, head: Head) -> None:
    """Keep where the chain ends.

    Raises:
        OSError: it cannot be written.
    """
    write_private(file, json.dumps({"count": head.count, "sum": head.sum}).encode())


def write_private(file: Path, content: bytes) -> None:
    """Write a file that only its owner reads, whole or not at all, and on the disk when this returns.

    Raises:
        OSError: it cannot be written.
    """
    part = file.with_name(f".{file.name}.{secrets.token_hex(4)}")
    descriptor = os.open(part, os.O_WRONLY | os.O_CREAT | os.O_EXCL, OWNER_ALONE)
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
    """Write every byte: on a disk that is nearly full, one call writes a part, and says so only by a number.

    Raises:
        OSError: not all can be written; a part may be.
    """
    left = memoryview(content)
    while left:
        written = os.write(descriptor, left)
        if written <= 0:
            raise OSError(errno.ENOSPC, os.strerror(errno.ENOSPC))
        left = left[written:]
