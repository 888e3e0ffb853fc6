"""The rehearsal over HTTP: another scene while it runs, its ground truth, and its CT."""

from pathlib import Path

import numpy as np
import pytest
from fastapi.testclient import TestClient

from server.app import AppParts, create_app
from server.capture.rehearsal import PlayedScene
from server.config import CameraConfig, Config, RehearsalConfig
from server.imaging.ct_reader import read_ct
from server.live import LiveHub
from server.loop.rehearsal_control import RehearsalControl
from server.loop.staging import SceneOrder
from tracker.rehearsal.ct import rehearsal_ct

URL = "http://127.0.0.1:8000"
CONFIG = Config(rehearsal=RehearsalConfig(seed=3, reference=True))


class Played:
    """A tracking process that executes orders at once."""

    def __init__(self) -> None:
        self.orders: list[SceneOrder] = []
        self.begun = PlayedScene()

    def play(self, order: SceneOrder) -> None:
        self.orders.append(order)
        self.begun = PlayedScene(scene_number=order.number, first_number=100 * order.number)


@pytest.fixture
def played() -> Played:
    return Played()


@pytest.fixture
def door(played: Played) -> TestClient:
    rehearsed = RehearsalControl(CONFIG.rehearsal, play=played.play, played_scene=lambda: played.begun)
    app = create_app(AppParts(hub=LiveHub(), config=CONFIG, rehearsed=rehearsed))
    return TestClient(app, base_url=URL)


def test_it_reports_the_scene_without_its_truth(door: TestClient) -> None:
    reported = door.get("/api/rehearsal").json()
    assert (reported["scene"], reported["seed"], reported["reference"], reported["begun"]) == (
        "operation",
        3,
        True,
        True,
    )
    assert reported["truth"] is None


def test_another_scene_is_played_in_the_same_theatre(door: TestClient, played: Played) -> None:
    truth = door.get("/api/rehearsal?truth=1").json()["truth"]
    requested = {"scene": "landmarks", "events": [{"kind": "camera_moves", "at_s": 5, "lasts_s": 2.5}]}
    reported = door.put("/api/rehearsal", json=requested)
    assert reported.status_code == 200
    assert (reported.json()["scene"], reported.json()["first_number"]) == ("landmarks", 100)
    order = played.orders[-1]
    assert (order.rehearsal.seed, order.rehearsal.reference) == (3, True)
    assert [event.kind for event in order.rehearsal.events] == ["camera_moves"]
    after = door.get("/api/rehearsal?truth=1").json()["truth"]
    for key in ("camera_matrix", "landmarks", "tip_in_marker_mm", "reference_from_vertebra"):
        assert after[key] == truth[key]
    assert len(after["landmarks"]) >= 6
    assert after["moment"] is None
    # Omitted values stay, except the events.
    door.put("/api/rehearsal", json={"scene": "operation", "skill": "breaching"})
    door.put("/api/rehearsal", json={"scene": "operation"})
    assert played.orders[-1].rehearsal.skill == "breaching"
    assert played.orders[-1].rehearsal.events == []


@pytest.mark.parametrize(
    "requested",
    [
        {"scene": "dance"},
        {"scene": "operation", "events": [{"kind": "camera_moves", "at_s": -1}]},
        {"scene": "operation", "events": [{"kind": "earthquake", "at_s": 1}]},
        {},
    ],
)
def test_what_cannot_be_played_is_rejected(
    door: TestClient, played: Played, requested: dict[str, object]
) -> None:
    answer = door.put("/api/rehearsal", json=requested)
    assert answer.status_code == 422
    assert answer.json()["code"] == "REQUEST_INVALID"
    assert played.orders == []


def test_other_sources_have_no_scene() -> None:
    config = Config(camera=CameraConfig(source="video.mp4"))
    door = TestClient(create_app(AppParts(hub=LiveHub(), config=config)), base_url=URL)
    for answer in (
        door.get("/api/rehearsal"),
        door.put("/api/rehearsal", json={"scene": "board"}),
        door.get("/api/rehearsal/ct"),
    ):
        assert answer.status_code == 409
        assert answer.json()["code"] == "NOT_A_REHEARSAL"
        assert "video.mp4" in answer.json()["message"]


def test_its_ct_is_read_back_in_the_frame_of_its_vertebra(door: TestClient, tmp_path: Path) -> None:
    file = tmp_path / "rehearsal.nii.gz"
    file.write_bytes(door.get("/api/rehearsal/ct").content)
    volume, made = read_ct(file).volume, rehearsal_ct()
    points = np.array(
        [[16.0, 0.0, 4.5], [-16.0, 4.0, 4.5], [0.0, -25.0, 3.0], [0.0, 1.0, 0.0], [41.0, 13.0, 6.0]]
    )
    hu = [_at(one.lps_from_ijk, one.hu, points) for one in (volume, made)]
    np.testing.assert_allclose(hu[0], hu[1], atol=1.0)


def _at(lps_from_ijk: np.ndarray, hu: np.ndarray, points: np.ndarray) -> np.ndarray:
    ijk = np.rint((points - lps_from_ijk[:3, 3]) @ np.linalg.inv(lps_from_ijk[:3, :3]).T).astype(int)
    return np.asarray(hu[ijk[:, 2], ijk[:, 1], ijk[:, 0]])
