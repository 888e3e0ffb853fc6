"""The whole procedure through HTTP, from an empty case to drilling, and the alarm at a breach."""

from collections.abc import Iterator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from server.config import Config
from tests.procedure.real_server import BUSY_MACHINE, RealServer, real_server
from tests.procedure.team import BY, CHECK, DRILL, POINTS, Heard, Team
from tracker.plan import Channel
from tracker.rehearsal import Phase

SETTINGS = {
    **BUSY_MACHINE,
    # At 30 images/s the rehearsal would leave the jobs little of two cores.
    "rehearsal": {
        "rate_hz": 12,
        "width": 960,
        "height": 540,
        "seed": 3,
        "provides_setup": False,
        "reference": True,
        "rest_s": 1.6,
    },
    "reference": {"marker": "reference"},
}
CONFIG = Config.model_validate(SETTINGS)
# Of the 13 mm drilled before the drill leaves the channel; the number of images depends on the machine.
MIN_WATCHED_MM = 6.0
# Tolerance in standard deviations; the error of a registration is common to all images.
WITHIN_SD = 3.0


@pytest.mark.timeout(1800)
def test_from_an_empty_case_to_drilling(tmp_path: Path) -> None:
    with real_server(tmp_path, SETTINGS) as server:
        team = Team(server=server, config=CONFIG)
        team.waits_for("camera", "NO_CASE_OPEN")
        team.open_case("L3, left")
        team.waits_for("camera", "CAMERA_MISSING")

        report = team.calibrate_camera()
        assert report["rms_px"] < 0.2
        team.waits_for("tool", "TOOL_MISSING")

        tool = team.calibrate_tool()
        assert tool["pivot"]["tip_in_marker_mm"] == pytest.approx([0.0, -120.0, -10.0], abs=0.5)
        team.waits_for("plan", "PLAN_MISSING")

        team.plan("L3")
        team.waits_for("plan", "PLAN_MISSING")
        channel = team.choose("L3", "left")
        assert team.steps() == dict(zip(STEPS, ["done"] * 3 + ["missing"] * 3, strict=True))
        server.rejected(
            "POST", CHECK, "REGISTER_MISSING", json={**DRILL, "landmark": "left mammillary process"}
        )

        register(team)
        assert team.steps()["check"] == "missing"
        assert deviation_now(server) == {"kind": "absent", "reason": "NOT_CHECKED"}
        check = team.check()
        assert check["passed"]
        assert check["distance_mm"] < 1.0
        assert set(team.steps().values()) == {"done"}

        team.arm_a_screen()
        team.play("operation", skill="breaching")
        with server.listening() as messages:
            heard = team.heard(messages)
            drill_well(heard, channel)
            breach = breach_in(heard)
            acknowledged(server, heard, breach)

    # Restarted in the same folder: the case is open and registered, and nothing is lost.
    with real_server(tmp_path, SETTINGS) as server:
        goes_on_once_confirmed(Team(server=server, config=CONFIG))
        lines = server.ask("GET", "/api/alarms/log", 200)["lines"]
        reported = [
            (line["change"], line.get("by")) for line in lines if line.get("number") == breach["number"]
        ]
        assert reported[:2] == [("raised", None), ("acknowledged", "M. Ito")]


STEPS = ("camera", "tool", "plan", "register", "check", "navigate")


def goes_on_once_confirmed(team: Team) -> None:
    """Everything is valid, but there are no numbers until a person has confirmed that nothing has moved."""
    server = team.server
    assert team.steps() == {**dict.fromkeys(STEPS, "done"), "navigate": "missing"}
    assert deviation_now(server) == {"kind": "absent", "reason": "NOT_CONFIRMED"}
    needed = server.ask("GET", "/api/procedure", 200)["confirmation"]
    word = {"registration_id": needed["registration_id"]}
    server.ask("POST", "/api/procedure/confirmation", 200, json=word)
    assert set(team.steps().values()) == {"done"}


