"""Tool calibration through the API, from rehearsed pivot and spin as seen by a tracker."""

from functools import cache
from typing import Any

import numpy as np
import pytest

from server.live import Instant, ProcessState, ProcessStatus, SourceState, SourceStatus
from server.store import DocumentKind
from tests.procedure.conftest import Server, sighting
from tests.procedure.test_camera_step import open_a_case
from tracker.rehearsal import Scene, Theatre, TheatreSettings

SHAPE = {"radius_mm": 2.0, "length_mm": 118.0}
# Everything about a theatre follows from its settings.
theatre_from_config = cache(Theatre)


def calibrated(server: Server) -> str:
    """An open case with the rehearsal's true camera."""
    case_id = open_a_case(server)
    camera = theatre_from_config(TheatreSettings()).camera
    values = {
        "matrix": camera.matrix.tolist(),
        "distortion": camera.distortion.tolist(),
        "size_wh_px": list(camera.size_wh_px),
        "source": "rehearsal",
    }
    server.store.put(case_id, DocumentKind.CAMERA, "main", {"camera": values}, made_by="test")
    return case_id


def gather(
    server: Server,
    scene: Scene,
    purpose: str,
    *,
    images: int = 400,
    seed: int = 1,
    marker: str = "drill",
    rate_hz: float = 10.0,
) -> dict[str, Any]:
    """Show a rehearsed motion until nothing is missing; return the state of the collection."""
    theatre = theatre_from_config(TheatreSettings(seed=seed, scene=scene))
    random = np.random.default_rng(5)
    server.ask(
        "POST", "/api/tools/collection", 201, json={"tool": "drill", "purpose": purpose, "marker": marker}
    )
    reported: dict[str, Any] = {}
    for index in range(images):
        at_s = index / rate_hz
        seen = sighting(theatre, at_s, random)
        server.show(at_s=at_s, seen=seen, beside={marker: seen})

        def looked_at(wanted: int = index + 1) -> bool:
            nonlocal reported
            reported = server.ask("GET", "/api/tools/collection", 200)
            return bool(
                reported["taken"] + sum(reported["rejected_images"].values()) >= wanted
                or not reported["running"]
            )

        server.until(looked_at)
        if not reported["missing"] or not reported["running"]:
            break
    return reported


def test_tip_and_axis_from_the_live_images_are_the_true_ones(server: Server) -> None:
    case_id = calibrated(server)
    truth = theatre_from_config(TheatreSettings()).tool.marker_from_tool
    reported = gather(server, Scene.PIVOT, "pivot")
    assert (reported["purpose"], reported["missing"]) == ("pivot", [])
    assert reported["tilt_range_deg"] > 30.0
    assert reported["tilt_range_across_deg"] > 30.0
    stored = server.ask("POST", "/api/tools/collection/conclusion", 201, json={"made_by": "ito", **SHAPE})
    tip = stored["content"]["pivot"]["tip_in_marker_mm"]
    assert np.linalg.norm(np.array(tip) - truth.translation_mm) < 0.5
    # The axis is not known yet.
    assert server.adopted[-1].tools == {}

    reported = gather(server, Scene.SPIN, "spin")
    assert reported["missing"] == []
    stored = server.ask("POST", "/api/tools/collection/conclusion", 201, json={"made_by": "ito"})
    assert stored["heading"]["version"] == 2
    tool = server.adopted[-1].tools["drill"]
    off_deg = np.degrees(
        np.arccos(np.clip(tool.marker_from_tool.rotation[:, 2] @ truth.rotation[:, 2], -1, 1))
    )
    assert off_deg < 0.2
    np.testing.assert_allclose(tool.marker_from_tool.translation_mm, tip)

    gather(server, Scene.PIVOT, "tip_check", seed=2)
    check = server.ask("POST", "/api/tools/collection/conclusion", 201, json={"made_by": "ito"})
    assert check["heading"]["kind"] == "check"
    assert check["content"]["rms_3d_mm"] < 0.5
    assert check["heading"]["depends_on"] == [stored["heading"]["id"]]
    documents = server.ask("GET", f"/api/cases/{case_id}/documents", 200)["documents"]
    assert all(one["current"] for one in documents if one["version"] == 2 or one["kind"] != "tool")


