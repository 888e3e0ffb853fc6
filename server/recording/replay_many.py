"""Checks the replay of many recordings side by side, in processes of this machine or on a Dask cluster.

Each recording is checked in a process of its own, so that one that crashes costs its own row only. On a
cluster the workers read the files under the same paths, and each needs Coaxial and one thread. A row states
the versions that computed it.

distributed (Dask) is an optional dependency, which only a cluster needs.
"""

import hashlib
from collections import deque
from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict, dataclass
from enum import StrEnum
from multiprocessing.connection import Connection, wait
from multiprocessing.context import ForkServerProcess
from pathlib import Path
from time import perf_counter
from typing import Any

import cv2
from pydantic import BaseModel, ConfigDict, JsonValue

from server.errors import RecordingError
from server.installation import product_version
from server.loop.forks import exit_text, forking_context
from server.loop.worker import OPENCV_THREADS
from server.recording.messages import library_versions, machine_name
from server.recording.replay import Difference, ReplayReport, check_recording
from server.recording_file.topics import SUFFIX
from tracker.errors import NavigationError
from tracker.navigation.alarms import AlarmLimits

MAX_TEXT_LENGTH = 300
READ_BYTES = 2**20


class Outcome(StrEnum):
    """Result of one recording."""

    IDENTICAL = "identical"
    DIFFERENT = "different"
    NOT_COMPARED = "not compared"  # no image could be compared
    DAMAGED = "damaged"  # equal up to the damage of the file
    FAILED = "failed"  # not a recording, or the check ended with an error


class ReplayDifference(BaseModel):
    """One value that differs."""

    model_config = ConfigDict(frozen=True)

    image_number: int
    what: str
    """Path of the value in the message."""
    recorded: JsonValue
    replayed: JsonValue
    size: float | None
    """Absolute difference of two numbers; None for other values."""


class ReplayRow(BaseModel):
    """Result of one recording, a line of the table file."""

    model_config = ConfigDict(frozen=True, extra="forbid")

    file: str
    """Path in the folder."""
    sha256: str
    """Of the file; empty if it could not be read."""
    versions: dict[str, str]
    """Of Coaxial, the libraries and the machine that replayed it; empty if this is unknown."""
    limits: dict[str, JsonValue] | None
    """Alarm limits in place of the recorded ones."""
    outcome: Outcome
    images: int = 0
    """Compared images."""
    steps: int = 0
    """Compared alarm steps."""
    first: ReplayDifference | None = None
    """The first difference, of poses or alarms."""
    worst: ReplayDifference | None = None
    """The largest difference of a number, else the first."""
    problem: str = ""
    """Why it failed, or where the file is damaged."""
    duration_s: float = 0.0


@dataclass(frozen=True, slots=True, kw_only=True)
class ReplayTask:
    """A recording to check.

    Attributes:
        path: The file.
        name: Its path in the folder.
        limits: Alarm limits; None for the recorded ones.
    """

    path: str
    name: str
    limits: AlarmLimits | None


def replay_tasks(folder: Path, limits: AlarmLimits | None) -> list[ReplayTask]:
    """Return a task for each recording in a folder and its subfolders, sorted by path."""
    found = sorted(path for path in folder.rglob(f"*{SUFFIX}") if path.is_file())
    return [
        ReplayTask(path=str(path.resolve()), name=_utf8(path.relative_to(folder).as_posix()), limits=limits)
        for path in found
    ]


def current_versions() -> dict[str, str]:
    """Return what the digits of a replay depend on: Coaxial, libraries and machine."""
    return {"coaxial": product_version(), **library_versions(), "machine": machine_name()}


def limit_values(limits: AlarmLimits | None) -> dict[str, JsonValue] | None:
    """Return alarm limits as JSON values; None for the recorded ones."""
    return None if limits is None else {name: _json(value) for name, value in asdict(limits).items()}


def is_finished(row: ReplayRow, task: ReplayTask, versions: Mapping[str, str]) -> bool:
    """Return whether a row of an earlier run is the result of this task with these versions."""
    return (
        row.outcome is not Outcome.FAILED
        and row.versions == versions
        and row.limits == limit_values(task.limits)
        and row.sha256 == _sha256(Path(task.path))
    )


def checked_row(task: ReplayTask) -> ReplayRow:
    """Check one recording; every error is a row."""
    began_s, digest = perf_counter(), ""
    try:
        digest = _sha256(Path(task.path))
        # The same number of threads as during the recording.
        cv2.setNumThreads(OPENCV_THREADS)
        report = check_recording(Path(task.path), limits=task.limits)
    except NavigationError as error:
        return _failed(task, f"{error.code}: {error.message}", digest)
    except Exception as error:  # noqa: BLE001  a file that breaks the replay must not end the others
        return _failed(task, f"{type(error).__name__}: {error}", digest)
    return _row(task, report, digest, perf_counter() - began_s)


