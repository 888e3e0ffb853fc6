"""Incremental verification of the log: the verified part is recognised by one hash, and not parsed again.

Writers and requests do not wait for a reader, and a log of years takes a moment. Rejections are written at
most sixty times a minute; the log itself is never truncated.
"""

import hashlib
import threading

from server.security.audit.chain import Fault, Head, Verdict, sha256_of, verify


class LogVerifier:
    """Result of the verification so far. Thread-safe."""

    def __init__(self) -> None:
        self._lock = threading.Lock()
        self._size_bytes = 0
        self._sum = hashlib.sha256().digest()
        self._verdict = Verdict(head=Head())

    def verify(self, content: bytes) -> Verdict:
        """Return the first fault in the complete lines of a log.

        The hash of the verified part is fast and releases the GIL; parsing each line is not.
        """
        end = content.rfind(b"\n") + 1
        view = memoryview(content)
        with self._lock:
            size, before = self._size_bytes, self._verdict
            if size > end or hashlib.sha256(view[:size]).digest() != self._sum:
                size, before = 0, Verdict(head=Head())
            self._verdict = verify(content[size:end].split(b"\n")[:-1], after=before)
            self._size_bytes, self._sum = end, hashlib.sha256(view[:end]).digest()
            return self._verdict


def verify_content(content: bytes, known: Head | None, checked: LogVerifier) -> Verdict:
    """Verify a log: its chain, its last line's end, and the known end of the chain."""
    verdict = checked.verify(content)
    head = verdict.head
    if verdict.fault is not None:
        return verdict
    if content and not content.endswith(b"\n"):
        reason = "it has no line end: it was truncated by a crash or by hand"
        return Verdict(head=head, fault=Fault(line=head.count + 1, reason=reason))
    return Verdict(head=head, fault=None if known is None else end_fault(content, head, known))


def end_fault(content: bytes, head: Head, known: Head) -> Fault | None:
    """Return a fault if a valid chain that ends at `head` does not contain the known end."""
    more = head.count - known.count
    if more < 0:
        reason = f"the end is missing: {known.count} lines were written, {head.count} are there"
        return Fault(line=head.count + 1, reason=reason)
    if known.count == 0:
        return None if known == Head() else Fault(line=1, reason="it was changed after it was written")
    whole = content[: content.rfind(b"\n")]
    if sha256_of(whole.rsplit(b"\n", more + 1)[-more - 1]) != known.sum:
        return Fault(line=known.count, reason="it was changed after it was written")
    return None
