"""Records of background jobs."""

from dataclasses import dataclass
from enum import StrEnum

from server.live import Problem


class JobQueue(StrEnum):
    """Jobs wait for those of their own queue only."""

    PROCEDURE = "procedure"  # somebody waits for them in theatre
    RECORDINGS = "recordings"  # a video of an hour takes longer than that hour


class JobState(StrEnum):
    """State of a job."""

    WAITING = "waiting"  # in the queue
    RUNNING = "running"
    CONCLUDING = "concluding"  # its result is being stored; too late to cancel
    DONE = "done"
    FAILED = "failed"
    CANCELLED = "cancelled"

    @property
    def is_finished(self) -> bool:
        """Whether the state is final."""
        return self in (JobState.DONE, JobState.FAILED, JobState.CANCELLED)


@dataclass(frozen=True, slots=True, kw_only=True)
class Job:
    """Snapshot of a job.

    Attributes:
        id: 16 hexadecimal digits.
        title: description of the job.
        state: its state.
        progress_ratio: progress, 0 to 1; never decreases.
        doing: description of the current activity.
        result: JSON-serialisable result, when it is done.
        problem: why it failed.
    """

    id: str
    title: str
    state: JobState = JobState.WAITING
    progress_ratio: float = 0.0
    doing: str = ""
    result: object = None
    problem: Problem | None = None
