"""The guided accuracy test through the API, with the poses of a simulated tool on a plate."""

from dataclasses import replace
from typing import Any

import numpy as np
import pytest

from server.certificate import PlateFile, text_of_plate_file, verified
from server.procedure.divot_capture import MAX_CAPTURE_S
from server.store import DocumentKind
from tests.procedure.conftest import Server
from tests.procedure.patient import marker_seen
from tests.procedure.test_camera_step import open_a_case
from tests.tracker.accuracy.test_accuracy_assessment import POINTS, SOUND
from tracker.accuracy import DivotPlate
from tracker.accuracy.rehearsed import RehearsedCapture, RehearsedFaults, RehearsedSystem, rehearse
from tracker.geometry import Rigid
from tracker.pose import Seen

# The fewest divots of which two placements are enough.
DIVOTS = ("1", "3", "5", "7", "9")
PLATE = DivotPlate(name="five", points_mm={name: POINTS[name] for name in DIVOTS}, sd_mm=0.1)
SYSTEM = replace(SOUND, plate=PLATE, images=6)
PLATE_TEXT = text_of_plate_file(
    PlateFile(
        name="five",
        sd_mm=0.1,
        rulers_mm=100.0,
        divots={name: list(point) for name, point in PLATE.points_mm.items()},
    )
)
REQUEST = {"tool": "drill", "plate": PLATE_TEXT, "rulers_mm": [100.0, 100.0], "ruler_sd_mm": 0.1}
BASE = "/api/certificates/collection"
# Six images last longer than a capture.
INTERVAL_S = 0.21


def put_documents(server: Server, system: RehearsedSystem) -> str:
    """Open a case with the calibrated camera and tool of a system."""
    case_id, camera, tool = open_a_case(server), system.stated_camera, system.tool
    put_camera(server, case_id, system)
    pivot = {
        "tip_in_marker_mm": tool.tip_in_marker_mm.tolist(),
        "covariance_mm2": tool.tip_covariance_mm2.tolist(),
        "rms_3d_mm": 0.1,
        "used": 60,
        "rejected": 0,
        "tilt_range_deg": 60.0,
        "made_at": "2026-01-01T00:00:00Z",
    }
    record = {
        "marker": "drill",
        "side_mm": system.side_mm,
        "pivot": pivot,
        "axis_in_marker": [0.0, -1.0, 0.0],
        "radius_mm": 2.0,
        "length_mm": 118.0,
    }
    server.store.put(case_id, DocumentKind.TOOL, "drill", record, made_by="test")
    assert server.adopted[-1].camera is not None
    assert server.adopted[-1].camera.size_wh_px == camera.size_wh_px
    return case_id


def put_camera(server: Server, case_id: str, system: RehearsedSystem) -> None:
    camera = system.stated_camera
    values = {
        "matrix": camera.matrix.tolist(),
        "distortion": camera.distortion.tolist(),
        "size_wh_px": list(camera.size_wh_px),
        "source": "rehearsal",
    }
    server.store.put(case_id, DocumentKind.CAMERA, "main", {"camera": values}, made_by="test")


class Bench:
    """A plate before the camera of a server, and a tool whose tip is held in its divots."""

    def __init__(self, server: Server, system: RehearsedSystem = SYSTEM) -> None:
        self.server = server
        self.case_id = put_documents(server, system)
        self.performed = rehearse(system, seed=0)
        self._at_s = 0.0
        self.show(None)

    def begin(self) -> Any:  # noqa: ANN401  JSON
        return self.server.ask("POST", BASE, 201, json=REQUEST)

    def state(self) -> Any:  # noqa: ANN401  JSON
        return self.server.ask("GET", BASE, 200)

    def show(self, seen: Seen | None, interval_s: float = INTERVAL_S) -> None:
        """Publish one image, and wait until an active capture has processed it."""
        self._at_s += interval_s
        before = self._processed()
        self.server.show(at_s=self._at_s, seen=seen)
        if before is not None:
            self.server.until(lambda: self._processed() != before)

    def _processed(self) -> tuple[int, str] | None:
        step = self.server.steps.accuracy
        capture = step.collection.status.capture if step.is_collecting else None
        return None if capture is None or capture.state != "looking" else (capture.images, capture.state)

    def capture(self, one: RehearsedCapture, status: int = 202) -> Any:  # noqa: ANN401  JSON
        """Request this capture."""
        names = {"placement": one.placement, "divot": one.divot, "posture": one.posture}
        return self.server.ask("POST", f"{BASE}/captures", status, json=names)

    def hold(self, one: RehearsedCapture, step_mm: float = 0.0) -> Any:  # noqa: ANN401  JSON
        """Capture the tool as it was held, or moving on by this much in each image; return the state."""
        self.capture(one)
        for number in range(len(one.poses)):
            self.show(seen_in(one, number, off_mm=number * step_mm))
        return self.finished()

    def finished(self) -> Any:  # noqa: ANN401  JSON
        """Wait for the end of the capture; return the state."""
        self.server.until(lambda: self._processed() is None)
        return self.state()

    def perform(self, count: int) -> Any:  # noqa: ANN401  JSON
        """Take this many captures from where the test is; return the state."""
        taken = self.state()["taken"]
        for one in self.performed[taken : taken + count]:
            state = self.hold(one)
            assert state["capture"]["problem"] is None, state["capture"]
        return state


