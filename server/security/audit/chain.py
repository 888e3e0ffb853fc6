"""Hash chain: each line contains the SHA-256 of the line before, so any change or loss is detected."""

import hashlib
import json
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

# Hash in the first line, which has no line before it.
GENESIS_SUM = "0" * 64
# Code of the entry with which the server reported missing or changed lines at its start; it stays a fault.
BROKEN = "AUDIT_BROKEN"
LONE_SURROGATE = re.compile("[\ud800-\udfff]")


@dataclass(frozen=True, slots=True, kw_only=True)
class Head:
    """End of the chain.

    Attributes:
        count: number of lines.
        sum: SHA-256 of the last line, in hexadecimal; `GENESIS_SUM` without one.
    """

    count: int = 0
    sum: str = GENESIS_SUM


@dataclass(frozen=True, slots=True, kw_only=True)
class Fault:
    """A break of the chain.

    Attributes:
        line: line number, from 1.
        reason: the fault, in a sentence without its full stop.
    """

    line: int
    reason: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Verdict:
    """Result of a verification.

    Attributes:
        head: end of the lines that are there.
        fault: the first fault; None for a valid chain.
    """

    head: Head
    fault: Fault | None = None


def chained_line(head: Head, line: Mapping[str, object]) -> tuple[bytes, Head]:
    """Return the line with its number and the sum of the line before it, and the new end of the chain."""
    numbered = {"number": head.count + 1, "before": head.sum, **line}
    text = json.dumps(numbered, ensure_ascii=False, separators=(",", ":"))
    # A lone surrogate cannot be encoded: its escape can.
    raw = LONE_SURROGATE.sub(lambda half: f"\\\\u{ord(half[0]):04x}", text).encode()
    return raw, Head(count=head.count + 1, sum=sha256_of(raw))


def sha256_of(raw: bytes) -> str:
    """Return the SHA-256 of a line without its line end."""
    return hashlib.sha256(raw).hexdigest()


def verify(lines: Iterable[bytes], *, after: Verdict | None = None) -> Verdict:
    """Verify a chain of lines without line ends, from its beginning or after others."""
    head, fault = (Head(), None) if after is None else (after.head, after.fault)
    for raw in lines:
        number = head.count + 1
        fault = fault or _fault_of(raw, number, head)
        head = Head(count=number, sum=sha256_of(raw))
    return Verdict(head=head, fault=fault)


def _fault_of(raw: bytes, number: int, before: Head) -> Fault | None:
    try:
        line = json.loads(raw)
    except (ValueError, RecursionError):
        return Fault(line=number, reason="it is not a line of an audit log")
    if not isinstance(line, dict):
        return Fault(line=number, reason="it is not a line of an audit log")
    found = line.get("number")
    if found != number:
        later = isinstance(found, int) and found > number
        reason = f"line {number} is missing here" if later else "it is out of order"
        return Fault(line=number, reason=f"{reason}: the line here has the number {str(found)[:20]}")
    if line.get("before") != before.sum:
        # The sum is that of the line before, so that line was changed.
        return Fault(line=max(number - 1, 1), reason="it was changed after it was written")
    if line.get("code") == BROKEN:
        return Fault(
            line=number, reason="the server found lines changed or missing before it, when it started"
        )
    return None
