"""`RecordingReview`: the timeline, images and results of a recording that has ended."""

import threading
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from server.errors import RecordingError
from server.jobs import Job, Jobs
from server.overlay import encode_jpeg
from server.recording.service import RecordingService
from server.recording.timeline import (
    FIGURES,
    PACKINGS,
    Floats,
    Integers,
    RecordingIndex,
    index_path,
    store_index,
    stored_index,
)
from server.recording_file import PackedImage, unpacked
from server.recording_file.locations import read_content
from server.store import NotFound

JPEG_QUALITY = 85
# Figures whose worst value is kept where images share a sample; the sign makes the worst the largest.
WORST_SIGN = {"entry": 1.0, "angle": 1.0, "wall": -1.0}


@dataclass(frozen=True, slots=True, kw_only=True)
class Samples:
    """The figures of a part of a recording; images that share a sample give the worst of each figure.

    Attributes:
        numbers: (m,) the first image of each sample.
        at_s: (m,) its time since the first image.
        values, limits: (m, 4) of `FIGURES`; NaN where there is none.
        statuses: (m, 4) place in `STATUSES`; -1 where there is none.
    """

    numbers: Integers
    at_s: Floats
    values: Floats
    limits: Floats
    statuses: Integers


@dataclass(frozen=True, slots=True, kw_only=True)
class RecordedInstant:
    """The results of one image, as JSON of the live messages.

    Attributes:
        at_s: since the first image.
        snapshot: its `SnapshotMessage`.
        alarms: the `AlarmsMessage` after it; empty if the alarms were not recorded.
    """

    at_s: float
    snapshot: bytes
    alarms: bytes


class RecordingReview:
    """Reads recordings of the open case. Thread-safe; its methods wait for the disk.

    Args:
        recordings: the recordings.
        jobs: one of them makes the index, the first time that it is needed.
    """

    def __init__(self, recordings: RecordingService, jobs: Jobs) -> None:
        self._recordings = recordings
        self._jobs = jobs
        self._lock = threading.Lock()
        self._started: dict[Path, str] = {}
        self._newest: tuple[Path, int, RecordingIndex] | None = None

    def index(self, name: str) -> RecordingIndex | Job:
        """Return the index of a recording, or the job that makes it.

        Raises:
            RecordingError: RECORDING_RUNS.
            NotFound: RECORDING_UNKNOWN.
            SetupOrderError: NO_CASE_OPEN.
        """
        path = self._recordings.ended_path(name)
        with self._lock:
            found = self._stored(path)
            if found is not None:
                return found
            known = {one.id: one for one in self._jobs.list()}
            job = known.get(self._started.get(path, ""))
            if job is None or job.state.is_finished:
                job = self._jobs.start("index of a recording", store_index, {"recording": str(path)})
                self._started[path] = job.id
            return job

    def jpeg(self, name: str, number: int) -> bytes:
        """Return an image of a recording as JPEG, `number` from 0; as it came, if it came as JPEG.

        Raises:
            RecordingError: RECORDING_NOT_INDEXED, RECORDING_DAMAGED.
            NotFound: RECORDING_UNKNOWN, RECORDED_IMAGE_UNKNOWN.
        """
        path, index = self._opened(name, number)
        width, height = (int(one) for one in index.sizes_px[number])
        packed = PackedImage(
            packing=PACKINGS[int(index.packings[number])],
            size_wh_px=(width, height),
            content=_content(path, index.images[number]),
        )
        if packed.is_jpeg:
            return packed.content
        image = unpacked(packed)
        if image is None:
            raise RecordingError(
                "RECORDING_DAMAGED", f"image {number} of {name} cannot be decoded", "Look at another image."
            )
        return encode_jpeg(image, JPEG_QUALITY)

    def instant(self, name: str, number: int) -> RecordedInstant:
        """Return the results of an image, `number` from 0. Raises the same errors as `jpeg`."""
        path, index = self._opened(name, number)
        return RecordedInstant(
            at_s=float(index.at_s[number]),
            snapshot=_content(path, index.snapshots[number]),
            alarms=_content(path, index.alarms[number]),
        )

    def _opened(self, name: str, number: int) -> tuple[Path, RecordingIndex]:
        index = self.index(name)
        if isinstance(index, Job):
            raise RecordingError(
                "RECORDING_NOT_INDEXED", f"{name} is being read", "Load its timeline, and wait for it."
            )
        if not 0 <= number < len(index):
            raise NotFound(
                "RECORDED_IMAGE_UNKNOWN",
                f"{name} has {len(index)} images, and none has the number {number}",
                "Name an image from 0 on.",
                {"images": len(index)},
            )
        return self._recordings.path(name), index

    def _stored(self, path: Path) -> RecordingIndex | None:
        try:
            stored_ns = index_path(path).stat().st_mtime_ns
        except FileNotFoundError:
            return None
        if self._newest is not None and self._newest[:2] == (path, stored_ns):
            return self._newest[2]
        index = stored_index(path)
        self._newest = None if index is None else (path, stored_ns, index)
        return index


def sampled(index: RecordingIndex, from_s: float, to_s: float, max_samples: int) -> Samples:
    """Return about `max_samples` samples of equal duration, between two times since the first image."""
    # With one image on either side, so that curves come in from the edge.
    first = max(0, int(np.searchsorted(index.at_s, from_s)) - 1)
    last = min(len(index), int(np.searchsorted(index.at_s, to_s, side="right")) + 1)
    numbers = np.arange(first, last, dtype=np.int64)
    rows = np.repeat(numbers[:, np.newaxis], len(FIGURES), axis=1)
    if len(numbers) > max_samples:
        step_s = max(to_s - from_s, 1e-6) / max_samples
        buckets = np.floor((index.at_s[numbers] - from_s) / step_s)
        begins = np.flatnonzero(np.diff(buckets, prepend=-np.inf))
        ends = np.append(begins[1:], len(numbers))
        rows = np.array(
            [
                [_worst(index, name, numbers[begin:end]) for name in FIGURES]
                for begin, end in zip(begins, ends, strict=True)
            ]
        )
        numbers = numbers[begins]
    columns = np.arange(len(FIGURES))
    return Samples(
        numbers=numbers,
        at_s=index.at_s[numbers],
        values=index.values[rows, columns],
        limits=index.limits[rows, columns],
        statuses=index.statuses[rows, columns],
    )


def _worst(index: RecordingIndex, name: str, numbers: Integers) -> int:
    """Return which of these images has the worst figure; of depths, the newest."""
    if name not in WORST_SIGN:
        return int(numbers[-1])
    values = WORST_SIGN[name] * index.values[numbers, FIGURES.index(name)]
    return int(numbers[0] if np.isnan(values).all() else numbers[np.nanargmax(values)])


def _content(path: Path, place: Integers) -> bytes:
    offset, length = (int(one) for one in place)
    with path.open("rb") as file:
        return read_content(file, offset, length)
