"""Camera calibration through the API, from rehearsed images of a board with a known camera."""

import shutil
from contextlib import ExitStack
from functools import lru_cache
from pathlib import Path

import cv2
import numpy as np
import pytest

from server.live import CameraStatus, ImageClock
from server.store import DocumentKind
from tests.procedure.conftest import Server, serving
from tracker.camera import CameraControl, CameraModel
from tracker.rehearsal import BoardKind, Scene, Theatre, TheatreSettings
from tracker.rehearsal.boards import HOLD_S, MOVE_S, PLACES

SIZE = (960, 540)
DOTS = {
    "pattern": "dots",
    "columns": 14,
    "rows": 10,
    "pitch_mm": 12.0,
    "fiducials": [31, 38, 60, 101, 108],
}


@lru_cache(maxsize=1)
def shown() -> tuple[CameraModel, tuple[np.ndarray, ...]]:
    """The true camera, and an image of the board in each position."""
    theatre = Theatre(TheatreSettings(seed=6, size_wh_px=SIZE, scene=Scene.BOARD, board=BoardKind.DOTS))
    renderer = theatre.renderer()
    times_s = [place * (HOLD_S + MOVE_S) + HOLD_S / 2.0 for place in range(len(PLACES))]
    return theatre.camera, tuple(renderer.image_at(at_s) for at_s in times_s)


def png(image: np.ndarray) -> bytes:
    return cv2.imencode(".png", image)[1].tobytes()


def camera_in_use(server: Server) -> CameraModel | None:
    return server.adopted[-1].camera


def open_a_case(server: Server) -> str:
    case = server.ask("POST", "/api/cases", 201, json={"name": "rehearsal"})
    server.ask("POST", f"/api/cases/{case['id']}/open", 200)
    return str(case["id"])


def test_a_camera_from_sent_images_is_the_true_one_and_is_used_at_once(server: Server) -> None:
    truth, images = shown()
    case_id = open_a_case(server)
    server.ask("POST", "/api/camera/collection", 201, json={"board": DOTS})
    for index, image in enumerate(images):
        reported = server.ask(
            "POST", f"/api/camera/collection/images?name=view-{index}", 201, content=png(image)
        )
    assert len(reported["views"]) == len(images)
    assert reported["missing"] == []
    assert reported["running"]
    job = server.done(server.ask("POST", "/api/camera/calibration", 202, json={"made_by": "ito"}))
    assert job["state"] == "done", job["problem"]
    # It detects no board while others navigate, and a page that is loaded again offers no second one.
    assert not server.ask("GET", "/api/camera", 200)["collecting"]
    assert server.ask("GET", "/api/camera/collection", 409)["code"] == "COLLECTION_MISSING"
    report = job["result"]
    assert report["rms_px"] < 0.1
    assert sum(view["used"] for view in report["views"]) == len(images)
    fx = next(one for one in report["parameters"] if one["name"] == "fx")
    assert abs(fx["value"] - truth.matrix[0, 0]) < 4.0 * fx["sd"]
    assert fx["sd"] < 2.0
    used = server.adopted[-1].camera
    assert used is not None
    np.testing.assert_allclose(used.matrix, report["matrix"])
    corner = np.array([[8.0, 8.0], [950.0, 530.0]])
    assert np.abs(used.normalised_from_px(corner) - truth.normalised_from_px(corner)).max() < 1.5e-3
    stored = server.ask("GET", "/api/camera/calibration", 200)
    heading = stored["heading"]
    assert (heading["kind"], heading["name"], heading["made_by"], heading["version"]) == (
        "camera",
        "main",
        "ito",
        1,
    )
    for picture in stored["content"]["plots"].values():
        svg = server.door.get(f"/api/cases/{case_id}/files/{picture}")
        assert svg.content.startswith(b"<svg")
    check_accuracy(server, images[0])