def seen_in(one: RehearsedCapture, number: int, off_mm: float) -> Seen:
    poses = one.poses
    assert poses.covariances is not None
    pose = Rigid(
        rotation=poses.rotations[number],
        translation_mm=poses.translations_mm[number] + np.array([off_mm, 0.0, 0.0]),
    )
    return replace(marker_seen(pose), pose_covariance=poses.covariances[number])


def test_a_sound_tool_is_certified_from_the_first_divot_to_the_installed_certificate(server: Server) -> None:
    bench = Bench(server)
    begun = bench.begin()
    assert (begun["planned"], begun["taken"]) == (30, 0)
    assert [one["name"] for one in begun["divots"]] == list(DIVOTS)
    assert begun["due"] == {"placement": "near", "divot": "1", "posture": "upright"}
    half = bench.perform(15)
    assert half["due"] == {"placement": "far", "divot": "1", "posture": "upright"}
    assert (half["error_95_mm"], half["problems"]) == (None, []), "no figures of an incomplete test"
    done = bench.perform(15)
    assert (done["due"], done["problems"]) == (None, [])
    assert 0.0 < done["last"]["jitter_mm"] < 0.5
    issued = server.ask("POST", f"{BASE}/conclusion", 201, json={"made_by": "ito", "valid_days": 30})
    assert issued["error_95_mm"] == done["error_95_mm"]
    stored = server.ask("GET", "/api/certificates", 200)
    assert not stored["collecting"]
    (drill,) = stored["tools"]
    assert (drill["certified"], drill["problem"], drill["issued_by"]) == (True, None, "ito")
    certificate = verified(server.door.get("/api/certificates/drill/json").content).certificate
    assert (certificate.captures, certificate.placements, certificate.divots) == (30, 2, 5)
    assert certificate.camera.source == "rehearsal"


def test_a_tip_that_is_one_millimetre_off_is_refused_by_name(server: Server) -> None:
    bench = Bench(server, replace(SYSTEM, faults=RehearsedFaults(tip_offset_mm=1.0)))
    bench.begin()
    problems = bench.perform(30)["problems"]
    assert problems[0]["code"] == "ACCURACY_TIP_OFFSET"
    rejection = server.ask("POST", f"{BASE}/conclusion", 409, json={"made_by": "ito"})
    assert rejection == problems[0]
    assert server.ask("GET", "/api/certificates", 200)["tools"][0]["problem"]["code"] == "CERTIFICATE_MISSING"
    # It stays, so that it can be read, and no figure is got rid of by another attempt to issue.
    assert bench.state()["taken"] == 30


def test_only_the_capture_that_is_due_is_taken(server: Server) -> None:
    bench = Bench(server)
    assert bench.capture(bench.performed[0], 409)["code"] == "COLLECTION_MISSING"
    bench.begin()
    assert server.ask("DELETE", f"{BASE}/captures/last", 409)["code"] == "ACCURACY_NOTHING_CAPTURED"
    for wrong in (bench.performed[1], bench.performed[3], bench.performed[15]):
        assert bench.capture(wrong, 409)["code"] == "ACCURACY_CAPTURE_ORDER"
    bench.perform(2)
    assert bench.capture(bench.performed[1], 409)["code"] == "ACCURACY_CAPTURE_ORDER"
    incomplete = server.ask("POST", f"{BASE}/conclusion", 409, json={"made_by": "ito"})
    assert incomplete["code"] == "ACCURACY_TEST_INCOMPLETE"
    assert server.ask("DELETE", f"{BASE}/captures/last", 200)["due"]["posture"] == "tilted"
    assert bench.perform(1)["taken"] == 2


