"""A slow camera captures landmarks, checks, and calibrates a tool; a rejection states the rate."""

from collections.abc import Callable
from contextlib import ExitStack
from pathlib import Path
from typing import Any

import pytest

from server.live import Instant, ProcessState, ProcessStatus, SourceState, SourceStatus
from tests.procedure.conftest import Server, serving
from tests.procedure.patient import DRILL, SPARE, USED, Patient, ready, withheld
from tests.procedure.test_tool_step import calibrated, gather
from tracker.rehearsal import Scene

POINTS = "/api/registration/points"
CHECK = "/api/registration/check"
# As in config.yaml.
SETTINGS = {"registration": {"capture_images": 12, "capture_s": 0.4}}


@pytest.fixture
def server(tmp_path: Path, turns: ExitStack) -> Server:
    return turns.enter_context(serving(tmp_path, SETTINGS))


def begun(server: Server, rate_hz: float) -> Patient:
    """A landmark session with a camera of this rate."""
    ready(server)
    patient = Patient(server=server, rate_hz=rate_hz)
    patient.show(None)
    server.ask("POST", POINTS, 201, json=DRILL)
    return patient


def sign_of_life(server: Server, state: SourceState = SourceState.RUNNING) -> None:
    """Time without messages between two images."""
    server.number += 1
    server.hub.publish(
        Instant(
            sequence=server.number,
            source=SourceStatus(name="rehearsal", state=state),
            process=ProcessStatus(state=ProcessState.RUNNING),
        )
    )


def hold(server: Server, patient: Patient, path: str, landmark: str, images: int) -> Any:  # noqa: ANN401  JSON
    """Hold the tip still for this many images; return the progress of the capture."""
    for _ in range(images):
        before = server.ask("GET", path, 200)["capture"]
        patient.show(patient.tip_on(landmark))
        server.until(_changed(server, path, before))
    return server.ask("GET", path, 200)["capture"]


def _changed(server: Server, path: str, before: dict[str, Any]) -> Callable[[], bool]:
    def changed() -> bool:
        now = server.ask("GET", path, 200)["capture"]
        return bool(now["state"] != "looking" or now["images"] > before["images"])

    return changed


@pytest.mark.parametrize("rate_hz", [3.0, 5.0, 10.0])
def test_landmarks_are_captured_and_checked_with_a_slow_camera(server: Server, rate_hz: float) -> None:
    ready(server)
    patient = Patient(server=server, rate_hz=rate_hz)
    patient.register(USED)
    check = patient.check()
    assert check["content"]["passed"] is True
    assert check["content"]["images"] == 12
    assert withheld(server) is None


def test_progress_states_the_remaining_time_to_hold_the_tip(server: Server) -> None:
    patient = begun(server, 5.0)
    server.ask("POST", f"{POINTS}/captures", 202, json={"landmark": USED[0]})
    first = hold(server, patient, POINTS, USED[0], 1)
    assert (first["rate_hz"], first["left_s"]) == (None, None)
    capture = hold(server, patient, POINTS, USED[0], 6)
    assert capture["images"] == 7
    assert capture["rate_hz"] == pytest.approx(5.0)
    assert capture["left_s"] == pytest.approx(1.0)


def test_signs_of_life_between_two_images_do_not_end_a_capture(server: Server) -> None:
    patient = begun(server, 2.0)
    server.ask("POST", f"{POINTS}/captures", 202, json={"landmark": USED[0]})
    capture: dict[str, Any] = {}
    for _ in range(12):
        capture = hold(server, patient, POINTS, USED[0], 1)
        sign_of_life(server)
    assert capture["state"] == "taken"
    assert capture["left_s"] == 0.0


def test_a_capture_ends_when_the_camera_stops(server: Server) -> None:
    patient = begun(server, 5.0)
    server.ask("POST", f"{POINTS}/captures", 202, json={"landmark": USED[0]})
    hold(server, patient, POINTS, USED[0], 3)
    sign_of_life(server, SourceState.RECONNECTING)
    server.until(lambda: server.ask("GET", POINTS, 200)["capture"]["state"] == "rejected")
    assert server.ask("GET", POINTS, 200)["capture"]["problem"]["code"] == "NO_PICTURE"


@pytest.mark.parametrize(
    ("rate_hz", "gap_s", "said"),
    [
        pytest.param(30.0, 0.4, "0.40 s passed between two of 12 images, allowed 0.25 s", id="30-hz"),
        pytest.param(5.0, 1.3, "1.30 s passed between two of 7 images, allowed 1.00 s", id="5-hz"),
    ],
)
def test_lost_images_reject_a_capture_with_the_rate(
    server: Server, rate_hz: float, gap_s: float, said: str
) -> None:
    patient = begun(server, rate_hz)
    server.ask("POST", f"{POINTS}/captures", 202, json={"landmark": USED[0]})
    hold(server, patient, POINTS, USED[0], 6)
    patient.at_s += gap_s - 1.0 / rate_hz
    patient.hold(POINTS, USED[0])
    problem = server.ask("GET", POINTS, 200)["capture"]["problem"]
    assert problem["code"] == "CAPTURE_INTERRUPTED"
    assert said in problem["message"]
    assert f"at {rate_hz:.1f} images/s" in problem["message"]


def test_a_check_before_a_camera_that_is_too_slow_is_rejected_with_its_rate(server: Server) -> None:
    ready(server)
    patient = Patient(server=server)
    patient.register(USED)
    patient.rate_hz = 1.2
    server.ask("POST", CHECK, 201, json={**DRILL, "landmark": SPARE})
    patient.hold(CHECK, SPARE)
    rejected = server.ask("POST", f"{CHECK}/conclusion", 409, json={"made_by": "ito"})
    assert rejected["code"] == "CAPTURE_RATE_TOO_LOW"
    assert "at 1.2 images/s, allowed 8 s" in rejected["message"]
    assert "camera.rate_hz" in rejected["remedy"]


def test_a_check_saved_too_early_states_the_remaining_time(server: Server) -> None:
    ready(server)
    patient = Patient(server=server)
    patient.register(USED)
    patient.rate_hz = 5.0
    server.ask("POST", CHECK, 201, json={**DRILL, "landmark": SPARE})
    hold(server, patient, CHECK, SPARE, 4)
    rejected = server.ask("POST", f"{CHECK}/conclusion", 409, json={"made_by": "ito"})
    assert rejected["code"] == "CHECK_NOT_CAPTURED"
    assert rejected["message"] == "the tip was seen in 4 images at 5.0 images/s, needed 12"
    assert rejected["remedy"] == "Hold the tip still on the landmark for another 1.6 s, until it is captured."


def test_a_tool_is_calibrated_with_a_slow_camera(server: Server) -> None:
    calibrated(server)
    reported = gather(server, Scene.PIVOT, "pivot", rate_hz=3.0)
    assert reported["missing"] == []
    for _ in range(5):
        sign_of_life(server)
        assert server.ask("GET", "/api/tools/collection", 200)["newest"] != "no_picture"
    sign_of_life(server, SourceState.RECONNECTING)
    server.until(lambda: server.ask("GET", "/api/tools/collection", 200)["newest"] == "no_picture")
