"""The whole log as it lies on the disk: its lines, and beside them where the chain ended."""

import errno
import json
import os
import secrets
from pathlib import Path

from server.security.audit.chain import Fault, Head, Verdict, verify
from server.store.home import sync_file

OWNER_ALONE = 0o600


def lines_of(file: Path) -> tuple[list[bytes], bytes]:
    """The whole lines without their ends, and what follows the last end: a line that a crash has cut.

    Raises:
        OSError: the file cannot be read.
    """
    *lines, rest = file.read_bytes().split(b"\n")
    return lines, rest


def verify_files(file: Path, head_file: Path | None) -> Verdict:
    """Whether the log is whole: its chain, and, where that is known, its end.

    Raises:
        OSError: the file cannot be read.
    """
    # Before the lines: what a running server adds meanwhile is then more, and never less.
    known = None if head_file is None else read_head(head_file)
    lines, rest = lines_of(file)
    verdict = verify(lines)
    if verdict.fault is not None:
        return verdict
    if rest:
        said = "it has no end: a crash has cut it, or somebody"
        return Verdict(head=verdict.head, fault=Fault(line=len(lines) + 1, said=said))
    return Verdict(head=verdict.head, fault=None if known is None else end_fault(lines, known))


def end_fault(lines: list[bytes], known: Head) -> Fault | None:
    """Whether lines that hold together end where they are known to have ended."""
    if known.count > len(lines):
        said = f"the end is missing: {known.count} lines were written, {len(lines)} are there"
        return Fault(line=len(lines) + 1, said=said)
    if verify(lines[: known.count]).head != known:
        return Fault(line=max(known.count, 1), said="it is not as it was written")
    return None


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
