"""Latency measurement through the API: codes read in live images, timed by a page's clock, and stored."""

import json
import time
from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from server.latency import CodeReader, plan_codes
from server.live import LiveHub
from server.procedure.latency import LatencyMeasurement, LatencyStep
from server.store import CaseStore, Home
from server.store.latency_file import LatencyFile
from tests.procedure.conftest import Server
from tests.server.latency.test_code_reading import drawn, filmed, screen
from tracker.navigation import MeasuredLatency, NavigationSnapshot

MEASUREMENT = "/api/latency/measurement"
CONCLUSION = f"{MEASUREMENT}/conclusion"
RATE_HZ = 25.0
PERIOD_MS = 1000.0 / RATE_HZ
# Offset of the server's clock from the page's.
BEHIND_MS = 9000.0
CODES = 20
# Time from painting a code to the image that shows it.
LATENCY_MS = 70.0
MEASURED = MeasuredLatency(p99_ms=LATENCY_MS, size_wh_px=(1280, 720), image_period_ms=PERIOD_MS)
SCREEN = {"width_px": 1280, "height_px": 800, "period_ms": 16.7}


def show(server: Server, number: int, image: np.ndarray | None = None) -> NavigationSnapshot:
    """An image of a camera of 25 Hz."""
    return server.show(at_s=number * PERIOD_MS / 1000.0, image=image, rate_hz=RATE_HZ)


def begun(server: Server, codes: int = CODES) -> dict[str, Any]:
    show(server, 0, np.zeros((360, 640, 3), np.uint8))
    reported: dict[str, Any] = server.ask("POST", MEASUREMENT, 201, json={"codes": codes})
    return reported


def looked(server: Server) -> int:
    return int(server.ask("GET", MEASUREMENT, 200)["examined_images"])


def until_looked_after(server: Server, before: int) -> None:
    server.until(lambda: looked(server) > before)


def film(server: Server, codes: list[int]) -> dict[str, Any]:
    """Publish an image of each code, wait until it was read, and return the page's notes."""
    painted, shown = [], []
    for place, code in enumerate(codes):
        before = looked(server)
        small = filmed(screen((drawn(code, 48), 320, 40), size_wh_px=(1280, 720)), seed=place)[::2, ::2]
        snapshot = show(server, place, np.ascontiguousarray(small))
        until_looked_after(server, before)
        captured_s = snapshot.captured_at_s
        at_ms = captured_s * 1000.0 + BEHIND_MS
        painted.append({"code": code, "painted_at_ms": at_ms + 20.0 - LATENCY_MS})
        shown.append(
            {
                "image_number": snapshot.image_number,
                "sent_at_s": captured_s + 0.008,
                "received_at_ms": at_ms + 12.0,
                "shown_at_ms": at_ms + 20.0,
            }
        )
    compared = [
        {
            "requested_at_ms": BEHIND_MS + at,
            "responded_at_ms": BEHIND_MS + at + 2.0,
            "server_s": (at + 1.0) / 1e3,
        }
        for at in (0.0, 500.0)
    ]
    return {"made_by": "ito", "painted": painted, "shown": shown, "comparisons": compared, "screen": SCREEN}