def local_rows(tasks: Sequence[ReplayTask], *, workers: int) -> Iterator[ReplayRow]:
    """Yield a row for each task as it is finished, with up to `workers` processes at once.

    Call it from the main thread.
    """
    context, waiting = forking_context(), deque(tasks)
    running: dict[Connection, tuple[ForkServerProcess, ReplayTask]] = {}
    try:
        while waiting or running:
            while waiting and len(running) < workers:
                task = waiting.popleft()
                results, sent = context.Pipe(duplex=False)
                process = context.Process(target=_send_row, args=(sent, task))
                process.start()
                # The process has the only other end: its death closes the pipe.
                sent.close()
                running[results] = process, task
            ready = wait(list(running))
            for results in [one for one in running if one in ready]:
                process, task = running.pop(results)
                try:
                    row = results.recv()
                    process.join()
                except EOFError:
                    process.join()
                    row = _failed(task, f"its process ended {exit_text(process.exitcode)}")
                results.close()
                yield row
    finally:
        for process, _ in running.values():
            process.kill()
            process.join()


def cluster_rows(
    tasks: Sequence[ReplayTask], *, scheduler: str, timeout_s: float = 10.0
) -> Iterator[ReplayRow]:
    """Yield a row for each task as the workers of a Dask cluster finish it.

    Args:
        tasks: The recordings; each worker reads them under these paths.
        scheduler: Address of the scheduler.
        timeout_s: Time limit of the connection.

    Raises:
        RecordingError: CLUSTER_LIBRARY_MISSING, CLUSTER_UNREACHABLE.
    """
    try:
        from distributed import Client, as_completed  # noqa: PLC0415  optional
    except ImportError:
        raise RecordingError(
            "CLUSTER_LIBRARY_MISSING",
            "a cluster is reached with distributed (Dask), which is not installed",
            'Install it into the environment of Coaxial: pip install "coaxial[cluster]".',
        ) from None
    try:
        client: Any = Client(scheduler, timeout=timeout_s, set_as_default=False)
    except (OSError, ValueError) as error:
        reason = str(error)[:MAX_TEXT_LENGTH]
        raise RecordingError(
            "CLUSTER_UNREACHABLE",
            f"the scheduler {scheduler[:MAX_TEXT_LENGTH]} cannot be reached: {reason}",
            "Check its address, as in tcp://host:8786, and that it runs.",
            {"scheduler": scheduler[:MAX_TEXT_LENGTH], "reason": reason},
        ) from error
    with client:
        # Not pure: the file may have changed since an earlier run with the same arguments.
        futures = {client.submit(checked_row, task, pure=False): task for task in tasks}
        for future in as_completed(futures, loop=client.loop):
            crash = future.exception()
            yield future.result() if crash is None else _failed(futures[future], f"its worker: {crash}")


def _send_row(sent: Connection, task: ReplayTask) -> None:
    sent.send(checked_row(task))
    sent.close()


def _row(task: ReplayTask, report: ReplayReport, digest: str, duration_s: float) -> ReplayRow:
    first = min(
        (one.first for one in (report.poses, report.alarms) if one.first is not None),
        key=lambda one: one.image_number,
        default=None,
    )
    # Infinite for texts and missing values, which no number exceeds.
    worst = max(
        (one.worst for one in (report.poses, report.alarms) if one.worst is not None),
        key=lambda one: one.size,
        default=None,
    )
    return ReplayRow(
        file=task.name,
        sha256=digest,
        versions=current_versions(),
        limits=limit_values(task.limits),
        outcome=_outcome(report, first),
        images=report.images,
        steps=report.steps,
        first=_difference(first),
        worst=_difference(worst),
        problem=_utf8(report.incomplete_reason)[:MAX_TEXT_LENGTH],
        duration_s=round(duration_s, 3),
    )


def _outcome(report: ReplayReport, first: Difference | None) -> Outcome:
    if first is not None:
        return Outcome.DIFFERENT
    if report.is_damaged:
        return Outcome.DAMAGED
    return Outcome.IDENTICAL if report.is_equal else Outcome.NOT_COMPARED


def _difference(found: Difference | None) -> ReplayDifference | None:
    if found is None:
        return None
    return ReplayDifference(
        image_number=found.image_number,
        what=found.what,
        recorded=_short(found.recorded),
        replayed=_short(found.replayed),
        size=None if found.size == float("inf") else found.size,
    )


def _failed(task: ReplayTask, problem: str, digest: str = "") -> ReplayRow:
    return ReplayRow(
        file=task.name,
        sha256=digest,
        versions={},
        limits=limit_values(task.limits),
        outcome=Outcome.FAILED,
        problem=_utf8(problem)[:MAX_TEXT_LENGTH],
    )


def _utf8(text: str) -> str:
    """Return a text that can be written as UTF-8: names of files may be any bytes."""
    return text.encode(errors="backslashreplace").decode()


def _short(value: Any) -> JsonValue:  # noqa: ANN401
    """Return a number or short value as it is, otherwise the beginning of its text."""
    if value is None or isinstance(value, bool | int | float):
        return value
    return str(value)[:MAX_TEXT_LENGTH]


def _json(value: Any) -> JsonValue:  # noqa: ANN401
    return value if value is None or isinstance(value, bool | int | float | str) else str(value)


def _sha256(path: Path) -> str:
    digest = hashlib.sha256()
    try:
        with path.open("rb") as file:
            while part := file.read(READ_BYTES):
                digest.update(part)
    except OSError as error:
        why = (error.strerror or str(error)).lower()
        raise RecordingError(
            "RECORDING_NOT_READABLE",
            f"{path.name} cannot be read as a recording: {why}",
            "Give a recording of Coaxial (.mcap).",
            {"file": path.name, "read_problem": why, "system_error": why},
        ) from error
    return digest.hexdigest()
