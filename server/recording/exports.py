"""`RecordingExports`: videos, tables, sequences and parts of recordings, made by jobs.

They are stored as long as the recording. A new file replaces the previous one of its kind.
"""

import threading
from contextlib import suppress
from dataclasses import asdict, dataclass
from pathlib import Path
from typing import Any

from server.jobs import Job, JobQueue, Jobs
from server.recording.cut import cut_recording
from server.recording.parquet import write_parquet_archive
from server.recording.sequence_metafile import SUFFIX as SEQUENCE_SUFFIX
from server.recording.sequence_metafile import write_sequence
from server.recording.service import RecordingService, exports_folder
from server.recording.timeline import Report
from server.recording.video import write_video
from server.recording_file.topics import SUFFIX
from server.store import Home, NotFound
from server.store.home import PRIVATE
from server.texts import Language

VIDEO_SUFFIX, TABLES_SUFFIX = ".mp4", "-tables.zip"


@dataclass(frozen=True, slots=True, kw_only=True)
class ExportedFile:
    """A file made from a recording."""

    file: str
    size_bytes: int


@dataclass(frozen=True, slots=True, kw_only=True)
class Exports:
    """Exports of a recording.

    Attributes:
        files: Files stored beside it, by name.
        job: The newest job for this recording; None if there is none.
    """

    files: tuple[ExportedFile, ...]
    job: Job | None


class RecordingExports:
    """Makes files from recordings of the open case. Thread-safe.

    Args:
        recordings: The recordings.
        jobs: Runs one job per file.
        home: Provides the folder of temporary files.
    """

    def __init__(self, recordings: RecordingService, jobs: Jobs, home: Home) -> None:
        self._recordings = recordings
        self._jobs = jobs
        self._home = home
        self._lock = threading.Lock()
        self._newest: dict[Path, str] = {}

    def start_video(self, name: str, language: Language) -> Job:
        """Start writing a recording as a video; the result of the job contains the name of the file.

        Raises:
            RecordingError: RECORDING_RUNS, RECORDING_DISK_FULL.
            NotFound: RECORDING_UNKNOWN.
            SetupOrderError: NO_CASE_OPEN.
        """
        file = f"{Path(name).stem}-{language}{VIDEO_SUFFIX}"
        return self._start("video of a recording", make_video, name, file, {"language": language})

    def start_cut(self, name: str, from_s: float, to_s: float) -> Job:
        """Start writing the part between two times since the first image.

        Raises the same errors as `start_video`.
        """
        file = f"{Path(name).stem}-{from_s:.1f}-{to_s:.1f}s{SUFFIX}"
        return self._start("piece of a recording", make_piece, name, file, {"from_s": from_s, "to_s": to_s})

    def start_tables(self, name: str) -> Job:
        """Start writing the tables of a recording as Parquet, in one zip archive.

        Raises the same errors as `start_video`.
        """
        return self._start(
            "tables of a recording", make_tables, name, f"{Path(name).stem}{TABLES_SUFFIX}", {}
        )

    def start_sequence(self, name: str, from_s: float, to_s: float) -> Job:
        """Start writing the images and poses between two times since the first image (.igs.mha).

        Raises the same errors as `start_video`.
        """
        file = f"{Path(name).stem}-{from_s:.1f}-{to_s:.1f}s{SEQUENCE_SUFFIX}"
        return self._start(
            "sequence of a recording", make_sequence, name, file, {"from_s": from_s, "to_s": to_s}
        )

    def exports(self, name: str) -> Exports:
        """Return the exports of a recording, complete and in progress.

        Raises:
            NotFound: RECORDING_UNKNOWN.
            SetupOrderError: NO_CASE_OPEN.
        """
        recording = self._recordings.path(name)
        # Read before the files: a job that ends in between is reported as running, and the page polls again.
        with self._lock:
            newest = self._newest.get(recording)
        job = next((one for one in self._jobs.list() if one.id == newest), None)
        folder, files = exports_folder(recording), []
        for path in sorted(folder.iterdir()) if folder.is_dir() else []:
            with suppress(FileNotFoundError):
                files.append(ExportedFile(file=path.name, size_bytes=path.stat().st_size))
        return Exports(files=tuple(files), job=job)

    def path(self, name: str, file: str) -> Path:
        """Return an exported file of a recording.

        Raises:
            NotFound: RECORDING_UNKNOWN, EXPORT_UNKNOWN.
            SetupOrderError: NO_CASE_OPEN.
        """
        folder = exports_folder(self._recordings.path(name))
        # Compared with existing names, because the name comes from a request.
        if not folder.is_dir() or file not in {one.name for one in folder.iterdir()}:
            raise NotFound(
                "EXPORT_UNKNOWN",
                f"{name} has no export of this name",
                "Export it again; a new file replaces the previous one of its kind.",
                {"name": name},
            )
        return folder / file

    def _start(self, title: str, work: Any, name: str, file: str, arguments: dict[str, object]) -> Job:  # noqa: ANN401
        recording = self._recordings.ended_path(name)
        self._recordings.require_space()
        folder = self._home.new_temporary(".export")
        folder.mkdir(mode=PRIVATE, parents=True)
        job = self._jobs.start(
            title,
            work,
            {"recording": str(recording), "folder": str(folder), "file": file, **arguments},
            folder=folder,
            conclude=lambda result: self._stored(recording, folder / file, result),
            queue=JobQueue.RECORDINGS,
        )
        with self._lock:
            self._newest[recording] = job.id
        return job

    def _stored(self, recording: Path, made: Path, result: Any) -> dict[str, object]:  # noqa: ANN401
        """Move the file beside its recording; return its name and size with the result of the job."""
        stored = self._recordings.put_export(recording, made)
        return {"file": stored.name, "size_bytes": stored.stat().st_size, **result}


def make_video(report: Report, *, recording: str, folder: str, file: str, language: Language) -> object:
    """Job: write the video."""
    return asdict(write_video(Path(recording), Path(folder) / file, language=language, report=report))


def make_tables(report: Report, *, recording: str, folder: str, file: str) -> object:
    """Job: write the tables."""
    return {"rows": write_parquet_archive(Path(recording), Path(folder) / file, report)}


def make_sequence(
    report: Report, *, recording: str, folder: str, file: str, from_s: float, to_s: float
) -> object:
    """Job: write the sequence."""
    target = Path(folder) / file
    return asdict(write_sequence(Path(recording), target, from_s=from_s, to_s=to_s, report=report))


def make_piece(
    report: Report, *, recording: str, folder: str, file: str, from_s: float, to_s: float
) -> object:
    """Job: write the part."""
    return asdict(
        cut_recording(Path(recording), Path(folder) / file, from_s=from_s, to_s=to_s, report=report)
    )