def test_a_new_camera_puts_the_tool_out_of_date(server: Server) -> None:
    case_id = calibrated(server)
    gather(server, Scene.PIVOT, "pivot")
    axis = {"axis_in_marker": [0.0, -1.0, 0.0]}
    server.ask("POST", "/api/tools/collection/conclusion", 201, json={"made_by": "ito", **SHAPE, **axis})
    assert list(server.adopted[-1].tools) == ["drill"]
    camera = server.store.latest(case_id, DocumentKind.CAMERA, "main")
    assert camera is not None
    server.store.put(case_id, DocumentKind.CAMERA, "main", camera.content, made_by="test")
    assert server.adopted[-1].tools == {}
    assert server.adopted[-1].camera is not None


def test_a_tool_that_was_hardly_tilted_is_rejected_with_its_numbers(server: Server) -> None:
    calibrated(server)
    reported = gather(server, Scene.OPERATION, "pivot", images=60)
    assert reported["missing"]
    rejected = server.ask("POST", "/api/tools/collection/conclusion", 409, json={"made_by": "ito", **SHAPE})
    assert rejected["remedy"]
    assert server.adopted[-1].tools == {}


def test_without_millimetres_no_pose_is_taken(server: Server) -> None:
    open_a_case(server)
    reported = gather(server, Scene.PIVOT, "pivot", images=3)
    assert not reported["running"]
    assert reported["problem"]["code"] == "CAMERA_NOT_CALIBRATED"


@pytest.mark.parametrize(
    ("requested", "status", "code"),
    [
        pytest.param({"tool": "drill", "purpose": "spin"}, 409, "TOOL_TIP_MISSING", id="spin-before-pivot"),
        pytest.param({"tool": "drill", "purpose": "tip_check"}, 409, "TOOL_TIP_MISSING", id="check-first"),
        pytest.param(
            {"tool": "awl", "purpose": "pivot", "marker": "nobody"},
            422,
            "MARKER_UNKNOWN",
            id="no-such-marker",
        ),
        pytest.param({"tool": "drill", "purpose": "SPIN"}, 409, "TOOL_TIP_MISSING", id="in-capitals"),
        pytest.param({"tool": "drill", "purpose": "drilling"}, 422, "REQUEST_INVALID", id="no-such-purpose"),
        pytest.param({"tool": "../x", "purpose": "pivot"}, 422, "REQUEST_INVALID", id="no-such-name"),
    ],
)
def test_what_cannot_be_begun_is_rejected(
    server: Server, requested: dict[str, str], status: int, code: str
) -> None:
    calibrated(server)
    assert server.ask("POST", "/api/tools/collection", status, json=requested)["code"] == code


def test_an_unknown_shape_is_requested(server: Server) -> None:
    calibrated(server)
    gather(server, Scene.PIVOT, "pivot")
    rejected = server.ask("POST", "/api/tools/collection/conclusion", 422, json={"made_by": "ito"})
    assert rejected["code"] == "TOOL_SHAPE_UNKNOWN"


def test_when_the_camera_is_gone_no_pose_seems_to_be_taken_any_more(server: Server) -> None:
    calibrated(server)
    assert gather(server, Scene.PIVOT, "pivot", images=5)["newest"] != "no_picture"
    gone = SourceStatus(name="0", state=SourceState.RECONNECTING)
    running = ProcessStatus(state=ProcessState.RUNNING)
    server.hub.publish(Instant(sequence=server.number + 1, source=gone, process=running))
    server.until(lambda: server.ask("GET", "/api/tools/collection", 200)["newest"] == "no_picture")
    reported = server.ask("GET", "/api/tools/collection", 200)
    assert (reported["running"], reported["problem"]) == (True, None), "it goes on when the camera is back"
