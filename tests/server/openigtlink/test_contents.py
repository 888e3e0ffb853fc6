"""The messages of one instant: coordinate frames, and unknown values."""

from dataclasses import replace

import numpy as np
import pytest

from server import openigtlink_wire as wire
from server.config import OpenIgtLinkConfig
from server.live import Problem, ProcessState, ProcessStatus, SourceState, SourceStatus
from server.openigtlink.contents import CODES, DeviceContent, contents_of
from tests.server.conftest import make_instant, make_snapshot
from tests.server.openigtlink.spoken import contents
from tracker.geometry import Array
from tracker.navigation import Absent, AbsentReason, NavigationSnapshot, ToolPose
from tracker.plan import Channel


def devices(snapshot: NavigationSnapshot, **settings: object) -> dict[str, DeviceContent]:
    link = OpenIgtLinkConfig.model_validate(settings)
    contents = contents_of(make_instant(0, snapshot=snapshot), link, language="en")
    return {one.device: one for one in (*contents.image, contents.plan, contents.program)}


def matrix_of(one: DeviceContent) -> Array:
    assert one.type == "TRANSFORM"
    return wire.transform_of(one.content)


def reason_of(one: DeviceContent) -> str:
    assert one.type == "STATUS"
    return wire.status_of(one.content).name


def test_a_tool_is_sent_in_camera_and_vertebra_with_its_tip() -> None:
    snapshot = make_snapshot(judged=True)
    found = devices(snapshot, coordinates="LPS")
    assert set(found) == {"drillToCamera", "drillToVertebra", "drillTip", "Headline", "Plan", "Coaxial"}
    seen = snapshot.tools["drill"]
    assert isinstance(seen, ToolPose)
    assert matrix_of(found["drillToCamera"]) == pytest.approx(seen.camera_from_tool.matrix, abs=1e-4)
    in_vertebra = matrix_of(found["drillToVertebra"])
    assert in_vertebra[:3, 3] == pytest.approx([1.5, -1.0, 12.0], abs=1e-4)
    (tip,) = wire.points_of(found["drillTip"].content)
    assert tip.position_mm == pytest.approx(in_vertebra[:3, 3])
    entry, target = wire.points_of(found["Plan"].content)
    assert (entry.name, entry.position_mm.tolist()) == ("entry", [0, 0, 0])
    assert (target.name, target.position_mm.tolist(), target.group) == ("target", [0, 0, 40], "L3 left")
    assert reason_of(found["Coaxial"]) == "OK"
    assert (
        wire.string_of(found["Headline"].content) == "NEAR CHANNEL EDGE 0.2 mm · limit 1.0 mm · move medial"
    )


def test_ras_turns_the_vertebra_and_leaves_the_camera() -> None:
    snapshot = make_snapshot(judged=True)
    setup = replace(
        snapshot.setup,
        channel=Channel(
            name="a",
            entry_in_vertebra_mm=np.array([1.0, 2, 3]),
            target_in_vertebra_mm=np.array([4.0, 5, 6]),
            radius_mm=2,
        ),
    )
    lps, ras = (devices(replace(snapshot, setup=setup), coordinates=one) for one in ("LPS", "RAS"))
    assert lps["drillToCamera"] == ras["drillToCamera"]
    # Each column, an axis or the tip, has x and y with the opposite sign.
    expected = matrix_of(lps["drillToVertebra"]) * np.array([[-1.0], [-1.0], [1.0], [1.0]])
    assert matrix_of(ras["drillToVertebra"]) == pytest.approx(expected)
    assert np.linalg.det(matrix_of(ras["drillToVertebra"])) == pytest.approx(1.0, abs=1e-5)
    assert [one.position_mm.tolist() for one in wire.points_of(ras["Plan"].content)] == [
        [-1, -2, 3],
        [-4, -5, 6],
    ]
    (tip,) = wire.points_of(ras["drillTip"].content)
    assert tip.position_mm == pytest.approx([-1.5, 1.0, 12.0], abs=1e-4)
    assert {lps["drillTip"].coordinates, ras["drillTip"].coordinates} == {"LPS", "RAS"}


