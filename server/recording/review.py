"""`RecordingReview`: timeline, images and results of a finished recording."""

import threading
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from pydantic import ValidationError

from server.errors import RecordingError
from server.jobs import Job, Jobs, JobState
from server.loop.tracking_state import TrackingState
from server.overlay import encode_jpeg
from server.recording.drilling_course import DrillingCourse
from server.recording.messages import DocumentsMessage
from server.recording.recorded_results import snapshot_in_state, state_of
from server.recording.service import RecordingService
from server.recording.timeline import (
    FIGURES,
    PACKINGS,
    Floats,
    Integers,
    RecordingIndex,
    RecordingSummary,
    index_path,
    store_index,
    stored_index,
    stored_summary,
)
from server.recording_file import PackedImage, unpacked
from server.recording_file.locations import read_content
from server.store import DocumentKind, NotFound
from server.stream.snapshot_messages import SnapshotMessage
from tracker.navigation import NavigationSnapshot

JPEG_QUALITY = 85
# Figures of which a sample of several images has the worst value; the sign makes the worst the largest.
WORST_SIGN = {"entry": 1.0, "angle": 1.0, "wall": -1.0, "risk": 1.0}


@dataclass(frozen=True, slots=True, kw_only=True)
class Samples:
    """Figures of a part of a recording; a sample of several images has the worst value of each figure.

    Attributes:
        numbers: (m,) first image of each sample.
        at_s: (m,) its time since the first image.
        values, limits: (m, 5) values and limits of `FIGURES`; NaN if absent.
        statuses: (m, 5) index in `STATUSES`; -1 if absent.
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
        at_s: Time since the first image.
        snapshot: Its `SnapshotMessage`.
        alarms: The `AlarmsMessage` after it; empty if the alarms were not recorded.
    """

    at_s: float
    snapshot: bytes
    alarms: bytes


@dataclass(frozen=True, slots=True, kw_only=True)
class RecordedScene:
    """What the 3-D scene shows of one image.

    Attributes:
        snapshot: Its results; see `snapshot_of` for what they lack.
        surface_id: Document of the bone surface that was in use; empty if there was none.
        recording: Path of the recording.
    """

    snapshot: NavigationSnapshot
    surface_id: str
    recording: Path


@dataclass(frozen=True, slots=True, kw_only=True)
class RecordedDrilling:
    """Course of a drilling, with its recording.

    Attributes:
        recording: Name of the recording.
        summary: Its time, and whether it is complete.
        course: The course.
    """

    recording: str
    summary: RecordingSummary
    course: DrillingCourse


@dataclass(frozen=True, slots=True, kw_only=True)
class Drillings:
    """Drillings in the recordings of a case.

    Attributes:
        courses: Their courses, oldest first.
        unread: Recordings that could not be read.
        running: Number of recordings that are being written, which are not read.
        job: The job that reads the next recording; None if all are read.
    """

    courses: tuple[RecordedDrilling, ...]
    unread: tuple[str, ...]
    running: int
    job: Job | None


