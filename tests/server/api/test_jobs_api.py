"""Jobs over HTTP."""

from collections.abc import Iterator

import pytest
from fastapi.testclient import TestClient

from server.app import AppParts, create_app
from server.config import Config
from server.jobs import Jobs
from server.live import LiveHub
from server.logs import LogSettings
from tests.server.jobs import job_functions


@pytest.fixture
def jobs() -> Iterator[Jobs]:
    jobs = Jobs(log=LogSettings(as_json=True))
    yield jobs
    jobs.close()


def test_jobs_are_reported_whole(jobs: Jobs) -> None:
    app = create_app(AppParts(hub=LiveHub(), config=Config(), jobs=jobs))
    door = TestClient(app, base_url="http://127.0.0.1:8000")
    assert door.get("/api/jobs").json() == {"jobs": []}
    good = jobs.wait_for(jobs.start("adding", job_functions.add, {"a": 1, "b": 2}).id)
    bad = jobs.wait_for(jobs.start("reading", job_functions.reject, {"slices": 1}).id)
    reported = {
        "id": good.id,
        "title": "adding",
        "state": "done",
        "progress_ratio": 1.0,
        "doing": "",
        "result": {"sum": 3},
        "problem": None,
    }
    assert door.get(f"/api/jobs/{good.id}").json() == reported
    assert [one["id"] for one in door.get("/api/jobs").json()["jobs"]] == [bad.id, good.id]
    assert door.get(f"/api/jobs/{bad.id}").json()["problem"] == {
        "code": "TOO_FEW_SLICES",
        "message": "1 slices found",
        "remedy": "Take more.",
        "context": {"slices": 1},
        "language": "en",
    }
    assert door.delete(f"/api/jobs/{good.id}").json() == reported
    missing = door.delete("/api/jobs/nothing")
    assert (missing.status_code, missing.json()["code"]) == (404, "JOB_UNKNOWN")
