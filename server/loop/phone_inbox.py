"""A phone's images on their way to the tracking process: a ring in shared memory and a pipe that wakes.

The web process never waits for the other, and what was not read is replaced by what is newer. Ring and pipe
outlast a tracking process: the next one reads what comes after its start. Images stay JPEG until the tracking
process decodes them. Video coding between images would need less of the line, and WebRTC would bring it, but
its buffers hide how old an image is.
"""

import contextlib
import os
import pickle
import time
from multiprocessing import Pipe
from multiprocessing.connection import wait

from server.capture.phone import Inbound
from server.loop.ring import ImageRing

# The largest JPEG that is taken, and what is told with it.
MAX_JPEG_BYTES = 4 * 1024 * 1024
MAX_TOLD_BYTES = 16 * 1024


class PhoneInbox:
    """One writer, the web process; one reader at a time, the tracking process. Handed over as an argument."""

    def __init__(self) -> None:
        self._ring = ImageRing(image_bytes=0, note_bytes=MAX_JPEG_BYTES + MAX_TOLD_BYTES)
        self._heard, self._bell = Pipe(duplex=False)
        os.set_blocking(self._heard.fileno(), False)
        os.set_blocking(self._bell.fileno(), False)

    def put(self, told: Inbound) -> None:
        """Replace what was told before, and wake the reader. Never blocks."""
        self._ring.write(pickle.dumps(told, protocol=5))
        # A full pipe has woken it already.
        with contextlib.suppress(BlockingIOError):
            os.write(self._bell.fileno(), b".")

    def newest(self) -> tuple[int, Inbound] | None:
        """The last entry and its number; None before the first."""
        return self._entry_after(0)

    def next_after(self, sequence: int, timeout_s: float) -> tuple[int, Inbound] | None:
        """The last entry, if its number is above `sequence`, now or within this time."""
        deadline_s = time.monotonic() + timeout_s
        while True:
            # Emptied before the look, so that nothing that comes after it is missed.
            with contextlib.suppress(BlockingIOError):
                os.read(self._heard.fileno(), 4096)
            entry = self._entry_after(sequence)
            left_s = deadline_s - time.monotonic()
            if entry is not None or left_s <= 0.0:
                return entry
            wait([self._heard], timeout=left_s)

    def close(self) -> None:
        """Let go of the memory and the pipe."""
        self._ring.close()
        self._heard.close()
        self._bell.close()

    def _entry_after(self, sequence: int) -> tuple[int, Inbound] | None:
        entry = self._ring.newest(after=sequence)
        if entry is None:
            return None
        told: Inbound = pickle.loads(entry.note)  # noqa: S301  written by this server's own web process
        return entry.sequence, told
