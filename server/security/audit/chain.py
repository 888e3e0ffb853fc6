"""The chain: each line holds the SHA-256 of the one before: none is changed, lost or moved unseen."""

import hashlib
import json
import re
from collections.abc import Iterable, Mapping
from dataclasses import dataclass

# What the first line holds in place of a sum of a line before it.
BEGINNING = "0" * 64
# The server found at its start that lines were missing or changed; the line that says so is a fault for ever.
BROKEN = "AUDIT_BROKEN"
HALF_LETTER = re.compile("[\ud800-\udfff]")


@dataclass(frozen=True, slots=True, kw_only=True)
class Head:
    """Where the chain ends.

    Attributes:
        count: lines.
        sum: SHA-256 of the last one, in hexadecimal; `BEGINNING` where there is none.
    """

    count: int = 0
    sum: str = BEGINNING


@dataclass(frozen=True, slots=True, kw_only=True)
class Fault:
    """Where the chain does not hold.

    Attributes:
        line: its number, from 1.
        said: what is wrong with it, in a sentence without its full stop.
    """

    line: int
    said: str


@dataclass(frozen=True, slots=True, kw_only=True)
class Verdict:
    """What was found in the lines.

    Attributes:
        head: of the lines that are there.
        fault: the first one, None where the chain holds.
    """

    head: Head
    fault: Fault | None = None


def sealed(head: Head, line: Mapping[str, object]) -> tuple[bytes, Head]:
    """The line with its number and the sum of the line before it, and where the chain ends with it."""
    whole = {"number": head.count + 1, "before": head.sum, **line}
    text = json.dumps(whole, ensure_ascii=False, separators=(",", ":"))
    # Half a letter cannot be written, nor be sent when it is read: its number can.
    raw = HALF_LETTER.sub(lambda half: f"\\\\u{ord(half[0]):04x}", text).encode()
    return raw, Head(count=head.count + 1, sum=sum_of(raw))


def sum_of(raw: bytes) -> str:
    """SHA-256 of a line without its end."""
    return hashlib.sha256(raw).hexdigest()


def verify(lines: Iterable[bytes], *, after: Verdict | None = None) -> Verdict:
    """Whether these lines, without their ends, are a chain, from its beginning or after others."""
    head, fault = (Head(), None) if after is None else (after.head, after.fault)
    for raw in lines:
        number = head.count + 1
        fault = fault or _fault_of(raw, number, head)
        head = Head(count=number, sum=sum_of(raw))
    return Verdict(head=head, fault=fault)


def _fault_of(raw: bytes, number: int, before: Head) -> Fault | None:
    try:
        line = json.loads(raw)
    except (ValueError, RecursionError):
        return Fault(line=number, said="it is no line of an audit log any more")
    if not isinstance(line, dict):
        return Fault(line=number, said="it is no line of an audit log any more")
    found = line.get("number")
    if found != number:
        later = isinstance(found, int) and found > number
        said = f"line {number} is missing here" if later else "it stands where it does not belong"
        return Fault(line=number, said=f"{said}: the line that stands here has the number {str(found)[:20]}")
    if line.get("before") != before.sum:
        # The sum is of the line before: it is that one which is not as it was.
        return Fault(line=max(number - 1, 1), said="it is not as it was written")
    if line.get("code") == BROKEN:
        return Fault(line=number, said="the server found lines changed or missing before it, when it started")
    return None
