"""Background jobs: started, monitored and cancelled by their id.

The result is returned to the web process, which stores it, so the database has a single writer. Large
results are passed as a file in the job's folder.
"""

import secrets
import shutil
import threading
from collections.abc import Callable, Mapping
from concurrent.futures import ThreadPoolExecutor
from dataclasses import dataclass, field, replace
from multiprocessing.connection import Connection, wait
from multiprocessing.context import ForkServerProcess
from pathlib import Path
from typing import TypeAlias

import structlog

from server.jobs.records import Job, JobQueue, JobState
from server.jobs.worker import Progress, Result, Work, run_work, to_json_value
from server.live import Problem
from server.logs import LogSettings
from server.loop.forks import end_process, exit_text, forking_context
from tracker.errors import NavigationError

# Number of finished jobs whose state stays available.
MAX_FINISHED_JOBS = 50
END_TIMEOUT_S = 5.0

# Called in the server with the return value of the work, to store it; returns the result of the job.
Conclude: TypeAlias = Callable[[object], object]
log = structlog.get_logger(__name__)


class JobUnknown(NavigationError):
    """The job does not exist."""


@dataclass(slots=True, kw_only=True)
class _JobProcess:
    """A job with its process; modified only under the lock of `Jobs`."""

    job: Job
    work: Work
    arguments: Mapping[str, object]
    folder: Path | None
    conclude: Conclude | None
    process: ForkServerProcess | None = None
    cancelled: threading.Event = field(default_factory=threading.Event)