def register(team: Team) -> None:
    """Capture landmarks until the error is acceptable; too few are rejected."""
    reported = team.touch(2)
    assert [one["code"] for one in reported["missing"]] == ["POINTS_TOO_FEW"]
    team.server.rejected("POST", f"{POINTS}/conclusion", "POINTS_TOO_FEW", json=BY)
    reported = team.touch_more(3)
    assert reported["missing"] == []
    assert reported["fre_rms_mm"] < CONFIG.registration.max_fre_mm
    assert max(one["stated_mm"] for one in reported["targets"]) < CONFIG.registration.max_tre_mm
    document = team.server.ask("POST", f"{POINTS}/conclusion", 201, json=BY)
    assert document["content"]["anchored_to"] == "reference"


def deviation_now(server: RealServer) -> Any:  # noqa: ANN401  JSON
    """Numbers relative to the channel, as soon as the registration has reached the tracking process."""

    def newest() -> Any:  # noqa: ANN401  JSON
        snapshot = server.ask("GET", "/api/live", 200)["snapshot"]
        is_known = snapshot is not None and snapshot["registered_by"] == "points"
        return snapshot["tools"][0]["deviation"] if is_known else None

    return server.until("an image with the registration", newest)


def drill_well(heard: Iterator[Heard], channel: Channel) -> None:
    """Inside the channel there is no alarm, and each number is within its stated uncertainty."""
    depths_mm = []
    for one in heard:
        if one.truth.phase is Phase.DRIFT:
            break
        if one.truth.phase is not Phase.DRILL:
            continue
        assert {name: alarm["measure"] for name, alarm in one.alarms.items()} == {}
        said, truth = one.drill["deviation"], one.deviation_from(channel)
        depths_mm.append(truth.depth_mm)
        spread = one.drill["judgement"]["spread"]
        assert spread["sd_depth_mm"] < 1.0
        assert abs(said["depth_mm"] - truth.depth_mm) < WITHIN_SD * spread["sd_depth_mm"]
        beside_mm = np.hypot(
            said["entry_lateral_mm"] - truth.entry_lateral_mm,
            said["entry_cranial_mm"] - truth.entry_cranial_mm,
        )
        assert beside_mm < WITHIN_SD * spread["sd_at_entry_mm"]
        assert abs(said["angle_deg"] - truth.angle_deg) < WITHIN_SD * spread["sd_angle_deg"]
    assert max(depths_mm) - min(depths_mm) > MIN_WATCHED_MM


def breach_in(heard: Iterator[Heard]) -> dict[str, Any]:
    """The alarm of the breach, in the message of an image that shows it."""
    for one in heard:
        assert one.truth.phase is Phase.DRIFT, "it was never announced"
        breach = one.alarms.get("BREACH")
        if breach is None:
            continue
        assert (breach["priority"], breach["state"]) == ("high", "active")
        assert one.message["alarms"]["sound"] == "high"
        clearance = one.drill["judgement"]["clearance"]["now"]
        wall = one.drill["assessment"]["figures"]["wall"]
        assert breach["presence"] == "yes"
        assert wall["value"] == breach["measure"]["value"] < 0.0
        assert wall["value"] == pytest.approx(clearance["clearance_mm"], abs=0.1)
        assert one.drill["assessment"]["verdict"] == "through_wall"
        assert one.message["headline"]["title"]["en"].startswith("THROUGH ")
        return breach
    raise AssertionError("no message any more")


def acknowledged(server: RealServer, heard: Iterator[Heard], breach: dict[str, Any]) -> None:
    """A user acknowledges it, and every client is informed."""
    requested = {"by": "M. Ito", "numbers": [breach["number"]]}
    answer = server.door.post("/api/alarms/acknowledgement", json=requested)
    # A busy disk may take longer than the server waits for it; that the log has it is seen after the restart.
    assert answer.status_code == 200 or answer.json()["code"] == "ALARM_NOT_LOGGED", answer.text
    answered = next(one.alarms["BREACH"] for one in heard if one.alarms["BREACH"]["state"] == "acknowledged")
    assert answered["acknowledged_by"] == "M. Ito"
