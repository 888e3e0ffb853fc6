"""The camera's readout time, stated or measured through the API, and its use in tracking."""

from collections.abc import Callable

import numpy as np
import pytest

from server.procedure import readout_collection
from server.procedure.camera import MAIN_CAMERA
from server.store import DocumentKind
from tests.procedure.conftest import Server
from tests.procedure.test_camera_step import open_a_case
from tests.tracker.camera.moving_board import BOARD, CAMERA, image_at, shaken
from tracker.camera import CameraModel

BY = {"made_by": "ito"}
DOTS = {
    "pattern": "dots",
    "columns": BOARD.columns,
    "rows": BOARD.rows,
    "pitch_mm": BOARD.pitch_mm,
    "fiducials": list(BOARD.fiducials),
}
READOUT = "/api/camera/readout"


def used(server: Server) -> float | None:
    return server.adopted[-1].readout_ms


def _has(server: Server, key: str, value: object) -> Callable[[], bool]:
    """Whether the burst has reached this stage."""
    return lambda: bool(server.ask("GET", f"{READOUT}/collection", 200)[key] == value)


@pytest.fixture
def calibrated(server: Server) -> Server:
    _keep_calibration(server, open_a_case(server), CAMERA)
    return server


def _keep_calibration(server: Server, case_id: str, model: CameraModel) -> None:
    camera = {
        "matrix": model.matrix.tolist(),
        "distortion": model.distortion.tolist(),
        "size_wh_px": list(model.size_wh_px),
        "source": "rehearsal",
    }
    server.store.put(
        case_id, DocumentKind.CAMERA, MAIN_CAMERA, {"camera": camera, "report": {}}, made_by="ito"
    )


def test_it_is_unknown_until_stated_and_then_used_at_once(calibrated: Server) -> None:
    assert calibrated.ask("GET", READOUT, 200) == {
        "collecting": False,
        "readout_ms": None,
        "sd_ms": None,
        "found_by": None,
    }
    assert used(calibrated) is None
    reported = calibrated.ask("PUT", READOUT, 200, json={"readout_ms": 16.5, **BY})
    assert (reported["readout_ms"], reported["sd_ms"], reported["found_by"]) == (16.5, None, "stated")
    assert used(calibrated) == 16.5
    assert calibrated.adopted[-1].camera is not None
    calibrated.ask("PUT", READOUT, 200, json={"readout_ms": None, **BY})
    assert used(calibrated) is None
    for wrong in (-1.0, 201.0):
        calibrated.ask("PUT", READOUT, 422, json={"readout_ms": wrong, **BY})


def test_without_a_calibration_there_is_nothing_to_keep_it_with(server: Server) -> None:
    assert server.ask("PUT", READOUT, 409, json={"readout_ms": 16.5, **BY})["code"] == "NO_CASE_OPEN"
    open_a_case(server)
    rejected = server.ask("POST", f"{READOUT}/collection", 409, json={"board": DOTS})
    assert rejected["code"] == "DOCUMENT_MISSING"
    assert server.ask("GET", f"{READOUT}/collection", 409)["code"] == "COLLECTION_MISSING"


def _burst(server: Server, *, readout_s: float, sideways_mm: float = 25.0) -> None:
    """Show a board that rests and then moves, each image after the previous one was processed."""
    server.ask("POST", f"{READOUT}/collection", 201, json={"board": DOTS})
    motion = shaken(sideways_mm=sideways_mm)

    server.show(at_s=0.0, image=_bgr(image_at(motion, 0.0, readout_s=0.0)))
    server.until(_has(server, "stage", "move"))
    server.show(at_s=0.05, image=_bgr(image_at(motion, 0.08, readout_s=0.0)))
    server.until(_has(server, "stage", "taking"))
    for number in range(readout_collection.BURST_IMAGES):
        at_s = 1.0 + number / 30.0
        server.show(at_s=at_s, image=_bgr(image_at(motion, at_s, readout_s=readout_s)))
        server.until(_has(server, "taken_images", number + 1))
    rejected = server.ask("POST", f"{READOUT}/measurement", 409, json=BY)
    assert rejected["code"] == "COLLECTION_UNREADY"
    for number in range(readout_collection.BURST_IMAGES):
        server.show(at_s=5.0 + number / 30.0, image=None)
        server.until(_has(server, "read_images", number + 1))
    assert _has(server, "stage", "ready")()


def _bgr(grey: np.ndarray) -> np.ndarray:
    return np.repeat(grey[:, :, None], 3, axis=2)


def test_a_shaken_board_measures_it_and_it_is_kept_with_its_spread(
    calibrated: Server, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(readout_collection, "BURST_IMAGES", 17)
    _burst(calibrated, readout_s=0.02)
    job = calibrated.done(calibrated.ask("POST", f"{READOUT}/measurement", 202, json=BY))
    assert job["state"] == "done", job["problem"]
    reported = calibrated.ask("GET", READOUT, 200)
    assert reported["found_by"] == "measured"
    assert not reported["collecting"]
    assert abs(reported["readout_ms"] - 20.0) < 3.0 * reported["sd_ms"]
    assert calibrated.adopted[-1].readout_ms == reported["readout_ms"]


def test_what_does_not_determine_it_is_rejected_and_nothing_is_kept(
    calibrated: Server, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr(readout_collection, "BURST_IMAGES", 3)
    _burst(calibrated, readout_s=0.0)
    job = calibrated.done(calibrated.ask("POST", f"{READOUT}/measurement", 202, json=BY))
    assert job["problem"]["code"] == "READOUT_TOO_FEW_IMAGES"
    assert calibrated.ask("GET", READOUT, 200)["readout_ms"] is None


def test_a_burst_of_another_size_than_the_calibrations_is_rejected(
    server: Server, monkeypatch: pytest.MonkeyPatch
) -> None:
    width, height = CAMERA.size_wh_px
    _keep_calibration(server, open_a_case(server), CAMERA.scaled_to((2 * width, 2 * height)))
    monkeypatch.setattr(readout_collection, "BURST_IMAGES", 3)
    _burst(server, readout_s=0.02)
    rejected = server.ask("POST", f"{READOUT}/measurement", 409, json=BY)
    assert rejected["code"] == "CAMERA_SIZE_MISMATCH"
    assert f"{width}x{height} px" in rejected["message"]
    assert f"{2 * width}x{2 * height} px" in rejected["message"]


def test_a_burst_with_a_pause_in_it_is_ended(calibrated: Server) -> None:
    calibrated.ask("POST", f"{READOUT}/collection", 201, json={"board": DOTS})
    motion = shaken(sideways_mm=25.0)
    stages = ("move", "taking")
    for at_s, stage in zip((0.0, 0.08), stages, strict=True):
        calibrated.show(at_s=at_s, image=_bgr(image_at(motion, at_s, readout_s=0.0)))
        calibrated.until(_has(calibrated, "stage", stage))
    for at_s in (1.0, 2.0):
        calibrated.show(at_s=at_s, image=_bgr(image_at(motion, at_s, readout_s=0.0)))
        calibrated.until(_has(calibrated, "taken_images", 1))
    calibrated.until(lambda: calibrated.ask("GET", f"{READOUT}/collection", 200)["problem"] is not None)
    problem = calibrated.ask("GET", f"{READOUT}/collection", 200)["problem"]
    assert problem["code"] == "READOUT_INTERRUPTED"
