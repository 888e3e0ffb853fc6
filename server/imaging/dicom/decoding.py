"""Decoding of compressed images in separate processes, which a damaged image may crash.

GDCM ends its process on some damaged streams, and holds the interpreter lock while it decodes. Two workers
use both cores at a lower priority than the tracker; they take half a second to start.
"""

import os
import queue
import subprocess
import sys
import threading
from collections import deque
from collections.abc import Iterable, Iterator
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass, field
from typing import Any, TypeAlias, cast

import numpy as np
import numpy.typing as npt

from server.imaging.dicom import worker

# Integers of any size, signed or unsigned, as stored in the file.
StoredPixels: TypeAlias = npt.NDArray[np.integer[Any]]
# Number of processes; each needs 75 MiB while it runs.
MAX_PROCESSES = 2
# A decoder without a response for this time hangs.
MAX_SECONDS = 60.0


@dataclass(frozen=True, slots=True, kw_only=True)
class Encoded:
    """One compressed image.

    Attributes:
        index: Index that identifies it for the caller.
        options: Pixel attributes of its file, by pydicom's names.
        content: Encapsulated, as in the file.
    """

    index: int
    options: dict[str, object]
    content: bytes


class DecoderCrashed(Exception):
    """The decoding process has crashed or hangs."""


@dataclass(slots=True)
class _Process:
    """One decoding process with its pipes."""

    process: subprocess.Popen[bytes]

    def decode(self, one: Encoded) -> StoredPixels | None:
        """Return the pixels (rows, columns); None if they cannot be decoded."""
        timer = threading.Timer(MAX_SECONDS, self.process.kill)
        timer.start()
        try:
            worker.write_message(cast("Any", self.process.stdin), one.options, one.content)
            answer = worker.read_message(cast("Any", self.process.stdout))
        except OSError:
            answer = None
        finally:
            timer.cancel()
        if answer is None:
            raise DecoderCrashed
        header, content = answer
        if not header:
            return None
        shape = cast("list[int]", header["shape"])
        return np.frombuffer(content, dtype=str(header["dtype"])).reshape(shape)

    def end(self) -> None:
        self.process.kill()
        self.process.communicate()


@dataclass(slots=True)
class _Decoders:
    """Decoding processes, started on demand."""

    idle: queue.SimpleQueue[_Process] = field(default_factory=queue.SimpleQueue)
    started: list[_Process] = field(default_factory=list)

    def decode(self, one: Encoded) -> tuple[int, StoredPixels | None]:
        """Decode one image in an idle process."""
        try:
            process = self.idle.get_nowait()
        except queue.Empty:
            process = _Process(
                subprocess.Popen(  # noqa: S603  our own file, run by the Python that runs us
                    [sys.executable, "-P", worker.__file__],
                    stdin=subprocess.PIPE,
                    stdout=subprocess.PIPE,
                    stderr=subprocess.DEVNULL,
                )
            )
            self.started.append(process)
        try:
            return one.index, process.decode(one)
        except DecoderCrashed:
            return one.index, None
        finally:
            if process.process.poll() is None:
                self.idle.put(process)


@contextmanager
def _decoders() -> Iterator[_Decoders]:
    decoders = _Decoders()
    try:
        yield decoders
    finally:
        for process in decoders.started:
            process.end()


def decode_images(images: Iterable[Encoded]) -> Iterator[tuple[int, StoredPixels | None]]:
    """Yield the index and the pixels (rows, columns) of each image in order; None if it cannot be decoded."""
    count = max(1, min(MAX_PROCESSES, os.cpu_count() or 1))
    waiting: deque[Future[tuple[int, StoredPixels | None]]] = deque()
    with _decoders() as decoders, ThreadPoolExecutor(count, thread_name_prefix="decode") as threads:
        for one in images:
            waiting.append(threads.submit(decoders.decode, one))
            if len(waiting) > 2 * count:
                yield waiting.popleft().result()
        while waiting:
            yield waiting.popleft().result()