def check_accuracy(server: Server, image: np.ndarray) -> None:
    """Known distances on a board are measured in the newest image."""
    requested = {"board": DOTS, "made_by": "ito"}
    assert server.ask("POST", "/api/camera/accuracy", 503, json=requested)["code"] == "NO_PICTURE"
    server.show(at_s=0.0, image=np.full_like(image, 90))
    assert server.ask("POST", "/api/camera/accuracy", 422, json=requested)["code"] == "BOARD_NOT_FOUND"
    other = cv2.resize(image, (480, 270))
    server.show(at_s=0.5, image=other)
    rejected = server.ask("POST", "/api/camera/accuracy", 409, json=requested)
    assert rejected["code"] == "CAMERA_SIZE_MISMATCH"
    assert "480x270" in rejected["message"]
    server.show(at_s=1.0, image=image)
    check = server.ask("POST", "/api/camera/accuracy", 201, json=requested)["content"]
    assert check["passed"]
    assert 0.0 < check["rms_error_mm"] < check["maximum_error_mm"] < 0.2
    assert len(check["rows"]) >= 20


@pytest.mark.parametrize(("file", "begins"), [("pdf", b"%PDF"), ("svg", b"<?xml")])
def test_a_board_can_be_printed(server: Server, file: str, begins: bytes) -> None:
    answer = server.door.post("/api/camera/board", json={"board": {**DOTS, "pitch_mm": 10.0}, "file": file})
    assert answer.status_code == 200
    assert answer.content.lstrip().startswith(begins)
    rejected = server.ask("POST", "/api/camera/board", 422, json={"board": {**DOTS, "pitch_mm": 40.0}})
    assert rejected["code"] == "BOARD_TOO_LARGE"


def test_identity_and_controls_of_the_camera_are_kept_with_its_calibration_and_come_into_use(
    server: Server,
) -> None:
    open_a_case(server)
    _, images = shown()
    server.ask("POST", "/api/camera/collection", 201, json={"board": DOTS})
    controls = {CameraControl.FOCUS: 45, CameraControl.GAIN: 20}
    for late_s in (0.0, 0.3):
        camera = CameraStatus(clock=ImageClock.DRIVER, controls=controls, device="Webcam")
        server.show(at_s=late_s, image=images[0], camera=camera)
        server.until(
            lambda: server.ask("GET", "/api/camera/collection", 200)["image_number"] == server.number
        )
    for image in images[1:8]:
        server.ask("POST", "/api/camera/collection/images", 201, content=png(image))
    job = server.done(server.ask("POST", "/api/camera/calibration", 202, json={"made_by": "ito"}))
    assert job["state"] == "done", job["problem"]
    stored = server.ask("GET", "/api/camera/calibration", 200)
    assert stored["content"]["camera"]["controls"] == {"focus": 45, "gain": 20}
    assert server.adopted[-1].camera_controls == controls
    assert stored["content"]["camera"]["device"] == server.adopted[-1].camera_device == "Webcam"


def calibrate(server: Server) -> None:
    """Calibrate the camera with a few images."""
    _, images = shown()
    server.ask("POST", "/api/camera/collection", 201, json={"board": DOTS})
    for image in images[:8]:
        server.ask("POST", "/api/camera/collection/images", 201, content=png(image))
    job = server.done(server.ask("POST", "/api/camera/calibration", 202, json={"made_by": "ito"}))
    assert job["state"] == "done", job["problem"]


@pytest.fixture(scope="module")
def calibrated_home(tmp_path_factory: pytest.TempPathFactory) -> Path:
    """The folder of a server whose open case has a calibrated camera."""
    folder = tmp_path_factory.mktemp("calibrated")
    with serving(folder) as server:
        open_a_case(server)
        calibrate(server)
    return folder


@pytest.fixture
def calibrated_server(calibrated_home: Path, tmp_path: Path, turns: ExitStack) -> Server:
    """A server started in a copy of that folder."""
    shutil.copytree(calibrated_home, tmp_path, dirs_exist_ok=True)
    return turns.enter_context(serving(tmp_path))


def test_another_calibration_of_the_same_mode_keeps_the_readout(calibrated_server: Server) -> None:
    server = calibrated_server
    server.ask("PUT", "/api/camera/readout", 200, json={"readout_ms": 16.5, "made_by": "ito"})
    calibrate(server)
    stored = server.ask("GET", "/api/camera/calibration", 200)
    assert (stored["heading"]["version"], stored["content"]["camera"]["readout_ms"]) == (3, 16.5)
    assert server.adopted[-1].readout_ms == 16.5


