"""`/ws/room` over HTTP: marks of one page reach another; protocol violations are closed."""

import json
import time
from collections.abc import Callable, Iterator
from dataclasses import replace
from typing import Any

import pytest
from fastapi.testclient import TestClient
from starlette.testclient import WebSocketTestSession
from starlette.websockets import WebSocketDisconnect

from server.app import AppParts, create_app
from server.config import Config
from server.live import Instant, LiveHub
from tests.server.supervision.signed_in_people import sign_people_in
from tracker.navigation import NavigationSnapshot

Open = Callable[..., WebSocketTestSession]
NEXT = {"next": True}


class Page:
    """One page in the room."""

    def __init__(self, socket: WebSocketTestSession, image: dict[str, Any]) -> None:
        self.socket, self.image = socket, image

    def say(self, **said: Any) -> None:  # noqa: ANN401  JSON
        self.socket.send_json(said)

    def hear(self) -> dict[str, Any]:
        self.socket.send_json(NEXT)
        reported: dict[str, Any] = self.socket.receive_json()
        return reported

    def until(self, true: Callable[[dict[str, Any]], Any]) -> dict[str, Any]:
        deadline = time.monotonic() + 60
        while not true(reported := self.hear()):
            assert time.monotonic() < deadline, reported
        return reported

    def reason(self) -> str:
        """Reason of the close."""
        with pytest.raises(WebSocketDisconnect) as reported:
            self.socket.receive_json()
        assert reported.value.code in (1008, 1009)
        return str(reported.value.reason)


@pytest.fixture
def client(
    snapshot_of: Callable[..., NavigationSnapshot], instant_of: Callable[..., Instant]
) -> Iterator[TestClient]:
    hub = LiveHub()
    app = create_app(AppParts(hub=hub, config=Config()))
    sign_people_in(app)
    snapshot = snapshot_of(size_wh_px=(1280, 720), image_number=500, captured_at_s=time.monotonic())

    def navigate_ct(ct_id: str) -> None:
        shown = replace(snapshot, setup=replace(snapshot.setup, ct_id=ct_id))
        hub.publish(instant_of(1, snapshot=shown))

    app.state.navigate_ct = navigate_ct
    navigate_ct("ct-1")
    with TestClient(app, base_url="http://127.0.0.1:8000") as client:
        yield client


@pytest.fixture
def image(client: TestClient) -> dict[str, Any]:
    snapshot = client.get("/api/live").json()["snapshot"]
    return {key: snapshot[key] for key in ("image_number", "captured_at_s")}


@pytest.fixture
def page(client: TestClient, image: dict[str, Any]) -> Iterator[Callable[..., Page]]:
    open_sockets: list[WebSocketTestSession] = []

    def opened(person: str, view: str = "supervisor") -> Page:
        session = client.websocket_connect(f"ws://127.0.0.1:8000/ws/room?view={view}&person={person}")
        open_sockets.append(session.__enter__())
        return Page(session, image)

    yield opened
    for session in open_sockets:
        session.__exit__(None, None, None)


def test_a_supervisors_mark_is_shown_in_theatre(page: Callable[..., Page], image: dict[str, Any]) -> None:
    sato, theatre = page("s1"), page("v1", "theatre")
    assert sato.hear()["you"]["name"] == "Dr Sato"
    reported = theatre.until(lambda reported: reported["people"] and len(reported["people"]) == 2)
    assert [(one["name"], one["role"], one["views"], one["is_you"]) for one in reported["people"]] == [
        ("Dr Sato", "supervisor", ["supervisor"], False),
        ("Guest", "viewer", ["theatre"], True),
    ]
    sato.say(point={"at": [640.5, 300], **image})
    (pointer,) = theatre.until(lambda reported: reported["pointers"])["pointers"]
    assert (pointer["name"], pointer["at"], pointer["image_number"]) == ("Dr Sato", [640.5, 300.0], 500)
    assert 0.0 <= pointer["still_ms"] < 2000.0
    sato.say(lift=True)
    theatre.until(lambda reported: not reported["pointers"])
    sato.say(draw={"key": 1, "shape": "pen", "points": [[1, 2], [3, 4]], **image})
    (begun,) = theatre.until(lambda reported: reported["grown"])["grown"]
    assert (begun["from_point"], begun["points"]) == (0, [[1.0, 2.0], [3.0, 4.0]])
    assert (begun["name"], begun["is_yours"], begun["shape"]) == ("Dr Sato", False, "pen")
    assert 10.0 < begun["left_s"] <= 20.0
    sato.say(extend={"key": 1, "points": [[5, 6]]})
    (more,) = theatre.until(lambda reported: reported["grown"])["grown"]
    assert (more["key"], more["from_point"], more["points"]) == (begun["key"], 2, [[5.0, 6.0]])
    sato.say(undo=True)
    theatre.until(lambda reported: not reported["drawings"])


