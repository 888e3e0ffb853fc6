"""The log is verified while it grows: what was verified once is told by one sum of it, and not read anew.

Nobody who writes or asks waits for a reader, and a log of years costs a moment. Refusals are written at
most sixty times a minute; the log itself is never truncated.
"""

import hashlib
import threading

from server.security.audit.chain import Fault, Head, Verdict, sum_of, verify


class Checked:
    """What was found in a log so far. Safe to use from any thread."""

    def __init__(self) -> None:
        self._turn = threading.Lock()
        self._size_bytes = 0
        self._sum = hashlib.sha256().digest()
        self._verdict = Verdict(head=Head())

    def verify(self, content: bytes) -> Verdict:
        """The first fault in the whole lines of a log, as `verify` finds it.

        A sum over what was verified before is quick and lets other threads work; reading each line is not.
        """
        end = content.rfind(b"\n") + 1
        view = memoryview(content)
        with self._turn:
            size, before = self._size_bytes, self._verdict
            if size > end or hashlib.sha256(view[:size]).digest() != self._sum:
                size, before = 0, Verdict(head=Head())
            self._verdict = verify(content[size:end].split(b"\n")[:-1], after=before)
            self._size_bytes, self._sum = end, hashlib.sha256(view[:end]).digest()
            return self._verdict


def verdict_on(content: bytes, known: Head | None, checked: Checked) -> Verdict:
    """Whether a log is whole: its chain, its last line's end, and, where that is known, where it ended."""
    verdict = checked.verify(content)
    head = verdict.head
    if verdict.fault is not None:
        return verdict
    if content and not content.endswith(b"\n"):
        said = "it has no end: a crash has cut it, or somebody"
        return Verdict(head=head, fault=Fault(line=head.count + 1, said=said))
    return Verdict(head=head, fault=None if known is None else end_fault(content, head, known))


def end_fault(content: bytes, head: Head, known: Head) -> Fault | None:
    """Whether a chain that holds and ends at `head` has the end that is known, or goes on from there."""
    more = head.count - known.count
    if more < 0:
        said = f"the end is missing: {known.count} lines were written, {head.count} are there"
        return Fault(line=head.count + 1, said=said)
    if known.count == 0:
        return None if known == Head() else Fault(line=1, said="it is not as it was written")
    whole = content[: content.rfind(b"\n")]
    if sum_of(whole.rsplit(b"\n", more + 1)[-more - 1]) != known.sum:
        return Fault(line=known.count, said="it is not as it was written")
    return None
