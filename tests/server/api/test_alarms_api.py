"""Alarms over HTTP, and in every live message."""

import io
import wave
from collections.abc import Callable, Iterator
from dataclasses import replace
from pathlib import Path
from typing import Any

import pytest
from fastapi.testclient import TestClient

from server.alarms import AlarmService, StoredAlarmLog
from server.app import AppParts, create_app
from server.config import Config
from server.live import Instant, LiveHub, ProcessState, ProcessStatus, SourceState, SourceStatus
from server.store import CaseStore, Home
from tracker.navigation import NavigationSnapshot

RUNS = SourceStatus(name="made", state=SourceState.RUNNING)
WORKS = ProcessStatus(state=ProcessState.RUNNING)


class Door:
    """A server with alarms, fed by the test."""

    def __init__(self, store: CaseStore, snapshot_of: Callable[..., NavigationSnapshot]) -> None:
        self.hub, self.now_s, self.number = LiveHub(), 1000.0, 0
        self.snapshot_of = snapshot_of
        self.log = StoredAlarmLog(store)
        self.service = AlarmService(Config(), log=self.log, clock=lambda: self.now_s)
        app = create_app(AppParts(hub=self.hub, config=Config(), alarms=self.service))
        self.client = TestClient(app, base_url="http://127.0.0.1:8000", raise_server_exceptions=False)

    def images(self, count: int, depth_mm: float) -> None:
        for _ in range(count):
            self.now_s, self.number = self.now_s + 1 / 30, self.number + 1
            snapshot = self.snapshot_of(
                tip_in_vertebra_mm=(0.0, 0.0, depth_mm), image_number=self.number, captured_at_s=self.now_s
            )
            alarms = self.service.observe(snapshot, RUNS, WORKS)
            instant = Instant(sequence=self.number, source=RUNS, process=WORKS, snapshot=snapshot)
            self.hub.publish(replace(instant, alarms=alarms))

    def post(self, path: str, status: int = 200, **sent: Any) -> Any:  # noqa: ANN401  JSON
        answer = self.client.post(f"/api/alarms/{path}", json=sent)
        assert answer.status_code == status, answer.text
        return answer.json()

    def get(self, path: str) -> Any:  # noqa: ANN401  JSON
        answer = self.client.get(path)
        assert answer.status_code == 200, answer.text
        return answer.json()


@pytest.fixture
def door(tmp_path: Path, snapshot_of: Callable[..., NavigationSnapshot]) -> Iterator[Door]:
    with Home(tmp_path / "home") as home, CaseStore(home) as store:
        door = Door(store, snapshot_of)
        with door.client:
            yield door
        door.log.stop()


def test_an_alarm_from_its_image_to_its_end(door: Door) -> None:
    assert door.get("/api/alarms")["alarms"] == []
    door.images(3, 40.5)
    live = door.get("/api/live")
    (alarm,) = live["alarms"]["alarms"]
    assert live["snapshot"]["image_number"] == 3
    assert (alarm["condition"], alarm["priority"], alarm["state"]) == ("PAST_DEPTH", "high", "active")
    assert alarm["presence"] == "yes"
    assert alarm["sentence"]["en"].startswith("Tip 0.")
    assert alarm["remedy"]["en"] == "Stop. Withdraw the drill."
    assert live["headline"]["verdict"] == "too_deep"
    assert live["alarms"]["sound"] == "high"
    paused = door.post("pause", by="nurse", seconds=60)
    assert (paused["sound"], paused["pause_left_s"]) == ("silent", 60.0)
    assert door.post("resumption", by="nurse")["sound"] == "high"
    reported = door.post("acknowledgement", by="M. Ito", numbers=[alarm["number"]])
    assert (reported["sound"], reported["alarms"][0]["acknowledged_by"]) == ("silent", "M. Ito")
    lines = door.get("/api/alarms/log")["lines"]
    changes = [(line["change"], line.get("by")) for line in lines]
    assert changes == [
        ("raised", None),
        ("paused", "nurse"),
        ("resumed", "nurse"),
        ("acknowledged", "M. Ito"),
    ]
    assert lines[0]["tools"]["drill"]["depth_mm"] == pytest.approx(40.5, abs=0.5)
    assert lines[0]["sentence"] == alarm["sentence"]


