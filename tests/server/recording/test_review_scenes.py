"""The 3-D scene of a recorded instant, as a browser receives it."""

import asyncio
import shutil
import threading
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from types import SimpleNamespace
from typing import Any, cast

import numpy as np
import pytest
from fastapi.testclient import TestClient
from starlette.websockets import WebSocketDisconnect

from server.app import AppParts, create_app
from server.config import Config
from server.imaging.meshes import ply_from_surface
from server.jobs import Jobs
from server.live import LiveHub
from server.logs import LogSettings
from server.recording.review import RecordedScene, RecordingReview
from server.recording.review_scenes import MAX_SCENES, ReviewScenes, _ReviewScene
from server.scene.gate import SUBPROTOCOL
from server.scene.nodes import BONE_NODE
from server.scene.scene import anybody
from server.store import CaseStore, DocumentKind, Home
from tests.server.recording.no_recorder import recordings_without_process
from tests.server.recording.reviewed import write_drilling
from tests.server.scene.packets import viser_messages
from tests.server.scene.scene_theatre import block
from tracker.navigation import NavigationSnapshot

NAME, WITHOUT_STATE = "20260101T000000Z-0000.mcap", "20260102T000000Z-0000.mcap"
KEY = "0123456789abcdef"
SOCKET = "ws://127.0.0.1:8000/scene/review"


@pytest.fixture
def store(recorded: Path, tmp_path: Path) -> Iterator[CaseStore]:
    """Return the store of an open case with two recordings."""
    with Home(tmp_path / "home") as home, CaseStore(home) as store:
        case_id = store.create("L3").id
        store.open(case_id)
        folder = home.cases / case_id / "recordings"
        folder.mkdir(parents=True)
        shutil.copy(recorded, folder / NAME)
        write_drilling(folder / WITHOUT_STATE)
        yield store


@pytest.fixture
def client(store: CaseStore) -> Iterator[TestClient]:
    """Return a client of a server on which both are indexed."""
    config = Config.model_validate({"recording": {"min_free_gb": 0.0, "consent": "not_required"}})
    jobs = Jobs(log=LogSettings(as_json=True))
    parts = AppParts(
        hub=LiveHub(),
        config=config,
        store=store,
        recordings=recordings_without_process(store, config),
        jobs=jobs,
    )
    with TestClient(create_app(parts), base_url="http://127.0.0.1:8000") as client:
        for name in (NAME, WITHOUT_STATE):
            found = client.get(f"/api/recordings/{name}/timeline").json()
            jobs.wait_for(found["job"]["id"], timeout_s=60.0)
        yield client
    jobs.close()


def show(client: TestClient, number: int, *, name: str = NAME, key: str = KEY) -> dict[str, Any]:
    answer = client.put(f"/api/recordings/{name}/scenes/{key}", json={"number": number})
    return {"status": answer.status_code, **answer.json()}


def drawn(socket: Any, image_number: int) -> tuple[dict[str, list[float]], set[str]]:  # noqa: ANN401  of the test client
    """Return the positions of nodes when this image is drawn, and the names of new meshes."""
    found: dict[str, list[float]] = {}
    meshes: set[str] = set()
    while found.get("/image_number", [0.0, 0.0])[:2] != [1.0, image_number]:
        batch = viser_messages(socket.receive_bytes())
        found |= {one["name"]: one["position"] for one in batch if one["type"] == "SetPositionMessage"}
        meshes |= {one["name"] for one in batch if one["type"] == "MeshMessage"}
    return found, meshes


def test_the_scene_shows_the_recorded_pose_and_follows_the_review(client: TestClient) -> None:
    assert client.get(f"/scene/review/{KEY}/").status_code == 404
    instants = [client.get(f"/api/recordings/{NAME}/instants/{number}").json() for number in (0, 10)]
    numbers = [one["snapshot"]["image_number"] for one in instants]
    assert show(client, 0) == {"status": 200, "image_number": numbers[0]}
    assert client.get(f"/scene/review/{KEY}/").headers["content-type"].startswith("text/html")
    with client.websocket_connect(f"{SOCKET}/{KEY}", subprotocols=[SUBPROTOCOL]) as socket:
        nodes, _ = drawn(socket, numbers[0])
        pose = instants[0]["snapshot"]["tools"][0]["pose"]
        vertebra = instants[0]["snapshot"]["vertebra"]["camera_from_vertebra"]
        rotation = np.array(vertebra["rotation"])
        expected = rotation.T @ (
            np.array(pose["camera_from_tool"]["translation_mm"]) - np.array(vertebra["translation_mm"])
        )
        tool = next(place for name, place in nodes.items() if name.endswith("/tool_0"))
        assert tool == pytest.approx(expected.tolist(), abs=1e-3)
        assert show(client, 10) == {"status": 200, "image_number": numbers[1]}
        drawn(socket, numbers[1])