def test_a_withdrawn_camera_is_used_no_more(calibrated_server: Server) -> None:
    server = calibrated_server
    case = server.store.get_open_case()
    assert case is not None
    camera = server.store.current(case.id, DocumentKind.CAMERA, "main")
    assert camera_in_use(server) is not None
    path = f"/api/cases/{case.id}/documents/{camera.id}/withdrawal"
    server.ask("POST", path, 200, json={"by": "ito", "reason": "the lens was turned"})
    assert camera_in_use(server) is None
    server.ask("POST", f"/api/cases/{case.id}/close", 200)


def test_views_are_taken_by_themselves_from_the_live_images(server: Server) -> None:
    _, images = shown()
    begun = server.ask("POST", "/api/camera/collection", 201, json={"board": DOTS})
    assert begun["missing"] == ["Show the board to the camera."]
    for index, image in enumerate(images[:3]):
        for late_s in (0.0, 0.3):
            server.show(at_s=index * 2.0 + late_s, image=image)
            server.until(
                lambda: server.ask("GET", "/api/camera/collection", 200)["image_number"] == server.number
            )
    reported = server.ask("GET", "/api/camera/collection", 200)
    assert reported["running"]
    assert reported["missing"]
    assert reported["views"] == ["image 2", "image 4", "image 6"]
    assert (reported["width_px"], reported["height_px"]) == SIZE
    assert len(reported["points_px"]) == 140
    server.ask("DELETE", "/api/camera/collection", 204)
    assert server.ask("GET", "/api/camera/collection", 409)["code"] == "COLLECTION_MISSING"


@pytest.mark.parametrize(
    ("views", "code"),
    [
        pytest.param(slice(0, 0), "COLLECTION_EMPTY", id="no-view"),
        pytest.param(slice(0, 1), "TOO_FEW_VIEWS", id="one-view"),
        pytest.param([0] * 5, "VIEWS_FROM_ONE_PLACE", id="all-from-one-place"),
    ],
)
def test_views_that_say_too_little_are_rejected_and_nothing_is_kept(
    server: Server, views: slice | list[int], code: str
) -> None:
    case_id = open_a_case(server)
    _, images = shown()
    server.ask("POST", "/api/camera/collection", 201, json={"board": DOTS})
    some = images[views] if isinstance(views, slice) else [images[index] for index in views]
    for image in some:
        server.ask("POST", "/api/camera/collection/images", 201, content=png(image))
    answer = server.door.post("/api/camera/calibration", json={"made_by": "ito"})
    is_started = answer.status_code == 202
    problem = server.done(answer.json())["problem"] if is_started else answer.json()
    assert problem["code"] == code, problem
    assert problem["remedy"]
    assert server.ask("GET", f"/api/cases/{case_id}/documents", 200)["documents"] == []


@pytest.mark.parametrize(
    ("content", "code"),
    [
        pytest.param(b"", "UPLOAD_EMPTY", id="nothing"),
        pytest.param(b"this is text", "IMAGE_UNREADABLE", id="text"),
        pytest.param(
            b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\xea\x60\0\0\xea\x60\x08\x02\0\0\0\x0f\xb0\xe2\x15",
            "IMAGE_UNREADABLE",
            id="says-it-has-60000-by-60000-px",
        ),
        pytest.param(png(np.full((200, 300), 128, np.uint8)), "BOARD_NOT_FOUND", id="no-board-in-it"),
    ],
)
def test_an_image_that_cannot_be_used_is_rejected(server: Server, content: bytes, code: str) -> None:
    server.ask("POST", "/api/camera/collection", 201, json={"board": DOTS})
    answer = server.ask("POST", "/api/camera/collection/images", 422, content=content)
    assert answer["code"] == code


def test_without_an_open_case_nothing_is_computed(server: Server) -> None:
    server.ask("POST", "/api/camera/collection", 201, json={"board": DOTS})
    rejected = server.ask("POST", "/api/camera/calibration", 409, json={"made_by": "ito"})
    assert rejected["code"] == "NO_CASE_OPEN"
    assert server.ask("GET", "/api/jobs", 200) == {"jobs": []}


def test_a_board_that_cannot_be_is_rejected_with_what_is_allowed(server: Server) -> None:
    board = {**DOTS, "fiducials": [900]}
    rejected = server.ask("POST", "/api/camera/collection", 422, json={"board": board})
    assert rejected["code"] == "BOARD_INVALID"
    assert "0 to 139" in rejected["message"]
