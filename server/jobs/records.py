"""What is told of long work."""

from dataclasses import dataclass
from enum import StrEnum

from server.live import Problem


class JobState(StrEnum):
    """How far long work is."""

    WAITING = "waiting"  # for its turn
    RUNNING = "running"
    CONCLUDING = "concluding"  # its result is being kept; too late to cancel
    DONE = "done"
    FAILED = "failed"
    CANCELLED = "cancelled"

    @property
    def is_over(self) -> bool:
        """Whether nothing changes any more."""
        return self in (JobState.DONE, JobState.FAILED, JobState.CANCELLED)


@dataclass(frozen=True, slots=True, kw_only=True)
class Job:
    """Long work at one moment.

    Attributes:
        id: 16 hexadecimal digits.
        title: what is done, in words.
        state: how far it is.
        progress_ratio: how much is done, 0 to 1; never goes back.
        doing: what is done just now, in words.
        result: what came out, as JSON has it, once it is done.
        trouble: why it failed, if it did.
    """

    id: str
    title: str
    state: JobState = JobState.WAITING
    progress_ratio: float = 0.0
    doing: str = ""
    result: object = None
    problem: Problem | None = None