class RecordingReview:
    """Reads recordings of the open case. Thread-safe; its methods wait for the disk.

    Args:
        recordings: The recordings.
        jobs: Runs the job that computes the index when it is first needed.
    """

    def __init__(self, recordings: RecordingService, jobs: Jobs) -> None:
        self._recordings = recordings
        self._jobs = jobs
        self._lock = threading.Lock()
        self._started: dict[Path, str] = {}
        self._newest: tuple[Path, int, RecordingIndex] | None = None
        self._newest_state: tuple[tuple[Path, int, int], TrackingState | None] | None = None

    def index(self, name: str) -> RecordingIndex | Job:
        """Return the index of a recording, or the job that computes it.

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
            job = self._job(path)
            return self._start(path) if job is None or job.state.is_finished else job

    def drillings(self) -> Drillings:
        """Return the course of each drilling in the recordings of the open case.

        Recordings without an index are read one after the other: `job` reads the next one.

        Raises:
            SetupOrderError: NO_CASE_OPEN.
        """
        courses, unread, running, job = [], [], 0, None
        for one in self._recordings.list():
            if one.is_running:
                running += 1
                continue
            path = self._recordings.path(one.name)
            with self._lock:
                summary = stored_summary(path)
                started = self._job(path)
                if summary is None and job is None and (started is None or started.state is JobState.DONE):
                    started = self._start(path)
            if summary is not None:
                courses += [
                    RecordedDrilling(recording=one.name, summary=summary, course=each)
                    for each in summary.courses
                ]
            elif started is None:
                # Its turn comes later.
                continue
            elif not started.state.is_finished:
                job = started
            elif started.state is not JobState.DONE:
                unread.append(one.name)
        return Drillings(courses=tuple(courses), unread=tuple(unread), running=running, job=job)

    def jpeg(self, name: str, number: int) -> bytes:
        """Return an image of a recording as JPEG, `number` from 0; the original bytes if it is a JPEG.

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
                "RECORDING_DAMAGED",
                f"image {number} of {name} cannot be decoded",
                "Open another image.",
                {"number": number, "name": name},
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

    def scene(self, name: str, number: int) -> RecordedScene:
        """Return what the 3-D scene shows of an image, `number` from 0.

        Raises the same errors as `jpeg`; RECORDING_WITHOUT_SETUP if the setup of its results is unknown.
        """
        path, index = self._opened(name, number)
        try:
            message = SnapshotMessage.model_validate_json(_content(path, index.snapshots[number]))
            snapshot = snapshot_in_state(message, self._state(path, _newest(index.states, number)))
            if snapshot is None:
                raise RecordingError(
                    "RECORDING_WITHOUT_SETUP",
                    f"{name} does not state with which setup image {number} was computed",
                    "Use its image and figures.",
                    {"name": name, "number": number},
                )
            documents = _content(path, _newest(index.documents, number))
            return RecordedScene(
                snapshot=snapshot,
                surface_id=_surface_id(DocumentsMessage.model_validate_json(documents)) if documents else "",
                recording=path,
            )
        except ValidationError as error:
            raise other_version(name, number, error) from None

    def _state(self, path: Path, place: Integers) -> TrackingState | None:
        """Return a tracking state; the last one is kept, because decoding takes a tenth of a second."""
        key = (path, int(place[0]), int(place[1]))
        with self._lock:
            if self._newest_state is not None and self._newest_state[0] == key:
                return self._newest_state[1]
        state = state_of(_content(path, place))
        with self._lock:
            self._newest_state = (key, state)
        return state

    def nearest(self, name: str, at_s: float) -> tuple[int, float]:
        """Return the image nearest to a time since the first image, from 0, with its time.

        Raises the same errors as `jpeg`; without images RECORDED_IMAGE_UNKNOWN.
        """
        _, index = self._opened(name, 0)
        number = int(np.abs(index.at_s - at_s).argmin())
        return number, float(index.at_s[number])

    def _job(self, path: Path) -> Job | None:
        """Return the last job that read this recording."""
        identity = self._started.get(path)
        return next((one for one in self._jobs.list() if one.id == identity), None)

    def _start(self, path: Path) -> Job:
        job = self._jobs.start("index of a recording", store_index, {"recording": str(path)})
        self._started[path] = job.id
        return job

    def _opened(self, name: str, number: int) -> tuple[Path, RecordingIndex]:
        index = self.index(name)
        if isinstance(index, Job):
            raise RecordingError(
                "RECORDING_NOT_INDEXED",
                f"{name} is not indexed yet",
                "Load its timeline, and wait until it is ready.",
                {"name": name},
            )
        if not 0 <= number < len(index):
            raise NotFound(
                "RECORDED_IMAGE_UNKNOWN",
                f"{name} has {len(index)} images, but no image {number}",
                "Give a number from 0 to the number of images minus 1.",
                {"images": len(index), "name": name, "number": number},
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
    # With one more image on each side, so that curves reach the edges of the plot.
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
    """Return the image with the worst value of this figure; for depths the newest image."""
    if name not in WORST_SIGN:
        return int(numbers[-1])
    values = WORST_SIGN[name] * index.values[numbers, FIGURES.index(name)]
    return int(numbers[0] if np.isnan(values).all() else numbers[np.nanargmax(values)])


def other_version(name: str, number: int, error: ValidationError) -> RecordingError:
    """Return the error for results in an unknown format."""
    return RecordingError(
        "RECORDING_OTHER_VERSION",
        f"the results of image {number} cannot be read: {error.error_count()} values have an unknown format",
        "Review the recording with the version of Coaxial that recorded it.",
        {"name": name, "image": number, "unknown": error.error_count()},
    )


def _newest(places: Integers, number: int) -> Integers:
    """Return offset and length of the newest of these messages for an image; zeros if there is none."""
    row = int(np.searchsorted(places[:, 0], number, side="right")) - 1
    return places[row, 1:] if row >= 0 else np.zeros(2, dtype=np.int64)


def _surface_id(documents: DocumentsMessage) -> str:
    kind = DocumentKind.SURFACE.value
    return next((one.id for one in documents.documents if one.kind == kind), "")


def _content(path: Path, place: Integers) -> bytes:
    offset, length = (int(one) for one in place)
    with path.open("rb") as file:
        return read_content(file, offset, length)