def test_a_latency_is_measured_stored_and_sent_to_all_clients(server: Server) -> None:
    assert server.ask("GET", "/api/latency", 200) == {"measuring": False, "result": None, "applies": False}
    plan = begun(server)
    assert (plan["cells"], len(plan["patterns"]), plan["codes"], plan["min_timed"]) == (4, 250, CODES, 13)
    assert (plan["min_code_ms"], plan["max_code_ms"]) == (100.0, 150.0)
    said = film(server, list(range(CODES)))
    reported = server.ask("GET", MEASUREMENT, 200)
    assert (reported["running"], reported["read_images"], reported["problem"]) == (True, CODES, None)
    result = server.ask("POST", CONCLUSION, 201, json=said)
    report = result["report"]
    assert (report["samples"], report["median_ms"], report["p99_ms"]) == (CODES - 1, LATENCY_MS, LATENCY_MS)
    assert report["stage_ms"] == {
        "screen and camera": 50.0,
        "tracking": 0.0,
        "server": 8.0,
        "line": 4.0,
        "page": 8.0,
    }
    assert (report["image_period_ms"], report["clock_error_ms"]) == (40.0, 1.0)
    assert (result["camera"], result["width_px"], result["height_px"], result["rate_hz"]) == (
        "rehearsal",
        1280,
        720,
        25.0,
    )
    assert (result["made_by"], result["screen"]) == ("ito", SCREEN)
    assert server.ask("GET", "/api/latency", 200) == {"measuring": False, "result": result, "applies": True}
    # Included in each message from the next image on, also without a case.
    assert server.adopted[-1].latency == MEASURED


def test_a_result_outlasts_a_start_of_the_server(server: Server, restarted: Callable[[], Server]) -> None:
    begun(server)
    result = server.ask("POST", CONCLUSION, 201, json=film(server, list(range(CODES))))
    again = restarted()
    assert again.ask("GET", "/api/latency", 200)["result"] == result
    assert again.adopted[-1].latency == MEASURED


def test_a_result_does_not_apply_to_images_of_another_size_or_a_lower_rate(server: Server) -> None:
    begun(server)
    server.ask("POST", CONCLUSION, 201, json=film(server, list(range(CODES))))
    applies = []
    for rate_hz, size_wh_px in [(60.0, (1280, 720)), (15.0, (1280, 720)), (25.0, (640, 360))]:
        server.show(at_s=9.0, rate_hz=rate_hz)
        newest = server.hub.newest
        assert newest is not None
        assert newest.snapshot is not None
        server.hub.publish(replace(newest, snapshot=replace(newest.snapshot, size_wh_px=size_wh_px)))
        applies.append(server.ask("GET", "/api/latency", 200)["applies"])
    assert applies == [True, False, False]


def test_a_camera_that_looks_elsewhere_is_rejected_in_numbers_and_leaves_what_was_kept(
    server: Server,
) -> None:
    begun(server)
    stored = server.ask("POST", CONCLUSION, 201, json=film(server, list(range(CODES))))
    begun(server)
    said = film(server, list(range(5)))
    black = np.zeros((360, 640, 3), np.uint8)
    for number in range(6, 30):
        before = looked(server)
        last = show(server, number, black + np.uint8(number)).image_number
        until_looked_after(server, before)
        said["shown"].append({**said["shown"][-1], "image_number": last})
    rejected = server.ask("POST", CONCLUSION, 409, json=said)
    assert rejected["code"] == "LATENCY_CODE_NOT_READ"
    assert rejected["message"] == "the code was read in 5 of 29 images, the minimum is 13"
    assert rejected["remedy"].startswith("Point the camera at the screen, darken the room")
    assert server.ask("GET", "/api/latency", 200) == {"measuring": False, "result": stored, "applies": True}
    assert server.ask("POST", CONCLUSION, 409, json=said)["code"] == "COLLECTION_MISSING"


def test_without_images_nothing_is_measured(server: Server) -> None:
    assert server.ask("POST", MEASUREMENT, 503, json={})["code"] == "NO_PICTURE"
    assert server.ask("GET", MEASUREMENT, 409)["code"] == "COLLECTION_MISSING"
    server.ask("DELETE", MEASUREMENT, 204)


@pytest.mark.parametrize(
    "changed",
    [
        pytest.param({"codes": 1000}, id="more-codes-than-there-are"),
        pytest.param({"codes": 2}, id="too-few-to-say-anything"),
        pytest.param({"count": 20}, id="a-word-that-is-not-known"),
    ],
)
def test_a_plan_that_cannot_be_is_rejected(server: Server, changed: dict[str, Any]) -> None:
    begun(server)
    assert server.ask("POST", MEASUREMENT, 422, json=changed)["code"] == "REQUEST_INVALID"


