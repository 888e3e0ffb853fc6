"""Complete answers of the application."""

import time
from collections.abc import Callable

import pytest
from fastapi import FastAPI
from fastapi.testclient import TestClient

from server.api.health import health_message
from server.live import Instant, LiveHub, Problem, ProcessState, ProcessStatus, SourceState, SourceStatus
from tracker.errors import CalibrationError, InvalidInput
from tracker.navigation import NavigationSnapshot

SnapshotOf = Callable[..., NavigationSnapshot]
InstantOf = Callable[..., Instant]
PROBLEM = Problem(code="CAMERA_GONE", message="camera 0 gives no image", remedy="Plug it in.")


def app_of(client: TestClient) -> FastAPI:
    assert isinstance(client.app, FastAPI)
    return client.app


def test_there_is_nothing_to_tell_before_the_first_instant(client: TestClient) -> None:
    answer = client.get("/api/live")
    assert answer.status_code == 503
    assert answer.json() == {
        "code": "NOTHING_YET",
        "message": "the tracking process has sent no message since the server started",
        "remedy": "Try again in a second; if the error persists, check /health and the server log.",
        "context": {},
        "language": "en",
    }


def test_the_newest_instant_is_reported(
    client: TestClient, hub: LiveHub, snapshot_of: SnapshotOf, instant_of: InstantOf
) -> None:
    hub.publish(instant_of(6))
    snapshot = snapshot_of(image_number=41, captured_at_s=time.monotonic())
    hub.publish(instant_of(7, snapshot=snapshot))
    reported = client.get("/api/live").json()
    assert reported["sequence"] == 7
    assert reported["snapshot"]["image_number"] == 41
    assert reported["image_age_ms"] >= 0.0
    assert reported["snapshot"]["tools"][0]["deviation"]["kind"] == "deviation"


def test_the_page_receives_names_limits_and_addresses(client: TestClient) -> None:
    reported = client.get("/api/dashboard").json()
    assert reported["product"] == "Coaxial"
    assert reported["notice"] == "research software, not a medical device"
    assert reported["cameras"] == [
        {"name": "main", "video_path": "/video/main.mjpg", "view_path": "/ws/view?camera=main"}
    ]
    assert reported["limits"] == {
        "pose_stale_after_ms": 150.0,
        "video_stale_after_ms": 500.0,
        "scene_stale_after_ms": 500.0,
    }


@pytest.mark.parametrize(
    ("method", "path", "status", "code"),
    [
        ("GET", "/nothing/here", 404, "NOT_FOUND"),
        ("GET", "/api/nothing", 404, "NOT_FOUND"),
        ("POST", "/api/live", 405, "METHOD_NOT_ALLOWED"),
        ("GET", "/video/side.mjpg", 404, "CAMERA_UNKNOWN"),
    ],
)
def test_every_rejection_has_the_one_shape(
    client: TestClient, method: str, path: str, status: int, code: str
) -> None:
    answer = client.request(method, path)
    assert answer.status_code == status
    assert set(answer.json()) == {"code", "message", "remedy", "context", "language"}
    assert answer.json()["code"] == code


def test_the_error_for_an_unknown_camera_lists_the_known_ones(client: TestClient) -> None:
    reported = client.get("/video/side.mjpg").json()
    assert reported["message"] == "there is no camera 'side', only main"
    assert reported["context"] == {"requested": "side", "known": ["main"], "cameras": "main"}


def test_errors_of_the_tracker_keep_their_words(client: TestClient) -> None:
    @app_of(client).get("/api/trial")
    async def trial(count: int) -> None:
        if count:
            raise CalibrationError("TOO_FEW", f"{count} dots found", "Hold it still.", {"dots": count})
        raise InvalidInput("NO_DOTS", "no dots found", "Look again.")

    app_of(client).router.routes.insert(0, app_of(client).router.routes.pop())
    assert client.get("/api/trial?count=0").status_code == 422
    answer = client.get("/api/trial?count=3")
    assert answer.status_code == 409
    assert answer.json() == {
        "code": "TOO_FEW",
        "message": "3 dots found",
        "remedy": "Hold it still.",
        "context": {"dots": 3},
        "language": "en",
    }
    wrong = client.get("/api/trial?count=x")
    assert wrong.status_code == 422
    assert wrong.json()["code"] == "REQUEST_INVALID"
    assert wrong.json()["context"]["problems"][0]["where"] == "query.count"


def test_a_mistake_of_the_server_tells_a_stranger_nothing(client: TestClient) -> None:
    @app_of(client).get("/api/broken")
    async def broken() -> None:
        raise RuntimeError("the password is 1234")

    app_of(client).router.routes.insert(0, app_of(client).router.routes.pop())
    answer = client.get("/api/broken")
    assert answer.status_code == 500
    assert answer.json()["code"] == "INTERNAL"
    assert "1234" not in answer.text


@pytest.mark.parametrize("path", ["/health", "/api/docs", "/", "/nothing", "/metrics"])
def test_every_answer_forbids_what_is_not_from_here(client: TestClient, path: str) -> None:
    headers = client.get(path).headers
    policy = dict(part.split(" ", 1) for part in headers["content-security-policy"].split("; "))
    assert policy["script-src"] == "'self'"
    assert policy["frame-ancestors"] == "'self'"
    assert policy["connect-src"] == "'self' ws://127.0.0.1:8000 wss://127.0.0.1:8000"
    assert headers["x-content-type-options"] == "nosniff"
    assert headers["cache-control"]


