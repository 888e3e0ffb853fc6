"""The hub's own routes: who sees which theatre, and that nothing old is in an answer."""

from datetime import timedelta
from pathlib import Path

import pytest
from starlette.testclient import TestClient
from starlette.websockets import WebSocketDisconnect

from server.config import Config
from server.hub.connection import HubAddress
from server.hub.delays import Arrival
from server.hub.pictures import picture_packed
from server.hub.subjects import Hospital, Leaf
from server.hub.watcher import Received
from server.hub_app import create_hub_app
from server.security import AuditLog, PeopleService, Role
from server.security.people.service import NewInvitation
from tests.server.hub.test_hub_publisher import live_text
from tests.server.hub.test_theatre_rows import received

SEES = {"Dr. Weber": ["OR-*"], "Dr. Ito": ["Angio"]}
NOW_S = 1000.0
ADDRESS = HubAddress(url="nats://127.0.0.1:4222", hospital=Hospital("clinic"))


def heard(*, ago_s: float) -> dict[tuple[str, Leaf], Received]:
    """State and picture of three theatres, which arrived then."""
    arrival = Arrival(arrived_s=NOW_S - ago_s, transfer_ms=4.0, age_ms=50.0)
    picture = picture_packed(live_text(), b"jpeg")
    contents = {Leaf.STATE: received().content, Leaf.PICTURE: picture}
    return {
        (name, leaf): Received(run="r", number=1, content=content, arrival=arrival)
        for name in ("Angio", "OR-1", "OR-2")
        for leaf, content in contents.items()
    }


@pytest.fixture(autouse=True)
def standing_clock(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr("server.api.hub.elapsed_s", lambda: NOW_S)


class Door:
    """A hub that has heard three theatres; nothing connects to a NATS server."""

    def __init__(self, folder: Path, *, ago_s: float = 0.0) -> None:
        folder.mkdir(exist_ok=True)
        self.people = PeopleService(folder, audit=AuditLog(folder))
        app = create_hub_app(Config.model_validate({"hub": {"sees": SEES}}), ADDRESS, self.people)
        app.state.hub.watcher.newest.update(heard(ago_s=ago_s))
        self.client = TestClient(app, base_url="http://127.0.0.1:8000")

    def of(self, name: str, role: Role = Role.SUPERVISOR) -> dict[str, str]:
        wanted = NewInvitation(name=name, role=role, lasts=timedelta(hours=1))
        token = self.people.invite(wanted, by="test")[1].text
        return {"Authorization": f"Bearer {self.people.sign_in(token, address='test')[1].text}"}


@pytest.mark.parametrize(
    ("name", "role", "seen"),
    [
        ("Dr. Weber", Role.SUPERVISOR, ["OR-1", "OR-2"]),
        ("Dr. Ito", Role.VIEWER, ["Angio"]),
        ("Operator", Role.OPERATOR, []),
    ],
)
def test_an_account_sees_the_theatres_of_the_settings_and_no_other(
    tmp_path: Path, name: str, role: Role, seen: list[str]
) -> None:
    door = Door(tmp_path)
    headers = door.of(name, role)
    listed = door.client.get("/api/theatres", headers=headers).json()
    assert [one["name"] for one in listed["theatres"]] == seen
    for theatre in ("Angio", "OR-1", "OR-2"):
        for path in (f"/api/theatres/{theatre}/picture", f"/at/{theatre}/api/dashboard"):
            assert door.client.get(path, headers=headers).status_code == (200 if theatre in seen else 404)
        if theatre not in seen:
            with (
                pytest.raises(WebSocketDisconnect) as closed,
                door.client.websocket_connect(
                    f"ws://127.0.0.1:8000/at/{theatre}/ws/live", headers=headers
                ) as socket,
            ):
                socket.receive_text()
            assert closed.value.code == 1008


def test_a_picture_states_how_old_it_is_at_most_and_an_old_one_is_not_given(tmp_path: Path) -> None:
    door = Door(tmp_path, ago_s=1.0)
    answer = door.client.get("/api/theatres/OR-1/picture", headers=door.of("Dr. Weber"))
    assert (answer.content, answer.headers["content-type"]) == (b"jpeg", "image/jpeg")
    assert answer.headers["X-Coaxial-Age-Ms"] == "1054.0"
    old = Door(tmp_path, ago_s=2.0)
    refused = old.client.get("/api/theatres/OR-1/picture", headers=old.of("Dr. Weber"))
    assert (refused.status_code, refused.json()["code"]) == (503, "THEATRE_SILENT")
    listed = old.client.get("/api/theatres", headers=old.of("Dr. Weber")).json()["theatres"]
    assert {(one["presence"], one["headline"], len(one["alarms"])) for one in listed} == {("stale", "", 0)}


@pytest.mark.parametrize("name", ["OR-1.request", "OR-*", "OR->", "OR-1%0d%0aX"])
def test_what_is_no_name_of_a_theatre_is_not_seen(tmp_path: Path, name: str) -> None:
    door = Door(tmp_path)
    answer = door.client.get(f"/at/{name}/api/dashboard", headers=door.of("Dr. Weber"))
    assert (answer.status_code, answer.json()["code"]) == (404, "NOT_FOUND")


def test_a_viewer_at_the_hub_asks_nothing_of_a_theatre(tmp_path: Path) -> None:
    door = Door(tmp_path)
    answer = door.client.post("/at/Angio/api/alarms/hold", headers=door.of("Dr. Ito", Role.VIEWER), json={})
    assert (answer.status_code, answer.json()["code"]) == (403, "ROLE_REJECTED")
