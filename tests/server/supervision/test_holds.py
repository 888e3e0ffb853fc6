"""Who asks to hold: over a start of the server, whatever case is open, and whatever the disk says."""

import json
import os
from collections.abc import Callable, Iterator
from datetime import UTC, datetime
from pathlib import Path
from typing import Any

import pytest
from fastapi.testclient import TestClient

from server.alarms import AlarmDesk
from server.app import AppParts, create_app
from server.config import Config
from server.errors import SetupOrderError
from server.live import LiveHub
from server.store import CaseStore, Home, StoreError
from server.supervision import Holds, HoldsFile
from server.supervision.asked import HOLDS_FILE, SOMEBODY
from tests.server.supervision.persons import ITO, KIM, SATO, sign_people_in

ROOM = "/api/supervision/room"


def alarms_of(desk: AlarmDesk) -> list[tuple[str, str]]:
    return [(one.condition.value, one.by) for one in desk.picture.alarms]


@pytest.fixture
def start(tmp_path: Path) -> Callable[..., tuple[Holds, AlarmDesk]]:
    """A start of the server: nothing is left of the one before but what lies on the disk."""

    def started(at: str = "2026-11-21T14:03:00.000Z") -> tuple[Holds, AlarmDesk]:
        desk = AlarmDesk(Config())
        return Holds(desk, kept=HoldsFile(tmp_path), clock=lambda: datetime.fromisoformat(at)), desk

    return started


def test_a_hold_stands_after_a_start_with_who_asked_and_when(start: Callable[..., Any]) -> None:
    holds, _ = start()
    holds.ask(SATO)
    holds, desk = start("2026-11-21T15:00:00.000Z")
    assert [(one.name, one.at) for one in holds.asking] == [("Dr Sato", "2026-11-21T14:03:00.000Z")]
    assert alarms_of(desk) == [("HOLD_ASKED", "Dr Sato")]
    # Who asks once more asks since the first time.
    holds.ask(SATO)
    holds.ask(KIM)
    holds, desk = start()
    assert [(one.name, one.at[11:16]) for one in holds.asking] == [("Dr Sato", "14:03"), ("Dr Kim", "15:00")]
    assert alarms_of(desk) == [("HOLD_ASKED", "Dr Sato, Dr Kim")]


def test_after_a_start_it_is_released_by_who_asked_or_by_the_operator_and_nobody_else(
    start: Callable[..., Any],
) -> None:
    start()[0].ask(SATO)
    with pytest.raises(SetupOrderError, match="asked for by Dr Sato, not by Dr Kim"):
        start()[0].release(KIM)
    start()[0].release(SATO)
    holds, desk = start()
    assert (holds.asking, alarms_of(desk)) == ((), [])
    holds.ask(SATO)
    holds.ask(KIM)
    start()[0].release(ITO)
    holds, desk = start()
    assert (holds.asking, alarms_of(desk)) == ((), [])


def test_theatre_hears_of_a_hold_that_cannot_be_kept_and_who_asked_is_told(tmp_path: Path) -> None:
    class FullDisk(HoldsFile):
        def write(self, asking: object) -> None:
            del asking
            raise StoreError("STORE_FULL", "there is no room", "Make room.")

    desk, told = AlarmDesk(Config()), []
    holds = Holds(desk, kept=FullDisk(tmp_path))
    holds.tell = lambda: told.append(len(holds.asking))
    with pytest.raises(StoreError):
        holds.ask(SATO)
    assert alarms_of(desk) == [("HOLD_ASKED", "Dr Sato")]
    with pytest.raises(StoreError):
        holds.release(SATO)
    assert alarms_of(desk) == []
    assert told == [1, 0]


def test_it_is_on_the_disk_for_its_owner_alone_before_it_is_confirmed(
    tmp_path: Path, start: Callable[..., Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    synced: list[int] = []
    real = os.fsync

    def noted(number: int) -> None:
        synced.append(number)
        real(number)

    monkeypatch.setattr(os, "fsync", noted)
    start()[0].ask(SATO)
    # The file, and the folder that has its name.
    assert len(synced) == 2
    assert (tmp_path / HOLDS_FILE).stat().st_mode & 0o777 == 0o600


@pytest.mark.parametrize("content", [b"", b"{", b'{"form": 2}', b'{"form": 1, "asking": [{"id": "s1"}]}'])
def test_of_a_damaged_file_a_hold_stands_that_the_operator_lifts(
    tmp_path: Path, start: Callable[..., Any], content: bytes
) -> None:
    (tmp_path / HOLDS_FILE).write_bytes(content)
    holds, desk = start()
    assert alarms_of(desk) == [("HOLD_ASKED", SOMEBODY)]
    with pytest.raises(SetupOrderError):
        holds.release(SATO)
    holds.release(ITO)
    assert json.loads((tmp_path / HOLDS_FILE).read_bytes()) == {"form": 1, "asking": []}


@pytest.fixture
def served(tmp_path: Path) -> Iterator[Callable[[], TestClient]]:
    """The application on one home, as often as it is started."""
    with Home(tmp_path / "home") as home, CaseStore(home) as store:

        def client() -> TestClient:
            app = create_app(AppParts(hub=LiveHub(), config=Config(), store=store))
            sign_people_in(app)
            return TestClient(app, base_url="http://127.0.0.1:8000")

        yield client


def test_the_room_tells_it_after_a_start_whichever_case_is_open(served: Callable[[], TestClient]) -> None:
    first = served()
    asked = first.post("/api/alarms/hold", json={}, headers={"x-person": "s1"})
    assert asked.status_code == 200
    case = first.post("/api/cases", json={"name": "another case"}).json()
    assert first.post(f"/api/cases/{case['id']}/open").status_code == 200
    second = served()
    told = second.get(ROOM, headers={"x-person": "s1"}).json()["hold"]
    age_s = (datetime.now(UTC) - datetime.fromisoformat(told.pop("since"))).total_seconds()
    assert 0 <= age_s < 300
    assert told == {"asked_by": ["Dr Sato"], "is_yours": True}
    assert [one["by"] for one in second.get("/api/alarms").json()["alarms"]] == ["Dr Sato"]
    assert second.post("/api/alarms/release", json={}, headers={"x-person": "s1"}).json()["alarms"] == []
    assert served().get(ROOM).json()["hold"] == {"asked_by": [], "since": None, "is_yours": False}