@pytest.mark.parametrize(
    ("given", "in_camera", "in_vertebra"),
    [
        pytest.param({"seen": False}, "MARKER_UNSEEN", "MARKER_UNSEEN", id="unseen"),
        pytest.param({"calibrated": False}, "CAMERA_NOT_CALIBRATE", "CAMERA_NOT_CALIBRATE", id="camera"),
        pytest.param({"registered": False}, "", "NOT_REGISTERED", id="not-registered"),
        pytest.param({"planned": False}, "", "NO_PLAN", id="no-plan"),
        pytest.param({"pose_variance": 1e4}, "POSE_UNCERTAIN", "POSE_UNCERTAIN", id="uncertain"),
    ],
)
def test_what_is_not_known_is_a_status_with_its_reason(
    given: dict[str, float], in_camera: str, in_vertebra: str
) -> None:
    found = devices(make_snapshot(**given))  # pyrefly: ignore[bad-argument-type]
    for device, reason in (
        ("drillToCamera", in_camera),
        ("drillToVertebra", in_vertebra),
        ("drillTip", in_vertebra),
    ):
        if reason:
            assert reason_of(found[device]) == reason
        else:
            assert found[device].type == "TRANSFORM"
    whole = wire.status_of(found["drillToVertebra"].content).text
    assert whole.split(":")[0] in set(AbsentReason)


@pytest.mark.parametrize("reason", list(AbsentReason))
def test_numbers_that_are_withheld_are_not_sent(reason: AbsentReason) -> None:
    whole = make_snapshot(judged=True)
    absent = {"drill": Absent(reason=reason)}
    found = devices(replace(whole, deviations=absent, analyses=absent, assessments=absent))
    for device in ("drillToVertebra", "drillTip"):
        status = wire.status_of(found[device].content)
        assert status.code == CODES[reason]
        assert status.text.startswith(f"{reason.value}: ")
    assert not found["Headline"].has_figures


DIED = Problem(code="TRACKING_DIED", message="it died 6 times", remedy="")


@pytest.mark.parametrize(
    ("stopped", "why"),
    [
        ({"snapshot": None}, "tracking is running, the source is running"),
        ({"source": SourceStatus(name="0", state=SourceState.RECONNECTING)}, "reconnecting"),
        ({"process": ProcessStatus(state=ProcessState.RESTARTING)}, "tracking is restarting"),
        ({"process": ProcessStatus(state=ProcessState.GIVEN_UP, problem=DIED)}, "it died 6 times"),
    ],
)
def test_nothing_is_known_while_capture_or_tracking_does_not_run(
    stopped: dict[str, object], why: str
) -> None:
    given = contents(**{"snapshot": make_snapshot(judged=True), **stopped})  # pyrefly: ignore[bad-argument-type]
    assert given.captured_at_s is None
    assert [wire.string_of(one.content) for one in given.image] == ["NO IMAGE"]
    for one in (given.plan, given.program):
        assert reason_of(one) == "NO_IMAGE"
    assert why in wire.status_of(given.program.content).text


def two_tools(snapshot: NavigationSnapshot, second: str) -> NavigationSnapshot:
    def both(one: object) -> dict[str, object]:
        assert isinstance(one, dict)
        return {"drill": one["drill"], second: one["drill"]}

    changed = {name: both(getattr(snapshot, name)) for name in ("tools", "deviations", "assessments")}
    setup = replace(snapshot.setup, tools=both(snapshot.setup.tools))  # pyrefly: ignore[bad-argument-type]
    return replace(snapshot, setup=setup, **changed)  # pyrefly: ignore[bad-argument-type]


@pytest.mark.parametrize(
    ("settings", "sent"),
    [
        pytest.param({}, {"drill", "awl"}, id="own-names"),
        pytest.param({"tool_names": {"awl": "Ahle"}}, {"drill", "Ahle"}, id="another-name"),
        pytest.param({"tool_names": {"awl": "drill"}}, set(), id="one-name-for-both"),
        pytest.param(
            {"tool_names": {"awl": "drillTo"}, "camera_frame": "Tip"}, set(), id="a-tip-named-as-a-pose"
        ),
        pytest.param({"camera_frame": "A", "vertebra_frame": "A"}, set(), id="one-name-for-both-frames"),
    ],
)
def test_names_are_unique(settings: dict[str, object], sent: set[str]) -> None:
    found = devices(two_tools(make_snapshot(judged=True), "awl"), **settings)
    assert {name.removesuffix("Tip") for name, one in found.items() if name.endswith("Tip")} == sent
    assert reason_of(found["Coaxial"]) == ("OK" if sent else "NAME_UNUSABLE")


def test_a_name_that_is_too_long_is_not_cut() -> None:
    found = devices(two_tools(make_snapshot(judged=True), "a-drill-with-a-long-name"))
    assert {"drillTip", "Coaxial"} < set(found)
    status = wire.status_of(found["Coaxial"].content)
    assert (status.name, status.code) == ("NAME_UNUSABLE", wire.StatusCode.CONFIG_ERROR)
    assert "a-drill-with-a-long-name" in status.text
    assert len(found) == 6
