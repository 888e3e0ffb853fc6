"""`/api/recordings`: the whole answers."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import pytest
from fastapi.testclient import TestClient

from server.app import AppParts, create_app
from server.config import Config
from server.live import LiveHub
from server.store import CaseStore, Home
from tests.server.recording.no_recorder import recordings_without_process

NOTHING = {
    "when": "manual",
    "consent": {"state": "not_required", "answered_at": None, "answered_by": None},
    "is_recording": False,
    "name": None,
    "duration_s": 0.0,
    "size_bytes": 0,
    "images": 0,
    "missing_images": 0,
    "remaining_s": None,
    "problem": None,
}


class Door:
    """The HTTP door of a server with one case."""

    def __init__(self, client: TestClient, store: CaseStore) -> None:
        self.client, self.store = client, store

    def ask(self, method: str, path: str, status: int, body: object = None) -> dict[str, Any]:
        answer = self.client.request(method, f"/api/recordings{path}", json=body)
        assert answer.status_code == status, answer.text
        return {} if status == 204 else dict(answer.json())

    def open_a_case(self) -> None:
        self.store.open(self.store.create("L4").id)


@pytest.fixture
def door(request: pytest.FixtureRequest, tmp_path: Path) -> Iterator[Door]:
    consent = getattr(request, "param", "not_required")
    with Home(tmp_path / "home") as home, CaseStore(home) as store:
        config = Config.model_validate({"recording": {"min_free_gb": 0.0, "consent": consent}})
        recordings = recordings_without_process(store, config)
        app = create_app(AppParts(hub=LiveHub(), config=config, store=store, recordings=recordings))
        with TestClient(app, base_url="http://127.0.0.1:8000") as client:
            yield Door(client, store)


def test_without_an_open_case_nothing_is_recorded(door: Door) -> None:
    assert door.ask("GET", "/state", 200) == NOTHING
    assert door.ask("POST", "/start", 409)["code"] == "NO_CASE_OPEN"
    assert door.ask("GET", "", 409)["code"] == "NO_CASE_OPEN"


def test_a_recording_is_started_listed_stopped_downloaded_and_deleted(door: Door) -> None:
    door.open_a_case()
    started = door.ask("POST", "/start", 200)
    name = started["name"]
    assert started == {
        **NOTHING,
        "is_recording": True,
        "name": name,
        "size_bytes": 1000,
        "images": 3,
        "duration_s": started["duration_s"],
    }
    assert door.ask("GET", "", 200) == {
        "recordings": [{"name": name, "size_bytes": 8, "is_protected": False, "is_running": True}]
    }
    assert door.ask("DELETE", f"/{name}", 409)["code"] == "RECORDING_RUNS"
    assert door.ask("POST", "/stop", 200) == {**NOTHING, "size_bytes": 1000, "images": 3}
    answer = door.client.get(f"/api/recordings/{name}/file")
    assert answer.content == b"recorded"
    assert name in answer.headers["content-disposition"]
    assert door.ask("PUT", f"/{name}/protection", 200, {"is_protected": True}) == {"is_protected": True}
    assert door.ask("DELETE", f"/{name}", 409)["code"] == "RECORDING_PROTECTED"
    door.ask("PUT", f"/{name}/protection", 200, {"is_protected": False})
    door.ask("DELETE", f"/{name}", 204)
    assert door.ask("DELETE", f"/{name}", 404)["code"] == "RECORDING_UNKNOWN"
    assert door.ask("GET", "", 200) == {"recordings": []}


def test_a_disk_that_is_too_full_answers_with_507(door: Door, monkeypatch: pytest.MonkeyPatch) -> None:
    door.open_a_case()
    monkeypatch.setattr(Home, "free_bytes", lambda _: -1)
    assert door.ask("POST", "/start", 507)["code"] == "RECORDING_DISK_FULL"


@pytest.mark.parametrize("door", ["required"], indirect=True)
def test_consent_is_answered_before_the_first_recording_of_a_case(door: Door) -> None:
    door.open_a_case()
    rejected = door.ask("POST", "/start", 409)
    assert rejected["code"] == "RECORDING_CONSENT_MISSING"
    assert rejected["remedy"]
    case = door.store.get_open_case()
    assert case is not None
    answer = {"case_id": case.id, "is_given": True}
    stored = door.ask("POST", "/consent", 200, answer)
    assert stored == {"state": "given", "answered_at": stored["answered_at"], "answered_by": "this computer"}
    assert door.ask("POST", "/start", 200)["consent"] == stored
    refused = door.ask("POST", "/consent", 200, {**answer, "is_given": False})
    assert refused["state"] == "not_given"
    assert not door.ask("GET", "/state", 200)["is_recording"]
    assert door.ask("POST", "/consent", 409, {**answer, "case_id": "0" * 16})["code"] == "CASE_NOT_OPEN"
