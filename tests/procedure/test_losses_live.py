"""Loss of marker, reference and camera on a real server: what its clients receive."""

from collections import defaultdict
from pathlib import Path
from typing import Any

import pytest

from server.config import Config, RehearsalEventConfig
from tests.procedure.real_server import BUSY_MACHINE, real_server
from tests.procedure.team import Team

SETTINGS: dict[str, Any] = {
    **BUSY_MACHINE,
    "rehearsal": {
        "seed": 3,
        "skill": "good",
        "reference": True,
        "width": 960,
        "height": 540,
        "rate_hz": 12,
    },
    "alarms": {"screen_lost_after_s": 600, "drill_unseen_after_ms": 400, "reference_unseen_after_ms": 400},
}
# A busy machine may send no message for more than a second: a shorter loss could pass between two.
EVENTS = (
    RehearsalEventConfig(kind="drill_occluded", at_s=3.0, lasts_s=4.0),
    RehearsalEventConfig(kind="reference_occluded", at_s=9.0, lasts_s=4.0),
    RehearsalEventConfig(kind="camera_stops", at_s=15.0, lasts_s=4.0),
)
ALL_PRESENT = {"pose": "tool", "deviation": "deviation", "judgement": "judgement", "assessment": "assessment"}


def kinds(tool: dict[str, Any]) -> dict[str, str]:
    """Return the kind of each value of a tool."""
    return {name: tool[name]["kind"] for name in ALL_PRESENT}


@pytest.mark.timeout(900)
def test_what_is_lost_is_not_reported_in_any_message_and_its_alarm_comes(tmp_path: Path) -> None:
    reasons, alarms = defaultdict[str, set[str]](set), defaultdict[str, set[str]](set)
    with real_server(tmp_path, SETTINGS) as server:
        team = Team(server=server, config=Config.model_validate(SETTINGS))
        team.arm_a_screen()
        # Navigation has started before anything is lost.
        assert server.shown()["camera_calibrated"]
        team.play("operation", events=EVENTS)
        with server.listening() as messages:
            for message in messages:
                snapshot = message["snapshot"]
                if snapshot is None:
                    alarms["camera"] |= {one["condition"] for one in message["alarms"]["alarms"]}
                    continue
                truth = team.truth_of(snapshot)
                if truth.at_s > EVENTS[-1].at_s:
                    break
                (tool,) = snapshot["tools"]
                lost = "" if truth.marker_in_view else "drill"
                lost = lost if truth.reference_in_view else "reference"
                if lost:
                    assert set(kinds(tool).values()) == {"absent"}, lost
                    reasons[lost].add(tool["deviation"]["reason"])
                    alarms[lost] |= {one["condition"] for one in message["alarms"]["alarms"]}
                elif truth.at_s > 2.5:
                    alarms["nothing"] |= {"present"} if kinds(tool) == ALL_PRESENT else set()
        assert reasons == {"drill": {"MARKER_UNSEEN"}, "reference": {"REFERENCE_UNSEEN"}}
        assert "present" in alarms["nothing"]
        assert "DRILL_UNSEEN" in alarms["drill"]
        assert "REFERENCE_UNSEEN" in alarms["reference"]
        assert "CAMERA_GONE" in alarms["camera"]
