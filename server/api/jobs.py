"""Long work: how far it is, what came out, and its end."""

from fastapi import APIRouter

from server.api.errors import rejections
from server.jobs import Job, Jobs, JobState
from server.stream.messages import Message, ProblemMessage, problem_message


class JobMessage(Message):
    """Long work at one moment."""

    id: str
    title: str
    state: JobState
    """done, failed and cancelled are ends; concluding is too late to cancel."""
    progress_ratio: float
    """0 to 1; never goes back."""
    doing: str
    """What is done just now, in words."""
    result: object
    """What came out; null until it is done."""
    problem: ProblemMessage | None
    """Why it failed; null if it did not."""


class JobsMessage(Message):
    """All jobs that are remembered, the newest first."""

    jobs: list[JobMessage]


def job_message(job: Job) -> JobMessage:
    """A job, as it is told."""
    return JobMessage(
        id=job.id,
        title=job.title,
        state=job.state,
        progress_ratio=job.progress_ratio,
        doing=job.doing,
        result=job.result,
        problem=problem_message(job.problem),
    )


def jobs_router(jobs: Jobs) -> APIRouter:
    """Everything under `/api/jobs`. Plain functions: they may wait for a process that is being started."""
    router = APIRouter(prefix="/api/jobs", tags=["jobs"])

    @router.get("")
    def all_jobs() -> JobsMessage:
        """All jobs that are remembered, the newest first."""
        return JobsMessage(jobs=[job_message(job) for job in jobs.list()])

    @router.get("/{job_id}", responses=rejections(404))
    def job(job_id: str) -> JobMessage:
        """How far a job is, and what came out of it."""
        return job_message(jobs.get(job_id))

    @router.delete("/{job_id}", responses=rejections(404))
    def cancel(job_id: str) -> JobMessage:
        """Cancel a job. One that is over, or whose result is just being kept, stays as it is."""
        return job_message(jobs.cancel(job_id))

    return router
