"""Hold requests survive a restart, with any open case, and with any disk error."""

import json
import os
from collections.abc import Callable, Iterator
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import pytest
from fastapi.testclient import TestClient

from server.alarms import AlarmService
from server.app import AppParts, create_app
from server.config import Config
from server.errors import SetupOrderError
from server.live import LiveHub
from server.store import CaseStore, Home, StoreError
from server.supervision import HoldRequestFile, HoldRequests
from server.supervision.hold_storage import HOLDS_FILE, UNKNOWN_NAME
from tests.server.supervision.signed_in_people import ITO, KIM, SATO, sign_people_in

ROOM = "/api/supervision/room"


def alarms_of(service: AlarmService) -> list[tuple[str, str]]:
    return [(one.condition.value, one.by) for one in service.picture.alarms]


@pytest.fixture
def start(tmp_path: Path) -> Callable[..., tuple[HoldRequests, AlarmService]]:
    """A start of the server: only what is on disk survives from the previous one."""

    def started(at: str = "2026-11-21T14:03:00.000Z") -> tuple[HoldRequests, AlarmService]:
        service = AlarmService(Config())
        return HoldRequests(
            service, storage=HoldRequestFile(tmp_path), clock=lambda: datetime.fromisoformat(at)
        ), service

    return started


def test_a_hold_survives_a_restart_with_its_requester_and_time(start: Callable[..., Any]) -> None:
    holds, _ = start()
    holds.request(SATO)
    holds, service = start("2026-11-21T15:00:00.000Z")
    assert [(one.name, one.at) for one in holds.requests] == [("Dr Sato", "2026-11-21T14:03:00.000Z")]
    assert alarms_of(service) == [("HOLD_REQUESTED", "Dr Sato")]
    # Repeated requests keep the time of the first.
    holds.request(SATO)
    holds.request(KIM)
    holds, service = start()
    assert [(one.name, one.at[11:16]) for one in holds.requests] == [
        ("Dr Sato", "14:03"),
        ("Dr Kim", "15:00"),
    ]
    assert alarms_of(service) == [("HOLD_REQUESTED", "Dr Sato, Dr Kim")]


def test_after_a_restart_only_its_requester_or_the_operator_releases_it(
    start: Callable[..., Any],
) -> None:
    start()[0].request(SATO)
    with pytest.raises(SetupOrderError, match="requested by Dr Sato, not by Dr Kim"):
        start()[0].release(KIM)
    start()[0].release(SATO)
    holds, service = start()
    assert (holds.requests, alarms_of(service)) == ((), [])
    holds.request(SATO)
    holds.request(KIM)
    start()[0].release(ITO)
    holds, service = start()
    assert (holds.requests, alarms_of(service)) == ((), [])


def test_a_hold_that_cannot_be_stored_is_shown_and_its_requester_is_informed(tmp_path: Path) -> None:
    class FullDisk(HoldRequestFile):
        def write(self, asking: object) -> None:
            del asking
            raise StoreError("STORE_FULL", "there is no room", "Make room.")

    service, reported = AlarmService(Config()), []
    holds = HoldRequests(service, storage=FullDisk(tmp_path))
    holds.on_change = lambda: reported.append(len(holds.requests))
    with pytest.raises(StoreError):
        holds.request(SATO)
    assert alarms_of(service) == [("HOLD_REQUESTED", "Dr Sato")]
    with pytest.raises(StoreError):
        holds.release(SATO)
    assert alarms_of(service) == []
    assert reported == [1, 0]


def test_it_is_on_the_disk_for_its_owner_alone_before_it_is_confirmed(
    tmp_path: Path, start: Callable[..., Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    synced: list[int] = []
    real = os.fsync

    def counted_fsync(number: int) -> None:
        synced.append(number)
        real(number)

    monkeypatch.setattr(os, "fsync", counted_fsync)
    start()[0].request(SATO)
    # The file, and the folder that contains its name.
    assert len(synced) == 2
    assert (tmp_path / HOLDS_FILE).stat().st_mode & 0o777 == 0o600


@pytest.mark.parametrize("content", [b"", b"{", b'{"form": 2}', b'{"form": 1, "asking": [{"id": "s1"}]}'])
def test_a_damaged_file_counts_as_a_hold_that_the_operator_can_release(
    tmp_path: Path, start: Callable[..., Any], content: bytes
) -> None:
    (tmp_path / HOLDS_FILE).write_bytes(content)
    holds, service = start()
    assert alarms_of(service) == [("HOLD_REQUESTED", UNKNOWN_NAME)]
    with pytest.raises(SetupOrderError):
        holds.release(SATO)
    holds.release(ITO)
    assert json.loads((tmp_path / HOLDS_FILE).read_bytes()) == {"form": 1, "asking": []}


@pytest.fixture
def served(tmp_path: Path) -> Iterator[Callable[[], TestClient]]:
    """The application in one home folder, for repeated starts."""
    with Home(tmp_path / "home") as home, CaseStore(home) as store:

        def client() -> TestClient:
            app = create_app(AppParts(hub=LiveHub(), config=Config(), store=store))
            sign_people_in(app)
            return TestClient(app, base_url="http://127.0.0.1:8000")

        yield client


def test_the_room_tells_it_after_a_start_whichever_case_is_open(served: Callable[[], TestClient]) -> None:
    first = served()
    requested = first.post("/api/alarms/hold", json={}, headers={"x-person": "s1"})
    assert requested.status_code == 200
    case = first.post("/api/cases", json={"name": "another case"}).json()
    assert first.post(f"/api/cases/{case['id']}/open").status_code == 200
    second = served()
    reported = second.get(ROOM, headers={"x-person": "s1"}).json()["hold"]
    age_s = (datetime.now(UTC) - datetime.fromisoformat(reported.pop("since"))).total_seconds()
    assert 0 <= age_s < 300
    assert reported == {"requested_by": ["Dr Sato"], "is_yours": True}
    assert [one["by"] for one in second.get("/api/alarms").json()["alarms"]] == ["Dr Sato"]
    assert second.post("/api/alarms/release", json={}, headers={"x-person": "s1"}).json()["alarms"] == []
    assert served().get(ROOM).json()["hold"] == {"requested_by": [], "since": None, "is_yours": False}