def test_live_socket_and_view_socket_carry_the_alarms_of_their_image(door: Door) -> None:
    door.images(3, 42.0)
    with door.client.websocket_connect("ws://127.0.0.1:8000/ws/live") as socket:
        message = socket.receive_json()
    assert [alarm["condition"] for alarm in message["alarms"]["alarms"]] == ["PAST_DEPTH"]
    with door.client.websocket_connect("ws://127.0.0.1:8000/ws/view") as socket:
        socket.send_json({"next": True})
        header = socket.receive_bytes()
    assert b'"condition":"PAST_DEPTH"' in header


def test_a_hold_is_asked_and_released_and_stops_nothing(door: Door) -> None:
    door.images(3, 12.0)
    requested = door.post("hold", by="Dr Sato")
    assert [(a["condition"], a["kind"], a["by"]) for a in requested["alarms"]] == [
        ("HOLD_REQUESTED", "advisory", "Dr Sato")
    ]
    door.images(3, 12.0)
    assert door.get("/api/live")["snapshot"]["tools"][0]["deviation"]["kind"] == "deviation"
    assert door.post("release", by="Dr Sato")["alarms"] == []


def test_screens_say_whether_they_are_armed(door: Door) -> None:
    door.images(1, 12.0)
    door.post("screens", screen="theatre-01", state="armed")
    door.now_s += 5.5
    door.images(1, 12.0)
    door.now_s += 5.5
    door.post("screens", screen="theatre-01", state="silent")
    door.images(1, 12.0)
    door.now_s += 5.5
    conditions = {alarm["condition"] for alarm in door.get("/api/alarms")["alarms"]}
    assert "NO_ARMED_SCREEN" in conditions
    door.post("screens", screen="theatre-01", state="armed")
    door.images(1, 12.0)
    door.now_s += 1.1
    door.images(1, 12.0)
    assert door.get("/api/alarms")["alarms"] == []
    door.post("screens", screen="theatre-01", state="closed")


@pytest.mark.parametrize(
    ("path", "sent", "code"),
    [
        pytest.param(
            "pause", {"by": "x", "seconds": 121}, "ALARM_PAUSE_TOO_LONG", id="more than two minutes"
        ),
        pytest.param("pause", {"by": "x", "seconds": -1}, "ALARM_PAUSE_TOO_LONG", id="before now"),
        pytest.param("acknowledgement", {"by": "x", "numbers": []}, "REQUEST_INVALID", id="nothing"),
        pytest.param("acknowledgement", {"by": " ", "numbers": [1]}, "REQUEST_INVALID", id="a blank name"),
        pytest.param("acknowledgement", {"by": "a\nb", "numbers": [1]}, "REQUEST_INVALID", id="two lines"),
        pytest.param("screens", {"screen": "../x", "state": "armed"}, "REQUEST_INVALID", id="strange screen"),
        pytest.param("screens", {"screen": "theatre-01", "state": "off"}, "REQUEST_INVALID", id="no off"),
        pytest.param("hold", {"by": ""}, "REQUEST_INVALID", id="an anonymous hold"),
    ],
)
def test_what_cannot_be_done_is_rejected(door: Door, path: str, sent: dict[str, Any], code: str) -> None:
    answer = door.post(path, 422, **sent)
    assert answer["code"] == code
    assert answer["remedy"]


def test_an_alarm_that_is_not_there_is_acknowledged_without_effect(door: Door) -> None:
    assert door.post("acknowledgement", by="x", numbers=[99])["alarms"] == []
    assert door.get("/api/alarms/log")["lines"] == []


@pytest.mark.parametrize("priority", ["high", "medium", "low"])
def test_each_sound_is_where_the_page_is_sent(door: Door, priority: str) -> None:
    sounds = {sound["priority"]: sound for sound in door.get("/api/dashboard")["sounds"]}
    answer = door.client.get(sounds[priority]["path"])
    assert (answer.status_code, answer.headers["content-type"]) == (200, "audio/wav")
    with wave.open(io.BytesIO(answer.content)) as file:
        assert 0 < file.getnframes() / file.getframerate() < sounds[priority]["repeat_every_s"]
    assert door.client.get("/api/alarms/sound/loud.wav").status_code == 422


def test_without_a_log_nothing_is_kept_and_all_else_works() -> None:
    with TestClient(create_app(AppParts(hub=LiveHub(), config=Config()))) as client:
        answer = client.post("/api/alarms/hold", json={"by": "Dr Sato"}, headers={"host": "127.0.0.1:8000"})
        assert answer.json()["sound"] == "medium"
