"""Marker pictures through the API: sent, detected, replaced and removed."""

import numpy as np
import pytest

from server.image_file import png_bytes
from server.loop.tracking import Tracking
from server.store import DocumentKind
from tests.procedure.conftest import Server
from tests.procedure.test_camera_step import open_a_case
from tests.procedure.test_tool_step import SHAPE, calibrated, gather
from tracker.rehearsal import Scene, Theatre, TheatreSettings

BY = {"made_by": "ito"}
AWL = {**BY, "name": "awl", "side_mm": 25.0}


def picture(turn: int = 0) -> np.ndarray:
    """Picture of a marker that no other test has."""
    other = Theatre(TheatreSettings(reference=True)).reference
    assert other is not None
    return np.ascontiguousarray(np.rot90(other.image, turn))


def arrow() -> np.ndarray:
    """Picture of a marker that equals its mirror image."""
    image = np.zeros((100, 100), np.uint8)
    image[15:85, 15:85] = 255
    image[25:76, 45:55] = image[25:41, 25:75] = 0
    return image


def names(server: Server) -> dict[str, bool]:
    """The tracked markers, and whether they are stored in the case."""
    reported = server.ask("GET", "/api/markers", 200)["markers"]
    return {one["name"]: one["document_id"] is not None for one in reported}


def of_case(server: Server) -> list[str]:
    """The markers that the case adds to those of the settings."""
    return [model.name for model in server.adopted[-1].models]


def send(
    server: Server, status: int = 201, image: np.ndarray | None = None, **changed: object
) -> dict[str, object]:
    content = png_bytes(picture() if image is None else image)
    reported: dict[str, object] = server.ask(
        "POST", "/api/markers", status, content=content, params={**AWL, **changed}
    )
    return reported


def test_marker_that_was_sent_is_looked_for_and_shown(server: Server) -> None:
    open_a_case(server)
    assert names(server) == {"drill": False}
    reported = send(server)
    assert (reported["side_mm"], reported["width_px"], reported["made_by"]) == (25.0, 400, "ito")
    assert names(server) == {"drill": False, "awl": True}
    (model,) = server.adopted[-1].models
    assert (model.name, model.side_mm) == ("awl", 25.0)
    np.testing.assert_array_equal(model.image, picture())
    shown = server.door.get("/api/markers/awl/picture")
    assert shown.headers["content-type"] == "image/png"
    assert shown.content == png_bytes(picture())
    tracked = server.preparation.with_case(server.adopted[-1])
    assert [model.name for model in tracked.models] == ["drill", "awl"]


def test_tracking_looks_for_it_from_the_next_image_on(server: Server) -> None:
    open_a_case(server)
    send(server)
    tracking = Tracking(server.preparation)
    tracking.adopt(server.adopted[-1])
    tracking.prepare((320, 240), 0.0)
    assert tracking._tracker is not None
    sightings = tracking._tracker.step(np.zeros((240, 320), dtype=np.uint8), captured_at_s=0.0)
    assert set(sightings) == {"drill", "awl"}


def test_marker_goes_with_its_case_and_by_being_taken_away(server: Server) -> None:
    case_id = open_a_case(server)
    send(server)
    server.ask("POST", f"/api/cases/{case_id}/close", 200)
    assert of_case(server) == []
    server.ask("POST", f"/api/cases/{case_id}/open", 200)
    assert of_case(server) == ["awl"]
    server.ask("DELETE", "/api/markers/awl", 204, params=BY)
    assert names(server) == {"drill": False}
    assert of_case(server) == []
    assert server.ask("DELETE", "/api/markers/awl", 404, params=BY)["code"] == "MARKER_UNKNOWN"


def test_marker_whose_picture_is_damaged_is_left_out_and_can_be_taken_away(server: Server) -> None:
    case_id = open_a_case(server)
    send(server)
    (stored,) = server.store.all(case_id, DocumentKind.MARKER)
    server.store.file(case_id, stored.files[0]).path.unlink()
    assert names(server) == {"drill": False}
    server.ask("DELETE", "/api/markers/awl", 204, params=BY)


@pytest.mark.parametrize(
    ("image", "changed", "status", "code"),
    [
        pytest.param(None, {"name": "drill"}, 409, "MARKER_OF_SETTINGS", id="a-name-of-the-settings"),
        pytest.param(np.full((100, 100), 90, np.uint8), {}, 422, "MARKER_IMAGE_FLAT", id="grey-all-over"),
        pytest.param(picture()[:200], {}, 422, "MARKER_IMAGE_NOT_SQUARE", id="half-of-it"),
        pytest.param(
            Theatre(TheatreSettings()).marker.image, {}, 422, "MARKERS_TOO_SIMILAR", id="as-another"
        ),
        pytest.param(arrow(), {}, 422, "MARKER_MIRROR_SYMMETRIC", id="its-own-mirror-image"),
        pytest.param(None, {"side_mm": 0.0}, 422, "REQUEST_INVALID", id="no-size"),
        pytest.param(None, {"name": "a b"}, 422, "REQUEST_INVALID", id="a-name-with-a-blank"),
    ],
)
def test_what_cannot_be_a_marker_is_rejected_and_nothing_changes(
    server: Server, image: np.ndarray | None, changed: dict[str, object], status: int, code: str
) -> None:
    open_a_case(server)
    reported = send(server, status, image, file="photo.png", **changed)
    assert reported["code"] == code
    if code.startswith("MARKER_IMAGE"):
        assert "the marker picture photo.png" in str(reported["message"])
    assert names(server) == {"drill": False}


def test_without_an_open_case_no_marker_is_taken(server: Server) -> None:
    assert send(server, 409)["code"] == "NO_CASE_OPEN"
    assert server.ask("DELETE", "/api/markers/awl", 409, params=BY)["code"] == "NO_CASE_OPEN"


@pytest.mark.parametrize("how", ["replaced", "removed"])
def test_tool_behind_a_changed_marker_is_out_of_date(server: Server, how: str) -> None:
    case_id = calibrated(server)
    send(server)
    gather(server, Scene.PIVOT, "pivot", marker="awl")
    server.ask("POST", "/api/tools/collection/conclusion", 201, json={**BY, **SHAPE})
    (tool,) = server.ask("GET", "/api/tools", 200)["tools"]
    assert (tool["name"], tool["from_settings"], tool["calibration"]["heading"]["current"]) == (
        "drill",
        False,
        True,
    )
    assert tool["calibration"]["content"]["side_mm"] == 25.0
    (marker,) = server.store.all(case_id, DocumentKind.MARKER)
    assert marker.id in tool["calibration"]["heading"]["depends_on"]
    if how == "replaced":
        send(server, side_mm=24.0)
    else:
        server.ask("DELETE", "/api/markers/awl", 204, params=BY)
    (tool,) = server.ask("GET", "/api/tools", 200)["tools"]
    assert not tool["calibration"]["heading"]["current"]
    assert "awl" in tool["calibration"]["heading"]["out_of_date"]
    assert server.adopted[-1].tools == {}


def test_gates_are_those_of_the_settings(server: Server) -> None:
    reported = server.ask("GET", "/api/gates", 200)
    assert reported["calibration"] == {"max_rms_px": 1.0, "max_error_mm": 0.5}
    assert reported["collecting"] == {"min_views": 12, "min_coverage_ratio": 0.75, "min_tilt_deg": 20.0}
    assert reported["tracker"]["accept_score_ratio"] == 0.7
    # As in the test's settings, not the default.
    assert reported["registration"]["capture_images"] == 4
