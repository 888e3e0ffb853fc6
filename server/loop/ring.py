"""A ring buffer in shared memory for images and reports from one process to another.

A few slots, one writer, readers that take the newest. The writer never waits for a reader, and increments a
slot's counter before and after a write (a seqlock), so that a reader detects an overwritten slot and takes a
newer one instead of a torn image. The memory is anonymous: it is freed with the last process that uses it.

A recorder reads every entry in order (`next_after`), except those that are overwritten before it reads them.
More slots tolerate a longer delay; the memory of a slot is allocated at its first use.
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
# Half a second of 30 images, for a reader of low priority that needs all of them.
RECORDED_SLOTS = 16
PAYLOAD_BYTES = 256 * 1024
# 8K video. Pages are allocated at the first write, so that small images need little memory.
IMAGE_BYTES = 7680 * 4320 * 3
# Maximum size of the source's JPEG; of an image with a larger JPEG only the pixels are stored.
ENCODED_BYTES = 8 * 2**20
# Maximum size of the tracking state, which is stored once per ring and rarely written.
STATE_BYTES = 64 * 2**20
PAGE_BYTES = mmap.ALLOCATIONGRANULARITY
READ_ATTEMPTS = 8

# Fields of a slot's header, in 8-byte words.
LOCK, SEQUENCE, HEIGHT, WIDTH, PAYLOAD_LENGTH, ENCODED_LENGTH = range(6)
# Fields of the ring's header.
WRITTEN_AT_US, IMAGES, STATE_LOCK, STATE_LENGTH = range(4)


@dataclass(frozen=True, slots=True, kw_only=True)
class Entry:
    """One entry of the ring.

    Attributes:
        sequence: number of the entry, from 1.
        payload: bytes written with the image.
        image: (h, w, 3), a copy; None without an image.
        encoded: The JPEG from which the image was decoded; empty if there is none or it was not requested.
    """

    sequence: int
    payload: bytes
    image: npt.NDArray[np.uint8] | None
    encoded: bytes = b""


class ImageRing:
    """Newest wins, never torn. One writer; passed to a child process as an argument."""

    def __init__(
        self,
        *,
        slots: int = SLOTS,
        image_bytes: int = IMAGE_BYTES,
        payload_bytes: int = PAYLOAD_BYTES,
        state_bytes: int = STATE_BYTES,
    ) -> None:
        self._slots = slots
        self._image_bytes = image_bytes
        self._payload_bytes = payload_bytes
        self._state_bytes = state_bytes
        # No JPEG is larger than its pixels.
        self._encoded_bytes = min(ENCODED_BYTES, image_bytes)
        # Payloads and images of a slot each start on a page.
        self._slot_bytes = _whole_pages(PAGE_BYTES + payload_bytes + image_bytes + self._encoded_bytes)
        self._fd: int = _anonymous_memory(self._total_bytes)
        self._map_memory()

    @property
    def _total_bytes(self) -> int:
        return PAGE_BYTES + self._slots * self._slot_bytes + _whole_pages(self._state_bytes)

    def write(
        self, payload: bytes, image: npt.NDArray[np.uint8] | None = None, *, encoded: bytes = b""
    ) -> None:
        """Write a payload, and an image (h, w, 3) if any with its JPEG, over the oldest slot.

        Raises:
            CaptureError: IMAGE_TOO_LARGE.
            ValueError: the payload is larger than the maximum.
        """
        if len(payload) > self._payload_bytes:
            raise ValueError(f"the payload has {len(payload)} bytes, the maximum is {self._payload_bytes}")
        if image is not None and (image.nbytes > self._image_bytes or image.shape[2:] != (3,)):
            raise CaptureError(
                "IMAGE_TOO_LARGE",
                f"an image has {'x'.join(map(str, image.shape[1::-1]))} px and {image.nbytes} bytes, "
                f"the maximum is {self._image_bytes} bytes",
                "Set the camera to a smaller size, at most 7680x4320 px.",
                {
                    "bytes": image.nbytes,
                    "limit_bytes": self._image_bytes,
                    "size": "x".join(map(str, image.shape[1::-1])),
                },
            )
        self._sequence += 1
        slot = self._sequence % self._slots
        head = self._heads[slot]
        head[LOCK] += 1  # odd: being written
        head[SEQUENCE] = self._sequence
        head[PAYLOAD_LENGTH] = len(payload)
        self._payloads[slot][: len(payload)] = np.frombuffer(payload, dtype=np.uint8)
        head[HEIGHT], head[WIDTH] = (0, 0) if image is None else image.shape[:2]
        fits = len(encoded) <= self._encoded_bytes
        head[ENCODED_LENGTH] = len(encoded) if fits else 0
        if encoded and fits:
            self._encoded[slot][: len(encoded)] = np.frombuffer(encoded, dtype=np.uint8)
        if image is not None:
            pixels = self._images[slot][: image.nbytes].reshape(image.shape)
            np.copyto(pixels, image)
            self._head[IMAGES] += 1
        head[LOCK] += 1  # even: complete
        self._head[WRITTEN_AT_US] = int(time.monotonic() * 1e6)

    def newest(self, after: int = 0) -> Entry | None:
        """Return the newest entry with a sequence above `after`; None without one, or if overwritten."""
        for _ in range(READ_ATTEMPTS):
            found = [
                whole for whole in map(self._stable_slot, range(self._slots)) if whole and whole[0] > after
            ]
            if not found:
                return None
            sequence, slot, lock = max(found)
            entry = self._copied(slot, sequence)
            if entry is not None and int(self._heads[slot][LOCK]) == lock:
                return entry
        return None

    def next_after(self, after: int) -> Entry | None:
        """Return the oldest existing entry with a sequence above `after`; None without one.

        It contains the JPEG if there is one. A gap in the sequence means overwritten entries.
        """
        for _ in range(READ_ATTEMPTS):
            found = [
                whole for whole in map(self._stable_slot, range(self._slots)) if whole and whole[0] > after
            ]
            if not found:
                return None
            sequence, slot, lock = min(found)
            entry = self._copied(slot, sequence, with_encoded=True)
            if entry is not None and int(self._heads[slot][LOCK]) == lock:
                return entry
        return None

    def write_state(self, content: bytes) -> int:
        """Replace the stored tracking state; return its number, 0 if it is too large.

        A report with this number is written after it.
        """
        if len(content) > self._state_bytes:
            return 0
        self._head[STATE_LOCK] += 1
        self._head[STATE_LENGTH] = len(content)
        self._state[: len(content)] = np.frombuffer(content, dtype=np.uint8)
        self._head[STATE_LOCK] += 1
        return int(self._head[STATE_LOCK])

    def state(self, number: int) -> bytes | None:
        """Return the state with this number; None if it was replaced."""
        if int(self._head[STATE_LOCK]) != number:
            return None
        content = self._state[: int(self._head[STATE_LENGTH])].tobytes()
        return content if int(self._head[STATE_LOCK]) == number else None

    @property
    def written_at_s(self) -> float:
        """Monotonic time of the last write; 0 before the first."""
        return int(self._head[WRITTEN_AT_US]) / 1e6

    @property
    def images(self) -> int:
        """Number of images written."""
        return int(self._head[IMAGES])

    def close(self) -> None:
        """Close the handle; the memory is freed with its last user."""
        if self._fd >= 0:
            os.close(self._fd)
            self._fd = -1

    def __del__(self) -> None:
        with contextlib.suppress(AttributeError, OSError):
            self.close()

    def _stable_slot(self, slot: int) -> tuple[int, int, int] | None:
        """Return sequence, slot and lock of a slot that is not being written."""
        head = self._heads[slot]
        # Read only once, because it may change between the test and the use.
        lock = int(head[LOCK])
        return None if lock % 2 else (int(head[SEQUENCE]), slot, lock)

    def _copied(self, slot: int, sequence: int, *, with_encoded: bool = False) -> Entry | None:
        """Return a copy of a slot; None if its header is invalid because it is being written."""
        head = self._heads[slot]
        height, width, length = int(head[HEIGHT]), int(head[WIDTH]), int(head[PAYLOAD_LENGTH])
        size, encoded_length = height * width * 3, int(head[ENCODED_LENGTH]) if with_encoded else 0
        if length > self._payload_bytes or size > self._image_bytes or encoded_length > self._encoded_bytes:
            return None
        payload = self._payloads[slot][:length].tobytes()
        image = self._images[slot][:size].reshape(height, width, 3).copy() if size else None
        encoded = self._encoded[slot][:encoded_length].tobytes()
        return Entry(sequence=sequence, payload=payload, image=image, encoded=encoded)

    def _map_memory(self) -> None:
        memory = mmap.mmap(self._fd, self._total_bytes)
        words = np.frombuffer(memory, dtype=np.int64)
        pixels = np.frombuffer(memory, dtype=np.uint8)
        self._head = words[:4]
        starts = [PAGE_BYTES + slot * self._slot_bytes for slot in range(self._slots)]
        self._heads = [words[start // 8 : start // 8 + 6] for start in starts]
        self._payloads = [pixels[start + PAGE_BYTES :][: self._payload_bytes] for start in starts]
        self._images = [
            pixels[start + PAGE_BYTES + self._payload_bytes :][: self._image_bytes] for start in starts
        ]
        behind = PAGE_BYTES + self._payload_bytes + self._image_bytes
        self._encoded = [pixels[start + behind :][: self._encoded_bytes] for start in starts]
        self._state = pixels[PAGE_BYTES + self._slots * self._slot_bytes :][: self._state_bytes]
        self._sequence = max(int(head[SEQUENCE]) for head in self._heads)

    def __getstate__(self) -> dict[str, Any]:
        """State for a child process: the memory's handle, not its content."""
        return {
            "fd": reduction.DupFd(self._fd),
            "slots": self._slots,
            "image_bytes": self._image_bytes,
            "payload_bytes": self._payload_bytes,
            "state_bytes": self._state_bytes,
            "encoded_bytes": self._encoded_bytes,
            "slot_bytes": self._slot_bytes,
        }

    def __setstate__(self, state: dict[str, Any]) -> None:
        self._fd = state["fd"].detach()
        self._slots, self._image_bytes = state["slots"], state["image_bytes"]
        self._payload_bytes = state["payload_bytes"]
        self._slot_bytes, self._encoded_bytes = state["slot_bytes"], state["encoded_bytes"]
        self._state_bytes = state["state_bytes"]
        self._map_memory()


def _whole_pages(size: int) -> int:
    return -(-size // PAGE_BYTES) * PAGE_BYTES


def _anonymous_memory(size: int) -> int:
    """Return a file descriptor of anonymous memory, or of a deleted file where memfd is missing."""
    if hasattr(os, "memfd_create"):
        fd = os.memfd_create("coaxial-ring")
    else:
        with tempfile.TemporaryFile() as file:
            fd = os.dup(file.fileno())
    os.ftruncate(fd, size)
    return fd