def test_a_strange_name_in_the_host_is_rejected(client: TestClient) -> None:
    answer = client.get("/health", headers={"Host": "evil.example"})
    assert answer.status_code == 421
    assert answer.json()["code"] == "HOST_UNKNOWN"


def test_a_strange_page_cannot_change_anything(client: TestClient) -> None:
    answer = client.post("/api/live", headers={"Origin": "http://evil.example"})
    assert answer.status_code == 403
    assert answer.json()["code"] == "ORIGIN_REJECTED"


def test_health_before_the_first_instant_is_degraded(client: TestClient) -> None:
    answer = client.get("/health")
    assert answer.status_code == 200
    assert answer.json() == {
        "status": "degraded",
        "process": None,
        "source": None,
        "image_age_ms": None,
        "sinks": [],
    }


@pytest.mark.parametrize(
    ("process", "source", "age_ms", "state"),
    [
        pytest.param(ProcessState.RUNNING, SourceState.RUNNING, 40.0, "ok", id="all-well"),
        pytest.param(ProcessState.RUNNING, SourceState.RUNNING, 501.0, "degraded", id="old-image"),
        pytest.param(ProcessState.RUNNING, SourceState.RUNNING, None, "degraded", id="no-image"),
        pytest.param(ProcessState.RUNNING, SourceState.RECONNECTING, 40.0, "degraded", id="camera-gone"),
        pytest.param(ProcessState.RUNNING, SourceState.ENDED, 40.0, "degraded", id="file-at-its-end"),
        pytest.param(ProcessState.RESTARTING, SourceState.RUNNING, None, "degraded", id="restarting"),
        pytest.param(ProcessState.GIVEN_UP, SourceState.RUNNING, None, "failed", id="given-up"),
    ],
)
def test_health_is_one_word(
    snapshot_of: SnapshotOf,
    instant_of: InstantOf,
    process: ProcessState,
    source: SourceState,
    age_ms: float | None,
    state: str,
) -> None:
    instant = instant_of(
        1,
        snapshot=None if age_ms is None else snapshot_of(captured_at_s=100.0 - age_ms / 1000.0),
        process=ProcessStatus(state=process),
        source=SourceStatus(name="0", state=source),
    )
    reported = health_message(instant, now_s=100.0, stale_after_ms=500.0)
    assert reported.status == state
    assert reported.image_age_ms == (None if age_ms is None else pytest.approx(age_ms))


@pytest.mark.parametrize(
    ("process", "status"),
    [
        pytest.param(ProcessState.RESTARTING, 200, id="is-being-mended"),
        pytest.param(ProcessState.GIVEN_UP, 503, id="needs-a-restart"),
    ],
)
def test_health_fails_only_when_a_restart_would_help(
    client: TestClient, hub: LiveHub, instant_of: InstantOf, process: ProcessState, status: int
) -> None:
    hub.publish(instant_of(1, process=ProcessStatus(state=process, problem=PROBLEM)))
    answer = client.get("/health")
    assert answer.status_code == status
    assert answer.json()["process"]["problem"]["code"] == "CAMERA_GONE"


def test_each_route_documents_what_it_answers(client: TestClient) -> None:
    document = client.get("/api/openapi.json").json()
    paths = document["paths"]
    watched = {
        "/video/{camera}.mjpg",
        "/api/live",
        "/api/dashboard",
        "/api/supervision/room",
        "/api/gates",
        "/health",
        "/metrics",
    }
    # Without a store there are no cases and no steps; alarms and the rehearsal need none.
    rooms = (
        "/api/alarms",
        "/api/rehearsal",
        "/api/session",
        "/api/people",
        "/api/audit",
        "/api/supervision/marks",
    )
    others = {path for path in paths if path.startswith(rooms)}
    assert set(paths) == watched | others
    for operation in [each for methods in paths.values() for each in methods.values()]:
        answers = set(operation["responses"])
        assert {"401", "403", "413", "421", "429", "500"} <= answers
        assert answers & {"200", "201", "204"}
    assert "LiveMessage" in document["components"]["schemas"]
    rejected = [
        (path, status, answer)
        for path, methods in paths.items()
        for operation in methods.values()
        for status, answer in operation["responses"].items()
        if status not in {"200", "201", "204", "401", "403", "413", "421", "429", "500"} and path != "/health"
    ]
    assert {(path, status) for path, status, _ in rejected if path in watched} == {
        ("/video/{camera}.mjpg", "404"),
        ("/video/{camera}.mjpg", "422"),
        ("/video/{camera}.mjpg", "503"),
        ("/api/live", "503"),
    }
    for _, _, answer in rejected:
        assert answer["content"]["application/json"]["schema"]["$ref"].endswith("/ProblemMessage")


def test_the_documentation_needs_no_other_server_and_no_script(client: TestClient) -> None:
    page = client.get("/api/docs")
    assert page.headers["content-type"].startswith("text/html")
    assert "<script" not in page.text
    assert "://" not in page.text
    for words in ("/api/live", "/video/{camera}.mjpg", "/ws/view", "LiveMessage", "entry_offset_mm"):
        assert words in page.text
