"""Images of a phone for the tracking process: a ring in shared memory and a wake-up pipe.

The web process never waits for the reader, and an unread image is replaced by a newer one. Ring and pipe
survive a tracking process: the next one reads what arrives after its start. Images stay JPEG until the
tracking process decodes them. Video coding (WebRTC) would need less bandwidth, but its buffers hide the age
of an image.
"""

import contextlib
import os
import pickle
import time
from multiprocessing import Pipe
from multiprocessing.connection import wait

from server.capture.phone import PhoneUpdate
from server.loop.ring import ImageRing

# Maximum size of a JPEG, and of its metadata.
MAX_JPEG_BYTES = 4 * 1024 * 1024
MAX_METADATA_BYTES = 16 * 1024


class PhoneInbox:
    """One writer, the web process; one reader at a time, the tracking process. Passed as an argument."""

    def __init__(self) -> None:
        self._ring = ImageRing(image_bytes=0, payload_bytes=MAX_JPEG_BYTES + MAX_METADATA_BYTES)
        self._wakeup_reader, self._wakeup_writer = Pipe(duplex=False)
        os.set_blocking(self._wakeup_reader.fileno(), False)
        os.set_blocking(self._wakeup_writer.fileno(), False)

    def put(self, update: PhoneUpdate) -> None:
        """Replace the last update, and wake the reader. Never blocks."""
        self._ring.write(pickle.dumps(update, protocol=5))
        # A full pipe wakes the reader anyway.
        with contextlib.suppress(BlockingIOError):
            os.write(self._wakeup_writer.fileno(), b".")

    def newest(self) -> tuple[int, PhoneUpdate] | None:
        """Return the last entry and its number; None before the first."""
        return self._entry_after(0)

    def next_after(self, sequence: int, timeout_s: float) -> tuple[int, PhoneUpdate] | None:
        """Return the last entry if its number is above `sequence`; wait up to the timeout."""
        deadline_s = time.monotonic() + timeout_s
        while True:
            # Drained before the check, so that no later entry is missed.
            with contextlib.suppress(BlockingIOError):
                os.read(self._wakeup_reader.fileno(), 4096)
            entry = self._entry_after(sequence)
            left_s = deadline_s - time.monotonic()
            if entry is not None or left_s <= 0.0:
                return entry
            wait([self._wakeup_reader], timeout=left_s)

    def close(self) -> None:
        """Release memory and pipe."""
        self._ring.close()
        self._wakeup_reader.close()
        self._wakeup_writer.close()

    def _entry_after(self, sequence: int) -> tuple[int, PhoneUpdate] | None:
        entry = self._ring.newest(after=sequence)
        if entry is None:
            return None
        update: PhoneUpdate = pickle.loads(entry.payload)  # noqa: S301  written by this server's own web process
        return entry.sequence, update
