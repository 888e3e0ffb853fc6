"""Images and reports from one process to another, through memory that both see.

A ring of a few slots, one writer, readers that take the newest. The writer never waits for a reader, and
marks a slot before and after it changes it (a sequence lock), so that a reader who was too slow notices and
takes a newer one instead of a torn image. The memory has no name: it is gone with the last process that
holds it, however that one ends.
"""

import contextlib
import mmap
import os
import tempfile
import time
from dataclasses import dataclass
from multiprocessing import reduction
from typing import Any

import numpy as np
import numpy.typing as npt

from server.errors import CaptureError

SLOTS = 4
NOTE_BYTES = 256 * 1024
# 8K. The memory is taken page by page when it is first written, so a small image costs little.
IMAGE_BYTES = 7680 * 4320 * 3
PAGE_BYTES = mmap.ALLOCATIONGRANULARITY
READ_ATTEMPTS = 8

# The fields of a slot's head, in 8-byte words.
LOCK, SEQUENCE, HEIGHT, WIDTH, NOTE_LENGTH = range(5)
# The fields of the ring's head.
WRITTEN_AT_US, IMAGES = range(2)


@dataclass(frozen=True, slots=True, kw_only=True)
class Entry:
    """One thing read from the ring.

    Attributes:
        sequence: counts what was written, from 1.
        note: the bytes written with the image.
        image: (h, w, 3), a copy; None when there was none.
    """

    sequence: int
    note: bytes
    image: npt.NDArray[np.uint8] | None


class ImageRing:
    """Newest wins, never torn. One writer; handed to a child process as an argument."""

    def __init__(
        self, *, slots: int = SLOTS, image_bytes: int = IMAGE_BYTES, note_bytes: int = NOTE_BYTES
    ) -> None:
        self._slots = slots
        self._image_bytes = image_bytes
        self._note_bytes = note_bytes
        # The notes' part and the images' part of a slot each start on a page of their own.
        self._slot_bytes = _whole_pages(PAGE_BYTES + note_bytes + image_bytes)
        self._fd: int = _nameless_memory(PAGE_BYTES + slots * self._slot_bytes)
        self._map_memory()

    def write(self, note: bytes, image: npt.NDArray[np.uint8] | None = None) -> None:
        """Put a note, and an image (h, w, 3) if there is one, over the oldest slot.

        Raises:
            CaptureError: IMAGE_TOO_LARGE.
            ValueError: the note is longer than the ring's notes may be.
        """
        if len(note) > self._note_bytes:
            raise ValueError(f"a note of {len(note)} bytes, at most {self._note_bytes}")
        if image is not None and (image.nbytes > self._image_bytes or image.shape[2:] != (3,)):
            raise CaptureError(
                "IMAGE_TOO_LARGE",
                f"an image is {'x'.join(map(str, image.shape[1::-1]))} px with {image.nbytes} bytes, "
                f"at most {self._image_bytes} bytes",
                "Set the camera to a smaller size, at most 7680x4320 px.",
                {"bytes": image.nbytes, "limit_bytes": self._image_bytes},
            )
        self._sequence += 1
        slot = self._sequence % self._slots
        head = self._heads[slot]
        head[LOCK] += 1  # odd: being written
        head[SEQUENCE] = self._sequence
        head[NOTE_LENGTH] = len(note)
        self._notes[slot][: len(note)] = np.frombuffer(note, dtype=np.uint8)
        head[HEIGHT], head[WIDTH] = (0, 0) if image is None else image.shape[:2]
        if image is not None:
            pixels = self._images[slot][: image.nbytes].reshape(image.shape)
            np.copyto(pixels, image)
            self._head[IMAGES] += 1
        head[LOCK] += 1  # even: whole
        self._head[WRITTEN_AT_US] = int(time.monotonic() * 1e6)

    def newest(self, after: int = 0) -> Entry | None:
        """The newest entry with a sequence above `after`, None if there is none or the writer is faster."""
        for _ in range(READ_ATTEMPTS):
            found = [whole for whole in map(self._whole, range(self._slots)) if whole and whole[0] > after]
            if not found:
                return None
            sequence, slot, lock = max(found)
            entry = self._copied(slot, sequence)
            if entry is not None and int(self._heads[slot][LOCK]) == lock:
                return entry
        return None

    @property
    def written_at_s(self) -> float:
        """Monotonic time of the last write; 0 before the first."""
        return int(self._head[WRITTEN_AT_US]) / 1e6

    @property
    def images(self) -> int:
        """How many images were written."""
        return int(self._head[IMAGES])

    def close(self) -> None:
        """Let go of the handle to the memory; the memory itself goes with its last user."""
        if self._fd >= 0:
            os.close(self._fd)
            self._fd = -1

    def __del__(self) -> None:
        with contextlib.suppress(AttributeError, OSError):
            self.close()

    def _whole(self, slot: int) -> tuple[int, int, int] | None:
        """Sequence, slot and lock of a slot that is not being written."""
        head = self._heads[slot]
        # Read once, and first: read twice, it may have turned odd between the test and the use.
        lock = int(head[LOCK])
        return None if lock % 2 else (int(head[SEQUENCE]), slot, lock)

    def _copied(self, slot: int, sequence: int) -> Entry | None:
        """A copy of a slot, None where its head cannot be right because it is being written."""
        head = self._heads[slot]
        height, width, length = int(head[HEIGHT]), int(head[WIDTH]), int(head[NOTE_LENGTH])
        size = height * width * 3
        if length > self._note_bytes or size > self._image_bytes:
            return None
        note = self._notes[slot][:length].tobytes()
        image = self._images[slot][:size].reshape(height, width, 3).copy() if size else None
        return Entry(sequence=sequence, note=note, image=image)

    def _map_memory(self) -> None:
        memory = mmap.mmap(self._fd, PAGE_BYTES + self._slots * self._slot_bytes)
        words = np.frombuffer(memory, dtype=np.int64)
        pixels = np.frombuffer(memory, dtype=np.uint8)
        self._head = words[:2]
        starts = [PAGE_BYTES + slot * self._slot_bytes for slot in range(self._slots)]
        self._heads = [words[start // 8 : start // 8 + 5] for start in starts]
        self._notes = [pixels[start + PAGE_BYTES :][: self._note_bytes] for start in starts]
        self._images = [
            pixels[start + PAGE_BYTES + self._note_bytes :][: self._image_bytes] for start in starts
        ]
        self._sequence = max(int(head[SEQUENCE]) for head in self._heads)

    def __getstate__(self) -> dict[str, Any]:
        """What a child process gets: the memory's handle, not its content."""
        return {
            "fd": reduction.DupFd(self._fd),
            "slots": self._slots,
            "image_bytes": self._image_bytes,
            "note_bytes": self._note_bytes,
            "slot_bytes": self._slot_bytes,
        }

    def __setstate__(self, state: dict[str, Any]) -> None:
        self._fd = state["fd"].detach()
        self._slots, self._image_bytes = state["slots"], state["image_bytes"]
        self._note_bytes = state["note_bytes"]
        self._slot_bytes = state["slot_bytes"]
        self._map_memory()


def _whole_pages(size: int) -> int:
    return -(-size // PAGE_BYTES) * PAGE_BYTES


def _nameless_memory(size: int) -> int:
    """A handle to memory without a name, or to a deleted file where there is no such thing."""
    if hasattr(os, "memfd_create"):
        fd = os.memfd_create("coaxial-ring")
    else:
        with tempfile.TemporaryFile() as file:
            fd = os.dup(file.fileno())
    os.ftruncate(fd, size)
    return fd