def test_a_stop_ends_it(server: Server) -> None:
    begun(server)
    assert server.ask("GET", "/api/latency", 200)["measuring"] is True
    server.ask("DELETE", MEASUREMENT, 204)
    assert server.ask("GET", MEASUREMENT, 409)["code"] == "COLLECTION_MISSING"
    assert server.ask("GET", "/api/latency", 200)["measuring"] is False


@pytest.mark.parametrize("end", ["close", "another"])
def test_a_closed_case_ends_it(server: Server, end: str) -> None:
    case = server.ask("POST", "/api/cases", 201, json={"name": "L3"})
    server.ask("POST", f"/api/cases/{case['id']}/open", 200)
    begun(server)
    said = film(server, [0, 1])
    # Changes of the case itself end nothing.
    server.ask("PATCH", f"/api/cases/{case['id']}", 200, json={"name": "L4"})
    film(server, [2])
    if end == "close":
        server.ask("POST", f"/api/cases/{case['id']}/close", 200)
    else:
        other = server.ask("POST", "/api/cases", 201, json={"name": "L5"})
        server.ask("POST", f"/api/cases/{other['id']}/open", 200)
    show(server, 4, np.zeros((360, 640, 3), np.uint8))
    server.until(lambda: not server.ask("GET", MEASUREMENT, 200)["running"])
    assert server.ask("GET", MEASUREMENT, 200)["problem"]["code"] == "LATENCY_CASE_CHANGED"
    assert server.ask("POST", CONCLUSION, 409, json=said)["code"] == "LATENCY_CASE_CHANGED"


def test_a_page_that_left_ends_it(server: Server) -> None:
    now_s = [100.0]
    begun(server)
    plan = plan_codes(CODES, rate_hz=RATE_HZ)
    measurement = LatencyMeasurement(server.hub, plan, clock=lambda: now_s[0])
    show(server, 1, np.zeros((360, 640, 3), np.uint8))
    server.until(lambda: len(measurement.read) == 1)
    assert measurement.status().running
    now_s[0] = 104.9
    show(server, 2, np.zeros((360, 640, 3), np.uint8))
    server.until(lambda: len(measurement.read) == 2)
    now_s[0] = 110.0
    show(server, 3, np.zeros((360, 640, 3), np.uint8))
    server.until(lambda: not measurement._listener.running)
    problem = measurement.status().problem
    assert problem is not None
    assert problem.code == "LATENCY_PAGE_LEFT"
    assert problem.message == "the page that shows the codes was silent for 10.0 s, limit 5 s"
    measurement.stop()


def test_no_codes_are_read_without_a_measurement(server: Server, monkeypatch: pytest.MonkeyPatch) -> None:
    reads: list[float] = []
    read = CodeReader.read

    def counted(self: CodeReader, image: np.ndarray) -> int | None:
        reads.append(time.monotonic())
        return read(self, image)

    monkeypatch.setattr(CodeReader, "read", counted)
    begun(server)
    film(server, [0])
    server.ask("DELETE", MEASUREMENT, 204)
    while_measured = len(reads)
    assert while_measured >= 1
    show(server, 5, np.zeros((360, 640, 3), np.uint8))
    show(server, 6, np.zeros((360, 640, 3), np.uint8))
    assert len(reads) == while_measured


def test_a_damaged_file_of_latencies_is_none(tmp_path: Path) -> None:
    with Home(tmp_path / "home") as home, CaseStore(home) as store:
        (home.folder / "latency.json").write_text(json.dumps({"form": 1, "results": [{"at": "now"}]}))
        file = LatencyFile(home.folder)
        assert file.results() == ()
        assert LatencyStep(hub=LiveHub(), store=store, file=file, camera="camera 0").newest() is None