def test_the_operator_clears_what_others_drew(page: Callable[..., Page], image: dict[str, Any]) -> None:
    sato, ito = page("s1"), page("o1", "operator")
    sato.say(draw={"key": 7, "shape": "circle", "points": [[100, 100], [150, 100]], **image})
    (drawn,) = ito.until(lambda reported: reported["grown"])["grown"]
    assert (drawn["name"], drawn["is_yours"], drawn["shape"]) == ("Dr Sato", False, "circle")
    assert sato.until(lambda reported: reported["drawings"])["drawings"] == [drawn["key"]]
    ito.say(clear="all")
    assert [page.until(lambda reported: not reported["drawings"])["drawings"] for page in (sato, ito)] == [
        [],
        [],
    ]
    # None of it returns with the next drawing.
    sato.say(draw={"key": 8, "shape": "circle", "points": [[200, 100], [250, 100]], **image})
    (after,) = ito.until(lambda reported: reported["drawings"])["drawings"]
    assert after != drawn["key"]


PLANE = {
    "ct_id": "ct-1",
    "origin_in_vertebra_mm": [-20.0, -30.5, 1234.5],
    "right_in_vertebra": [0.8, 0.6, 0.0],
    "down_in_vertebra": [-0.6, 0.8, 0.0],
}


def test_a_mark_on_a_cut_is_sent_with_its_plane_until_another_ct_is_navigated(
    page: Callable[..., Page], image: dict[str, Any], client: TestClient
) -> None:
    sato, theatre = page("s1"), page("v1", "theatre")
    sato.say(point={"at": [-3.5, 12], "plane": PLANE, **image})
    (pointer,) = theatre.until(lambda reported: reported["pointers"])["pointers"]
    assert (pointer["at"], pointer["plane"]) == ([-3.5, 12.0], PLANE)
    sato.say(draw={"key": 1, "shape": "pen", "points": [[-1, 2.5]], "plane": PLANE, **image})
    sato.say(extend={"key": 1, "points": [[-1, 4]]})
    (begun,) = theatre.until(lambda reported: reported["grown"])["grown"]
    assert begun["plane"] == PLANE
    assert 10.0 < begun["left_s"] <= 20.0
    sato.say(draw={"key": 2, "shape": "pen", "points": [[1, 2]], **image})
    theatre.until(lambda reported: len(reported["drawings"]) == 2)
    client.app.state.navigate_ct("ct-2")  # type: ignore[attr-defined]
    left = theatre.until(lambda reported: not reported["pointers"])
    assert left["drawings"] == ["1-2"]


POINT = {"at": [1, 2], "image_number": 1, "captured_at_s": 1.0}
DRAW = {**{key: POINT[key] for key in ("image_number", "captured_at_s")}, "key": 1, "shape": "pen"}