class Jobs:
    """Runs jobs in separate processes, at most `max_at_once` of a queue at a time. Thread-safe.

    Create it in the main thread: the fork server ends with the thread that started it.
    """

    def __init__(self, *, log: LogSettings, max_at_once: int = 1) -> None:
        self._log = log
        self._context = forking_context()
        # One permanent thread starts all processes: a fork server ends, with all its children, when the
        # thread that started it ends.
        self._starter = ThreadPoolExecutor(max_workers=1, thread_name_prefix="job starter")
        self._lock = threading.Lock()
        self._turns = {queue: threading.Semaphore(max_at_once) for queue in JobQueue}
        self._entries: dict[str, _JobProcess] = {}
        self._threads: dict[str, threading.Thread] = {}
        self._closed = False

    def start(
        self,
        title: str,
        work: Work,
        arguments: Mapping[str, object] | None = None,
        *,
        folder: Path | None = None,
        conclude: Conclude | None = None,
        queue: JobQueue = JobQueue.PROCEDURE,
    ) -> Job:
        """Start a job.

        Args:
            title: description of the job, without the patient's name.
            work: a module-level function, called as work(report, **arguments) in another process. It returns
                a JSON-serialisable value, or any picklable one with `conclude`; it may raise NavigationError.
            arguments: keyword arguments; they must be picklable.
            folder: folder of temporary files; deleted at the end of the job in every case.
            conclude: called in this process with the return value, to store it; returns the job's result.
            queue: jobs of other queues do not wait for it.
        """
        job = Job(id=secrets.token_hex(8), title=title)
        entry = _JobProcess(
            job=job, work=work, arguments=dict(arguments or {}), folder=folder, conclude=conclude
        )
        thread = threading.Thread(
            target=self._run, args=(entry, self._turns[queue]), name=f"job {job.id}", daemon=True
        )
        with self._lock:
            if self._closed:
                entry.cancelled.set()
            self._forget_old()
            self._entries[job.id] = entry
            self._threads[job.id] = thread
        thread.start()
        return job

    def get(self, job_id: str) -> Job:
        """Return the state of a job.

        Raises:
            JobUnknown: JOB_UNKNOWN.
        """
        with self._lock:
            return self._find(job_id).job

    def list(self) -> tuple[Job, ...]:
        """Return the available jobs, newest first."""
        with self._lock:
            return tuple(entry.job for entry in reversed(self._entries.values()))

    def cancel(self, job_id: str) -> Job:
        """Cancel a job; without effect if it is finished, or its result is being stored.

        Raises:
            JobUnknown: JOB_UNKNOWN.
        """
        with self._lock:
            entry = self._find(job_id)
            if entry.job.state in (JobState.WAITING, JobState.RUNNING):
                entry.cancelled.set()
                entry.job = replace(entry.job, state=JobState.CANCELLED)
                if entry.process is not None:
                    entry.process.kill()
            return entry.job

    def wait_for(self, job_id: str, *, timeout_s: float | None = None) -> Job:
        """Wait until a job is finished and its temporary files are deleted, at most `timeout_s`."""
        with self._lock:
            thread = self._threads.get(job_id)
        if thread is not None:
            thread.join(timeout_s)
        return self.get(job_id)

    def close(self) -> None:
        """Cancel all jobs, and wait until they have ended."""
        with self._lock:
            self._closed = True
            ids = list(self._entries)
        for job_id in ids:
            self.cancel(job_id)
        for thread in list(self._threads.values()):
            thread.join(END_TIMEOUT_S)
        self._starter.shutdown(wait=False)

    def _run(self, entry: _JobProcess, turns: threading.Semaphore) -> None:
        try:
            with turns:
                if not entry.cancelled.is_set():
                    self._work(entry)
        except Exception:
            log.exception("a job could not be monitored", job=entry.job.id)
            self._end(entry, _crashed("could not be monitored"))
        finally:
            if entry.folder is not None:
                shutil.rmtree(entry.folder, ignore_errors=True)
            with self._lock:
                self._threads.pop(entry.job.id, None)

    def _work(self, entry: _JobProcess) -> None:
        """Start the process, receive its messages until it ends, and store its result."""
        ours, theirs = self._context.Pipe(duplex=False)
        process = self._context.Process(
            target=run_work,
            args=(entry.work, entry.arguments, theirs, self._log),
            kwargs={"is_answer": entry.conclude is None},
            name=f"job {entry.job.id}",
            daemon=True,
        )
        with ours:
            with theirs, self._lock:
                if entry.cancelled.is_set():
                    return
                self._starter.submit(process.start).result()
                entry.process = process
                entry.job = replace(entry.job, state=JobState.RUNNING)
            outcome = self._listen(entry, process, ours)
        with self._lock:
            entry.process = None
        # The outcome has been received, so that a process that hangs while exiting is killed.
        exitcode = end_process(process, timeout_s=END_TIMEOUT_S)
        self._end(entry, outcome if outcome is not None else _crashed(f"ended {exit_text(exitcode)}"))

    def _listen(
        self, entry: _JobProcess, process: ForkServerProcess, ours: Connection
    ) -> Result | Problem | None:
        """Return the outcome that the process sent; None if it ended without one."""
        while True:
            wait([ours, process.sentinel])
            if not ours.poll():
                return None
            try:
                outcome = ours.recv()
            except (EOFError, OSError):
                return None
            if not isinstance(outcome, Progress):
                return outcome if isinstance(outcome, Result | Problem) else None
            with self._lock:
                ratio = min(1.0, max(entry.job.progress_ratio, outcome.ratio))
                entry.job = replace(entry.job, progress_ratio=ratio, doing=outcome.doing)

    def _end(self, entry: _JobProcess, outcome: Result | Problem) -> None:
        with self._lock:
            if entry.job.state.is_finished:
                return
            if isinstance(outcome, Result):
                entry.job = replace(entry.job, state=JobState.CONCLUDING)
        if isinstance(outcome, Result):
            outcome = self._store_result(entry, outcome)
        with self._lock:
            if isinstance(outcome, Result):
                entry.job = replace(
                    entry.job, state=JobState.DONE, progress_ratio=1.0, doing="", result=outcome.value
                )
            else:
                entry.job = replace(entry.job, state=JobState.FAILED, doing="", problem=outcome)
        log.info("job finished", job=entry.job.id, state=entry.job.state.value)

    def _store_result(self, entry: _JobProcess, result: Result) -> Result | Problem:
        try:
            return (
                result
                if entry.conclude is None
                else Result(value=to_json_value(entry.conclude(result.value)))
            )
        except NavigationError as error:
            return Problem.from_error(error)
        except Exception:
            log.exception("the result of a job could not be stored", job=entry.job.id)
            return _crashed("returned a result that could not be stored")

    def _find(self, job_id: str) -> _JobProcess:
        if job_id not in self._entries:
            raise JobUnknown(
                "JOB_UNKNOWN",
                f"there is no job {job_id[:40]}",
                "Start it again; jobs do not survive a restart of the server.",
                {"job_id": job_id[:40]},
            )
        return self._entries[job_id]

    def _forget_old(self) -> None:
        over = [job_id for job_id, entry in self._entries.items() if entry.job.state.is_finished]
        for job_id in over[: max(0, len(over) - MAX_FINISHED_JOBS + 1)]:
            del self._entries[job_id]


def _crashed(how: str) -> Problem:
    return Problem(
        code="JOB_ENDED",
        message=f"the process of the job {how}",
        remedy="Start it again. If it is ended by SIGKILL each time, the machine has too little memory.",
        context={"process_problem": how},
    )
