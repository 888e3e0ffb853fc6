"""Jobs in their own processes: progress, result, failure, cancelling, killed processes."""

import os
import shutil
import threading
from collections.abc import Iterator
from pathlib import Path

import pytest

from server.jobs import Job, JobQueue, Jobs, JobState, JobUnknown
from server.logs import LogSettings
from tests.server.jobs import job_functions
from tracker.errors import InvalidInput

LOG = LogSettings(as_json=True)


@pytest.fixture
def jobs() -> Iterator[Jobs]:
    jobs = Jobs(log=LOG)
    yield jobs
    jobs.close()


@pytest.fixture
def folder(tmp_path: Path) -> Path:
    folder = tmp_path / "job"
    folder.mkdir()
    return folder


def until_running(jobs: Jobs, job: Job, folder: Path) -> None:
    """Wait for the job's first file, which shows that it has started."""
    waiting = threading.Event()
    while not (folder / "half").exists() or not jobs.get(job.id).doing:
        assert not waiting.wait(0.01)
        assert not jobs.get(job.id).state.is_finished


def test_work_is_done_elsewhere_and_its_result_reported(jobs: Jobs) -> None:
    job = jobs.start("adding", job_functions.add, {"a": 2, "b": 3})
    assert (job.state, job.progress_ratio, job.result) == (JobState.WAITING, 0.0, None)
    done = jobs.wait_for(job.id)
    assert done == Job(id=job.id, title="adding", state=JobState.DONE, progress_ratio=1.0, result={"sum": 5})
    assert jobs.list() == (done,)


def test_work_is_polite_and_in_another_process(jobs: Jobs) -> None:
    job = jobs.wait_for(jobs.start("looking", job_functions.go_back).id)
    assert isinstance(job.result, list)
    politeness, pid = job.result
    # Linux has no lower priority than 19.
    assert politeness == min(10 + os.nice(0), 19)
    assert pid != os.getpid()


def test_the_result_is_kept_before_the_job_is_done(jobs: Jobs) -> None:
    seen: list[object] = []

    def keep(result: object) -> object:
        seen.append((result, jobs.list()[0].state))
        return {"document": "id"}

    done = jobs.wait_for(jobs.start("adding", job_functions.add, {"a": 1, "b": 1}, conclude=keep).id)
    assert seen == [({"sum": 2}, JobState.CONCLUDING)]
    assert (done.state, done.result) == (JobState.DONE, {"document": "id"})


def test_what_cannot_be_kept_has_failed(jobs: Jobs) -> None:
    def keep(result: object) -> object:
        raise InvalidInput("NO", f"{result} is not wanted", "Go away.")

    failed = jobs.wait_for(jobs.start("adding", job_functions.add, {"a": 1, "b": 1}, conclude=keep).id)
    assert failed.state is JobState.FAILED
    assert failed.problem is not None
    assert failed.problem.code == "NO"
    assert failed.result is None


def test_an_error_keeps_its_words(jobs: Jobs) -> None:
    failed = jobs.wait_for(jobs.start("reading", job_functions.reject, {"slices": 1}).id)
    assert failed.state is JobState.FAILED
    problem = failed.problem
    assert problem is not None
    assert (problem.code, problem.message, problem.remedy, problem.context) == (
        "TOO_FEW_SLICES",
        "1 slices found",
        "Take more.",
        {"slices": 1},
    )


@pytest.mark.parametrize("work", [job_functions.blunder, job_functions.say_nothing_sensible])
def test_a_mistake_of_the_program_tells_a_stranger_nothing(jobs: Jobs, work: object) -> None:
    failed = jobs.wait_for(jobs.start("reading", work).id)  # pyrefly: ignore[bad-argument-type]  # either of two
    assert failed.problem is not None
    assert failed.problem.code == "JOB_FAILED"
    assert "Zaphod" not in str(failed)


def test_a_violent_end_is_reported_and_leaves_nothing_behind(jobs: Jobs, folder: Path) -> None:
    killed = jobs.wait_for(jobs.start("dying", job_functions.die, {"folder": str(folder)}, folder=folder).id)
    assert killed.state is JobState.FAILED
    assert killed.problem is not None
    assert killed.problem.message == "the process of the job ended by signal 9 (SIGKILL)"
    assert not folder.exists()
    left = jobs.wait_for(jobs.start("leaving", job_functions.leave).id)
    assert left.problem is not None
    assert left.problem.message == "the process of the job ended with status 3"


def test_cancelled_work_ends_at_once_and_leaves_nothing_behind(jobs: Jobs, folder: Path) -> None:
    concluded: list[object] = []
    work = {"folder": str(folder)}
    job = jobs.start("waiting", job_functions.never_end, work, folder=folder, conclude=concluded.append)
    until_running(jobs, job, folder)
    assert (jobs.get(job.id).progress_ratio, jobs.get(job.id).doing) == (0.25, "waiting")
    queued = jobs.start("adding", job_functions.add, {"a": 1, "b": 1})
    dropped = jobs.start("adding", job_functions.add, {"a": 1, "b": 1})
    assert jobs.cancel(dropped.id).state is JobState.CANCELLED
    assert jobs.get(queued.id).state is JobState.WAITING
    assert jobs.cancel(job.id).state is JobState.CANCELLED
    assert jobs.wait_for(queued.id).state is JobState.DONE
    assert jobs.wait_for(job.id).state is JobState.CANCELLED
    assert jobs.wait_for(dropped.id).state is JobState.CANCELLED
    assert not folder.exists()
    assert concluded == []


def test_a_video_does_not_hold_up_the_procedure(jobs: Jobs, folder: Path) -> None:
    video = jobs.start(
        "video", job_functions.never_end, {"folder": str(folder)}, folder=folder, queue=JobQueue.RECORDINGS
    )
    until_running(jobs, video, folder)
    step = jobs.start("adding", job_functions.add, {"a": 1, "b": 1})
    assert jobs.wait_for(step.id).state is JobState.DONE
    assert jobs.cancel(video.id).state is JobState.CANCELLED


def test_what_is_over_is_not_cancelled(jobs: Jobs) -> None:
    done = jobs.wait_for(jobs.start("adding", job_functions.add, {"a": 1, "b": 1}).id)
    assert jobs.cancel(done.id) == done


def test_closing_ends_everything(folder: Path) -> None:
    jobs = Jobs(log=LOG)
    job = jobs.start("waiting", job_functions.never_end, {"folder": str(folder)}, folder=folder)
    until_running(jobs, job, folder)
    jobs.close()
    assert jobs.get(job.id).state is JobState.CANCELLED
    assert not folder.exists()
    late = jobs.start("adding", job_functions.add, {"a": 1, "b": 1})
    assert jobs.wait_for(late.id).state is not JobState.DONE


def test_an_unknown_job_is_reported(jobs: Jobs) -> None:
    for ask in (jobs.get, jobs.cancel):
        with pytest.raises(JobUnknown, match="there is no job nothing"):
            ask("nothing")


def test_a_disk_that_becomes_full_is_reported_with_what_is_free(jobs: Jobs, folder: Path) -> None:
    job = jobs.wait_for(
        jobs.start("filling", job_functions.fill_the_disk, {"folder": str(folder)}, folder=folder).id
    )
    assert job.problem is not None
    assert job.problem.code == "STORE_FULL"
    assert "MB are free" in job.problem.message
    assert job.problem.context["free_bytes"] == pytest.approx(shutil.disk_usage(folder.parent).free, rel=0.05)
    assert not folder.exists()
