"""The panel says numbers when they are known, and the reason when they are not; never both."""

import dataclasses
from collections.abc import Callable

import pytest

from server.live import Instant
from server.overlay import panel_of
from server.shown import NOT_KNOWN, shown_number
from server.stream.judgement_messages import DeviationMessage, JudgementMessage, NearestMessage
from server.stream.messages import live_message
from tracker.navigation import Absent, AbsentReason, NavigationSnapshot
from tracker.pose import Unseen, UnseenReason

SnapshotOf = Callable[..., NavigationSnapshot]


@pytest.mark.parametrize(
    ("theatre", "state"),
    [
        pytest.param({"seen": False}, "NO TRACKING", id="marker-unseen"),
        pytest.param({"calibrated": False}, "CAMERA NOT CALIBRATED", id="no-camera-file"),
        pytest.param({"registered": False}, "NOT REGISTERED", id="not-registered"),
        pytest.param({"planned": False}, "NO PLAN", id="no-plan"),
        pytest.param({"with_tool": False}, "TOOL NOT DEFINED", id="no-tool"),
        pytest.param(
            {"with_tool": False, "calibrated": False}, "CAMERA NOT CALIBRATED", id="camera-comes-first"
        ),
        pytest.param({"with_tool": False, "seen": False}, "NO TRACKING", id="nothing-at-all"),
    ],
)
def test_what_is_absent_is_said_in_words(
    snapshot_of: SnapshotOf, theatre: dict[str, bool], state: str
) -> None:
    panel = panel_of(snapshot_of(**theatre))
    assert panel.state == state
    assert panel.readings == ()


def test_an_unseen_marker_is_told_with_its_reason(snapshot_of: SnapshotOf) -> None:
    assert panel_of(snapshot_of(seen=False)).details == (
        "marker not seen",
        "drill: too few of its edges",
    )


@pytest.mark.parametrize("reason", UnseenReason)
def test_every_reason_of_an_unseen_marker_has_words(snapshot_of: SnapshotOf, reason: UnseenReason) -> None:
    snapshot = dataclasses.replace(snapshot_of(seen=False), sightings={"drill": Unseen(reason=reason)})
    assert panel_of(snapshot).details[-1].startswith("drill: ")


@pytest.mark.parametrize("reason", AbsentReason)
def test_every_reason_for_absent_numbers_has_words(snapshot_of: SnapshotOf, reason: AbsentReason) -> None:
    snapshot = dataclasses.replace(snapshot_of(), deviations={"drill": Absent(reason=reason)})
    panel = panel_of(snapshot)
    assert panel.state
    assert panel.details


def test_the_burned_in_numbers_are_the_numbers_of_the_message(
    snapshot_of: SnapshotOf, instant_of: Callable[..., Instant]
) -> None:
    snapshot = snapshot_of()
    message = live_message(instant_of(1, snapshot=snapshot), now_s=1.0)
    assert message.snapshot is not None
    sent, judged = message.snapshot.tools[0].deviation, message.snapshot.tools[0].judgement
    assert isinstance(sent, DeviationMessage)
    assert isinstance(judged, JudgementMessage)
    assert isinstance(judged.clearance.now, NearestMessage)
    assert sent.entry_offset_mm is not None
    panel = panel_of(snapshot)
    assert panel.state == ""
    assert [(reading.value, reading.unit) for reading in panel.readings] == [
        (shown_number(sent.entry_offset_mm), "mm"),
        (shown_number(sent.angle_deg), "°"),
        (shown_number(sent.depth_mm), "mm"),
        (shown_number(sent.remaining_mm), "mm"),
        (shown_number(judged.clearance.now.clearance_mm), "mm"),
    ]
    assert panel.readings[-1].hint == judged.clearance.now.wall
    assert panel.verdict is not None
    assert panel.verdict.verdict is judged.verdict


def test_a_drill_across_the_channel_has_no_entry_offset(snapshot_of: SnapshotOf) -> None:
    readings = panel_of(snapshot_of(tilt_rad=1.5707963)).readings
    assert readings[0].value == NOT_KNOWN
    assert readings[1].value == "90.0"
