"""Background jobs: progress, result and cancellation."""

from fastapi import APIRouter

from server.api.errors import rejections
from server.jobs import Job, Jobs, JobState
from server.stream.messages import Message, ProblemMessage, problem_message


class JobMessage(Message):
    """State of a background job."""

    id: str
    title: str
    state: JobState
    """done, failed and cancelled are final; a job that is concluding cannot be cancelled."""
    progress_ratio: float
    """0 to 1, never decreasing."""
    doing: str
    """The present activity."""
    result: object
    """The result; null until the job is done."""
    problem: ProblemMessage | None
    """Why it failed; null otherwise."""


class JobsMessage(Message):
    """All remembered jobs, newest first."""

    jobs: list[JobMessage]


def job_message(job: Job) -> JobMessage:
    """Return the message of a job."""
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
    """Return the router of `/api/jobs`. Its routes are synchronous because they may wait for a process."""
    router = APIRouter(prefix="/api/jobs", tags=["jobs"])

    @router.get("")
    def all_jobs() -> JobsMessage:
        """Return all remembered jobs, newest first."""
        return JobsMessage(jobs=[job_message(job) for job in jobs.list()])

    @router.get("/{job_id}", responses=rejections(404))
    def job(job_id: str) -> JobMessage:
        """Return the progress and the result of a job."""
        return job_message(jobs.get(job_id))

    @router.delete("/{job_id}", responses=rejections(404))
    def cancel(job_id: str) -> JobMessage:
        """Cancel a job. A finished job, or one whose result is being stored, is not changed."""
        return job_message(jobs.cancel(job_id))

    return router