def test_without_the_setup_nothing_is_drawn(client: TestClient) -> None:
    answer = show(client, 3, name=WITHOUT_STATE)
    assert (answer["status"], answer["code"]) == (409, "RECORDING_WITHOUT_SETUP")
    assert client.get(f"/scene/review/{KEY}/").status_code == 404
    assert show(client, 16)["code"] == "RECORDED_IMAGE_UNKNOWN"
    assert show(client, 0, key="not a key")["status"] == 422


def test_the_bone_is_the_one_that_was_in_use(
    client: TestClient, store: CaseStore, monkeypatch: pytest.MonkeyPatch
) -> None:
    case = store.get_open_case()
    assert case is not None
    surface = block((0.0, 0.0, 0.0), (20.0, 20.0, 10.0))
    with store.new_file(case.id, ".ply") as new:
        new.path.write_bytes(ply_from_surface(surface))
    files = [new.stored.id]
    document = store.put(case.id, DocumentKind.SURFACE, "main", {}, made_by="Anna", files=files)
    found = RecordingReview.scene

    def with_bone(review: RecordingReview, name: str, number: int) -> RecordedScene:
        return replace(found(review, name, number), surface_id=document.id if number < 5 else "")

    monkeypatch.setattr(RecordingReview, "scene", with_bone)
    image_number = show(client, 0)["image_number"]
    with client.websocket_connect(f"{SOCKET}/{KEY}", subprotocols=[SUBPROTOCOL]) as socket:
        _, meshes = drawn(socket, image_number)
        assert any(name.endswith(BONE_NODE) for name in meshes)
        _, meshes = drawn(socket, show(client, 10)["image_number"])
        # Built anew, without the bone.
        assert meshes
        assert not any(name.endswith(BONE_NODE) for name in meshes)


def test_scenes_are_closed_with_their_case(client: TestClient, store: CaseStore) -> None:
    show(client, 0)
    case = store.get_open_case()
    assert case is not None
    with client.websocket_connect(f"{SOCKET}/{KEY}", subprotocols=[SUBPROTOCOL]) as socket:
        store.close()
        with pytest.raises(WebSocketDisconnect):
            list(iter(socket.receive_bytes, b""))
    store.open(case.id)
    assert client.get(f"/scene/review/{KEY}/").status_code == 404


def test_an_image_is_not_drawn_if_another_was_requested_meanwhile(
    store: CaseStore, monkeypatch: pytest.MonkeyPatch
) -> None:
    overtaken, is_requested = threading.Event(), threading.Event()

    class Review:
        def scene(self, name: str, number: int) -> RecordedScene:
            if number == 0:
                is_requested.set()
                overtaken.wait(60.0)
            snapshot = cast(NavigationSnapshot, SimpleNamespace(image_number=number))
            return RecordedScene(snapshot=snapshot, surface_id="", recording=store.home.cases / name)

    shown: list[int] = []
    monkeypatch.setattr(_ReviewScene, "show", lambda _, one: shown.append(one.snapshot.image_number))
    scenes = ReviewScenes(cast(RecordingReview, Review()), store, admit=anybody)

    async def run() -> None:
        first = asyncio.create_task(scenes.show(KEY, "a", 0))
        await asyncio.to_thread(is_requested.wait, 60.0)
        await scenes.show(KEY, "a", 1)
        overtaken.set()
        await first
        await scenes.stop()

    asyncio.run(run())
    assert shown == [1]


def test_of_too_many_scenes_the_oldest_is_closed(client: TestClient) -> None:
    keys = [f"{number:016x}" for number in range(MAX_SCENES + 1)]
    for key in keys[:MAX_SCENES]:
        show(client, 0, key=key)
    # Used again, it is no longer the oldest.
    show(client, 1, key=keys[0])
    show(client, 0, key=keys[-1])
    gone = [key for key in keys if client.get(f"/scene/review/{key}/").status_code == 404]
    assert gone == [keys[1]]
    with (
        pytest.raises(WebSocketDisconnect),
        client.websocket_connect(f"{SOCKET}/{keys[1]}", subprotocols=[SUBPROTOCOL]) as socket,
    ):
        socket.receive_bytes()
