"""Long work: started, watched, cancelled, and remembered by its id.

The result comes back to the web process, which stores it: the database then has a single writer. Large
results go through a file in the job's folder.
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

from server.jobs.records import Job, JobState
from server.jobs.work import Progress, Result, Work, as_told, run_work
from server.live import Problem
from server.logs import LogSettings
from server.loop.forks import ending_words, forking_context
from tracker.errors import NavigationError

# Ended jobs that are remembered, for those who ask late.
REMEMBERED = 50
END_WITHIN_S = 5.0

# Runs in the server with what the work gave, and keeps it; what it answers is the job's result.
Conclude: TypeAlias = Callable[[object], object]
log = structlog.get_logger(__name__)


class JobUnknown(NavigationError):
    """There is no such job."""


@dataclass(slots=True, kw_only=True)
class _Watched:
    """A job with the process that does it; changed under the lock of `Jobs` alone."""

    job: Job
    work: Work
    arguments: Mapping[str, object]
    folder: Path | None
    conclude: Conclude | None
    process: ForkServerProcess | None = None
    cancelled: threading.Event = field(default_factory=threading.Event)


class Jobs:
    """Does long work in processes of their own, a few at a time; safe to use from any thread.

    Make it in the main thread: the process that forks the others ends with the thread that started it.
    """

    def __init__(self, *, log: LogSettings, max_at_once: int = 1) -> None:
        self._log = log
        self._context = forking_context()
        # One thread starts them all and stays: if the process that forks has to be started again, it ends
        # with the thread that did it, and everything that it forked with it.
        self._starter = ThreadPoolExecutor(max_workers=1, thread_name_prefix="job starter")
        self._lock = threading.Lock()
        self._turns = threading.Semaphore(max_at_once)
        self._watched: dict[str, _Watched] = {}
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
    ) -> Job:
        """Begin long work.

        Args:
            title: what is done, in words, without the patient's name.
            work: a function at the top of a module, called as work(report, **arguments) in another process;
                it answers what JSON can say, or raises a NavigationError.
            arguments: by name; they must be picklable.
            folder: the work's temporary files; taken away when the job is over, however it ended.
            conclude: called here with what the work answered, to keep it; its answer is the job's result.
        """
        job = Job(id=secrets.token_hex(8), title=title)
        watched = _Watched(
            job=job, work=work, arguments=dict(arguments or {}), folder=folder, conclude=conclude
        )
        thread = threading.Thread(target=self._run, args=(watched,), name=f"job {job.id}", daemon=True)
        with self._lock:
            if self._closed:
                watched.cancelled.set()
            self._forget_old()
            self._watched[job.id] = watched
            self._threads[job.id] = thread
        thread.start()
        return job

    def get(self, job_id: str) -> Job:
        """How far a job is.

        Raises:
            JobUnknown: JOB_UNKNOWN.
        """
        with self._lock:
            return self._find(job_id).job

    def list(self) -> tuple[Job, ...]:
        """All jobs that are remembered, the newest first."""
        with self._lock:
            return tuple(watched.job for watched in reversed(self._watched.values()))

    def cancel(self, job_id: str) -> Job:
        """End a job; one that is over, or whose result is being kept, stays as it is.

        Raises:
            JobUnknown: JOB_UNKNOWN.
        """
        with self._lock:
            watched = self._find(job_id)
            if watched.job.state in (JobState.WAITING, JobState.RUNNING):
                watched.cancelled.set()
                watched.job = replace(watched.job, state=JobState.CANCELLED)
                if watched.process is not None:
                    watched.process.kill()
            return watched.job

    def wait_for(self, job_id: str, *, timeout_s: float | None = None) -> Job:
        """The job when it is over and its temporary files are gone, or as it is after `timeout_s`."""
        with self._lock:
            thread = self._threads.get(job_id)
        if thread is not None:
            thread.join(timeout_s)
        return self.get(job_id)

    def close(self) -> None:
        """Cancel everything, and wait until it has ended."""
        with self._lock:
            self._closed = True
            ids = list(self._watched)
        for job_id in ids:
            self.cancel(job_id)
        for thread in list(self._threads.values()):
            thread.join(END_WITHIN_S)
        self._starter.shutdown(wait=False)

    def _run(self, watched: _Watched) -> None:
        try:
            with self._turns:
                if not watched.cancelled.is_set():
                    self._work(watched)
        except Exception:
            log.exception("a job could not be watched", job=watched.job.id)
            self._end(watched, _crashed("could not be watched"))
        finally:
            if watched.folder is not None:
                shutil.rmtree(watched.folder, ignore_errors=True)
            with self._lock:
                self._threads.pop(watched.job.id, None)

    def _work(self, watched: _Watched) -> None:
        """Start the process, listen to it until it ends, and keep what came out."""
        ours, theirs = self._context.Pipe(duplex=False)
        process = self._context.Process(
            target=run_work,
            args=(watched.work, watched.arguments, theirs, self._log),
            kwargs={"is_answer": watched.conclude is None},
            name=f"job {watched.job.id}",
            daemon=True,
        )
        with ours:
            with theirs, self._lock:
                if watched.cancelled.is_set():
                    return
                self._starter.submit(process.start).result()
                watched.process = process
                watched.job = replace(watched.job, state=JobState.RUNNING)
            told = self._listen(watched, process, ours)
        process.join(END_WITHIN_S)
        ended = ending_words(process.exitcode)
        with self._lock:
            watched.process = None
        # It has said its last word; if it hangs on its way out, nobody waits for it.
        process.kill()
        process.join(END_WITHIN_S)
        process.close()
        self._end(watched, told if told is not None else _crashed(f"ended {ended}"))

    def _listen(
        self, watched: _Watched, process: ForkServerProcess, ours: Connection
    ) -> Result | Problem | None:
        """The last word of the process; None if it ended without one."""
        while True:
            wait([ours, process.sentinel])
            if not ours.poll():
                return None
            try:
                told = ours.recv()
            except (EOFError, OSError):
                return None
            if not isinstance(told, Progress):
                return told if isinstance(told, Result | Problem) else None
            with self._lock:
                ratio = min(1.0, max(watched.job.progress_ratio, told.ratio))
                watched.job = replace(watched.job, progress_ratio=ratio, doing=told.doing)

    def _end(self, watched: _Watched, told: Result | Problem) -> None:
        with self._lock:
            if watched.job.state.is_over:
                return
            if isinstance(told, Result):
                watched.job = replace(watched.job, state=JobState.CONCLUDING)
        if isinstance(told, Result):
            told = self._concluded(watched, told)
        with self._lock:
            if isinstance(told, Result):
                watched.job = replace(
                    watched.job, state=JobState.DONE, progress_ratio=1.0, doing="", result=told.value
                )
            else:
                watched.job = replace(watched.job, state=JobState.FAILED, doing="", problem=told)
        log.info("job over", job=watched.job.id, state=watched.job.state.value)

    def _concluded(self, watched: _Watched, result: Result) -> Result | Problem:
        try:
            return (
                result if watched.conclude is None else Result(value=as_told(watched.conclude(result.value)))
            )
        except NavigationError as error:
            return Problem.from_error(error)
        except Exception:
            log.exception("the result of a job could not be kept", job=watched.job.id)
            return _crashed("gave a result that could not be kept")

    def _find(self, job_id: str) -> _Watched:
        if job_id not in self._watched:
            raise JobUnknown(
                "JOB_UNKNOWN",
                f"there is no job {job_id[:40]}",
                "Start it again; the server forgets jobs when it is started anew.",
                {"job_id": job_id[:40]},
            )
        return self._watched[job_id]

    def _forget_old(self) -> None:
        over = [job_id for job_id, watched in self._watched.items() if watched.job.state.is_over]
        for job_id in over[: max(0, len(over) - REMEMBERED + 1)]:
            del self._watched[job_id]


def _crashed(how: str) -> Problem:
    return Problem(
        code="JOB_ENDED",
        message=f"the process that did the work {how}",
        remedy="Start it again. If it ends by SIGKILL each time, the machine has too little memory for it.",
    )