def test_captures_that_are_none_are_rejected_with_the_reason(server: Server) -> None:
    bench = Bench(server)
    bench.begin()
    first, second = bench.performed[:2]

    assert bench.hold(first, step_mm=2.0)["capture"]["problem"]["code"] == "ACCURACY_CAPTURE_MOVED"

    bench.capture(first)
    for _ in range(3):
        bench.show(None, interval_s=MAX_CAPTURE_S / 2.0)
    assert bench.finished()["capture"]["problem"]["code"] == "ACCURACY_TIP_UNSEEN"

    bench.capture(first)
    for number in range(3):
        bench.show(seen_in(first, number, 0.0), interval_s=MAX_CAPTURE_S / 2.0)
    assert bench.finished()["capture"]["problem"]["code"] == "ACCURACY_CAPTURE_SHORT"

    assert bench.hold(first)["taken"] == 1
    still_upright = replace(first, posture=second.posture)
    rejected = bench.hold(still_upright)
    assert (rejected["capture"]["problem"]["code"], rejected["taken"]) == ("ACCURACY_POSTURE_REPEATED", 1)


def test_a_tip_in_another_divot_is_rejected_before_the_next_one(server: Server) -> None:
    bench = Bench(server)
    bench.begin()
    bench.perform(12)
    # Due is divot 9, but the tip is in divot 5.
    elsewhere = replace(bench.performed[7], divot="9", posture="upright")
    state = bench.hold(elsewhere)
    assert (state["capture"]["problem"]["code"], state["taken"]) == ("ACCURACY_WRONG_DIVOT", 12)
    assert bench.hold(bench.performed[12])["taken"] == 13


def test_another_calibration_ends_the_test(server: Server) -> None:
    bench = Bench(server)
    bench.begin()
    bench.perform(1)
    faults = RehearsedFaults(focal_error_ratio=0.01)
    put_camera(server, bench.case_id, replace(SYSTEM, faults=faults))
    bench.show(None)
    state = bench.hold(bench.performed[1])
    assert (state["taken"], state["capture"]["state"]) == (1, "rejected")
    assert state["capture"]["problem"]["code"] == "ACCURACY_SYSTEM_CHANGED"


@pytest.mark.parametrize(
    ("changed", "status", "code"),
    [
        pytest.param({"rulers_mm": None}, 409, "ACCURACY_PLATE_UNMEASURED", id="rulers-not-measured"),
        pytest.param({"rulers_mm": [98.0, 98.0]}, 409, "ACCURACY_PLATE_SCALE", id="printed-to-fit"),
        pytest.param({"rulers_mm": [10.0, 10.0]}, 422, "PLATE_RULERS_INVALID", id="rulers-in-cm"),
        pytest.param({"plate": "a: ["}, 422, "PLATE_FILE_UNREADABLE", id="no-yaml"),
        pytest.param({"plate": "{name: x}"}, 422, "PLATE_FILE_INVALID", id="no-plate"),
        pytest.param({"tool": "awl"}, 422, "TOOL_UNKNOWN", id="tool-not-in-use"),
    ],
)
def test_what_cannot_be_certified_is_not_begun(
    server: Server, changed: dict[str, Any], status: int, code: str
) -> None:
    Bench(server)
    assert server.ask("POST", BASE, status, json={**REQUEST, **changed})["code"] == code


def test_the_default_plate_is_the_printed_one(server: Server) -> None:
    bench = Bench(server)
    begun = server.ask("POST", BASE, 201, json={"tool": "drill", "rulers_mm": [100.0, 100.0]})
    assert (begun["plate"], begun["planned"]) == ("A4-3x3", 54)
    assert server.door.get("/api/certificates/plate.pdf").content.startswith(b"%PDF")
    assert bench.state()["taken"] == 0