@pytest.mark.parametrize(
    ("person", "said", "reason"),
    [
        pytest.param("v1", json.dumps({"point": POINT}), "may not mark", id="a viewer points"),
        pytest.param("v1", '{"clear": "own"}', "may not mark", id="a viewer clears"),
        pytest.param("s1", '{"clear": "all"}', "operator", id="a supervisor clears all"),
        pytest.param("s1", "hello", "invalid message", id="no JSON"),
        pytest.param("s1", "[" * 1000, "invalid message", id="deep"),
        pytest.param("s1", '{"next": true, "undo": true}', "invalid message", id="two things"),
        pytest.param("s1", "{}", "invalid message", id="nothing"),
        pytest.param("s1", '{"next": true, "role": "operator"}', "invalid message", id="something unknown"),
        pytest.param("s1", '{"point": {"at": [NaN, 1]}}', "invalid message", id="no number"),
        pytest.param(
            "s1", json.dumps({"point": {**POINT, "at": [1e9, 1]}}), "invalid message", id="far away"
        ),
        pytest.param("s1", json.dumps({"point": {**POINT, "at": ["1", 1]}}), "invalid message", id="a text"),
        pytest.param(
            "s1", json.dumps({"draw": {**DRAW, "points": [[1, 2]] * 61}}), "not", id="too many points"
        ),
        pytest.param("s1", json.dumps({"draw": {**DRAW, "points": []}}), "not", id="no points"),
        pytest.param(
            "s1",
            json.dumps({"point": {**POINT, "plane": {**PLANE, "down_in_vertebra": [0.8, 0.6, 0.0]}}}),
            "orthogonal",
            id="a plane without directions",
        ),
        pytest.param(
            "v1", json.dumps({"point": {**POINT, "plane": PLANE}}), "may not mark", id="a viewer on a cut"
        ),
        pytest.param("s1", json.dumps({"undo": True}).ljust(1025), "1024", id="too long"),
    ],
)
def test_who_violates_the_protocol_is_disconnected_with_a_reason(
    page: Callable[..., Page], person: str, said: str, reason: str
) -> None:
    one = page(person)
    one.socket.send_text(said)
    assert reason in one.reason()


def test_a_flood_of_marks_is_cut_off(page: Callable[..., Page], image: dict[str, Any]) -> None:
    sato = page("s1")
    for _ in range(200):
        sato.say(point={"at": [1, 2], **image})
    assert "per second" in sato.reason()


def test_a_view_that_is_not_there_is_rejected(page: Callable[..., Page]) -> None:
    assert "theatre, operator, supervisor" in page("s1", "ceiling").reason()


def test_the_room_is_reported_once_over_http_too(client: TestClient, page: Callable[..., Page]) -> None:
    sato = page("s1")
    sato.hear()
    reported = client.get("/api/supervision/room", headers={"x-person": "v1"}).json()
    assert [one["name"] for one in reported["people"]] == ["Dr Sato"]
    assert reported["you"] == {"seat": 0, "name": "Guest", "role": "viewer"}
    assert reported["signable"] is None


def test_who_leaves_is_not_here_any_more(page: Callable[..., Page], client: TestClient) -> None:
    theatre = page("v1", "theatre")
    with client.websocket_connect("ws://127.0.0.1:8000/ws/room?view=supervisor&person=s1"):
        theatre.until(lambda reported: reported["people"] and len(reported["people"]) == 2)
    theatre.until(lambda reported: reported["people"] and len(reported["people"]) == 1)
    assert 'coaxial_viewers{kind="room"} 1.0' in client.get("/metrics").text


def test_holds_of_several_stand_until_each_has_released(client: TestClient) -> None:
    def post(path: str, person: str, status: int = 200) -> Any:  # noqa: ANN401  JSON
        requested = {"by": "somebody else"}
        answer = client.post(f"/api/alarms/{path}", json=requested, headers={"x-person": person})
        assert answer.status_code == status, answer.text
        return answer.json()

    def by(reported: Any) -> list[str]:  # noqa: ANN401  JSON
        return [one["by"] for one in reported["alarms"] if one["condition"] == "HOLD_REQUESTED"]

    # The session's name is used, whatever was entered.
    assert by(post("hold", "s1")) == ["Dr Sato"]
    rejected = post("release", "s2", 409)
    assert (rejected["code"], "Dr Sato" in rejected["message"]) == ("HOLD_NOT_YOURS", True)
    post("hold", "s2")
    reported = client.get("/api/supervision/room", headers={"x-person": "s2"}).json()
    since = reported["hold"].pop("since")
    assert since.endswith("Z")
    assert reported["hold"] == {"requested_by": ["Dr Sato", "Dr Kim"], "is_yours": True}
    assert by(post("release", "s1")) == ["Dr Kim"]
    assert by(post("hold", "s1")) == ["Dr Kim, Dr Sato"]
    assert by(post("release", "o1")) == []
